/* Manual pages (man(7)), made from the help texts, from docs/language.md and from the library's header. */
#include <ctype.h>
#include <stdlib.h>
#include <string.h>

#include "library/pscn.h"
#include "packaging/pages.h"

enum { LINE_SIZE = 4096 }; /* of a text in the sources */

/* Writes text for roff, so that no line of it is a request. */
static void put(FILE *file, const char *text, size_t length)
{
  for (size_t k = 0; k < length; k++) {
    const bool first = k == 0 || text[k - 1] == '\n';
    if (first && (text[k] == '.' || text[k] == '\'')) fputs("\\&", file);
    if (text[k] == '\\') fputs("\\e", file);
    else if (text[k] == '-') fputs("\\-", file);
    else if (text[k] == '\'') fputs("\\(aq", file);
    else if (text[k] == '^') fputs("\\(ha", file);
    else fputc(text[k], file);
  }
}

static void put_text(FILE *file, const char *text) { put(file, text, strlen(text)); }

/* Writes the paragraphs of the help texts, which are filled. */
static void put_paragraphs(FILE *file, const char *text)
{
  bool open = false;
  for (const char *line = text; *line != '\0'; line += strcspn(line, "\n") + 1) {
    if (*line != '\n' && !open) fputs(".PP\n", file);
    open = *line != '\n';
    if (open) put(file, line, strcspn(line, "\n") + 1);
  }
}

static void put_option(FILE *file, const struct command_option *option)
{
  fputs(".TP\n", file);
  if (option->letter != '\0') fprintf(file, "\\fB\\-%c\\fR, ", option->letter);
  fputs("\\fB\\-\\-", file);
  put_text(file, option->name);
  fputs("\\fR", file);
  if (option->argument != NULL) {
    fputs(" \\fI", file);
    put_text(file, option->argument);
    fputs("\\fR", file);
  }
  fputc('\n', file);
  put_text(file, option->text);
  fputc('\n', file);
}

/* "NAME \- what it does" */
static void put_head(FILE *file, const char *name, const char *summary)
{
  fputs(".\\\" Made from the help texts of pscn.\n.TH \"", file);
  for (const char *c = name; *c != '\0'; c++) fputc(toupper((unsigned char)*c), file);
  fprintf(file, "\" 1 \"\" \"pscn %s\" \"pscn\"\n.SH NAME\n", PSCN_VERSION);
  put_text(file, name);
  fprintf(file, " \\- %c", tolower((unsigned char)summary[0]));
  put_text(file, summary + 1);
  fputs("\n.SH SYNOPSIS\n", file);
}

static void put_end(FILE *file, const struct command *command)
{
  fputs(".SH EXIT STATUS\n", file);
  put_text(file, strchr(command_exit_codes, ':') + 2);
  fputs(".SH ENVIRONMENT\n.TP\n\\fBPSCN_INCLUDE\\fR\n"
        "Folders in which files that a scene includes are looked for, with colons between them.\n"
        ".TP\n\\fBPSCN_KERNEL\\fR\n"
        "The instruction set: baseline, avx2 or avx512. Without it the best that the processor has.\n"
        ".SH SEE ALSO\n",
        file);
  if (command != NULL) fputs("\\fBpscn\\fR(1)", file);
  for (size_t k = 0; command == NULL && command_at(k) != NULL; k++)
    fprintf(file, "%s\\fBpscn\\-%s\\fR(1)", k > 0 ? ",\n" : "", command_at(k)->name);
  fputs(",\n\\fBpovray\\fR(1)\n", file);
}

static void put_overview(FILE *file)
{
  put_head(file, "pscn", "Renders bicubic Bezier patches exactly");
  fputs(".B pscn\n.I COMMAND\n[\\fIARGUMENT\\fR...]\n.br\n.B pscn\n.I SCENE\n[\\fIOPTION\\fR...]\n"
        ".SH DESCRIPTION\n"
        "Scenes are POV\\-Ray scenes of bicubic patches. The second form renders one.\n.SH COMMANDS\n",
        file);
  for (size_t k = 0; command_at(k) != NULL; k++) {
    const struct command *command = command_at(k);
    fprintf(file, ".TP\n\\fBpscn %s\\fR \\fI", command->name);
    put_text(file, command->arguments);
    fputs("\\fR\n", file);
    put_text(file, command->summary);
    fputs(".\n", file);
  }
}

void write_manual(const struct command *command, FILE *file)
{
  if (command == NULL) put_overview(file);
  else {
    char name[64];
    snprintf(name, sizeof name, "pscn-%s", command->name);
    put_head(file, name, command->summary);
    fprintf(file, ".B pscn %s\n", command->name);
    if (command->arguments[0] != '\0') fprintf(file, ".I %s\\&\n", command->arguments);
    if (command->options[1].name != NULL) fputs("[\\fIOPTION\\fR...]\n", file);
    fputs(".SH DESCRIPTION\n", file);
    put_paragraphs(file, command->description);
    fputs(".SH OPTIONS\n", file);
    for (const struct command_option *option = command->options; option->name != NULL; option++)
      put_option(file, option);
  }
  put_end(file, command);
}

/* Begins the page of a text in the sources, and opens that. `name`: the page's name and subject. */
static FILE *begin_page(FILE *file, int section, const char *name, const char *path)
{
  FILE *source = fopen(path, "r");
  if (source == NULL) perror(path), exit(4);
  fprintf(file, ".TH \"PSCN\" %d \"\" \"pscn %s\" \"pscn\"\n.SH NAME\n%s\n", section, PSCN_VERSION, name);
  return source;
}

/* Writes a line of Markdown without its end: `code` and **strong** words are bold, links are their texts.
 * `quote`: '`' or '*' within such words, which may continue on the next line, otherwise 0. */
static void put_markdown(FILE *file, const char *text, char *quote)
{
  for (; *text != '\0' && *text != '\n'; text++) {
    if ((*text == '`' && *quote != '*') || (strncmp(text, "**", 2) == 0 && *quote != '`')) {
      *quote = *quote == 0 ? *text : 0;
      fputs(*quote == 0 ? "\\fR" : "\\fB", file);
      text += *text == '*';
    } else if (*quote == 0 && strncmp(text, "](", 2) == 0 && strchr(text, ')') != NULL) {
      text = strchr(text, ')');
    } else if (*quote != 0 || *text != '[') {
      put(file, text, 1);
    }
  }
}

/* Writes a row of a table: its first cell is a tag, the others follow as text. */
static void put_row(FILE *file, char *row, char *quote)
{
  const char *before = ".TP\n";
  for (char *rest, *cell = strtok_r(row, "|\n", &rest); cell != NULL; cell = strtok_r(NULL, "|\n", &rest)) {
    fputs(before, file);
    put_markdown(file, cell + strspn(cell, " "), quote);
    before = before[0] == '.' ? "\n\\&" : " ";
  }
  fputc('\n', file);
}

void write_language(FILE *file)
{
  char line[LINE_SIZE], quote = 0;
  bool verbatim = false, table = false;
  FILE *source = begin_page(file, 5, "pscn \\- the scene language of pscn", PSCN_LANGUAGE);
  while (fgets(line, sizeof line, source) != NULL) {
    const char *text = line + strspn(line, " ");
    const bool example = text - line >= 4, blank = *text == '\n', item = strncmp(text, "- ", 2) == 0;
    if (verbatim != example && !blank) fputs(example ? ".nf\n" : ".fi\n", file), verbatim = example;
    if (example) put_text(file, line);
    else if (*line == '|') {
      if (table && line[1] != '-') put_row(file, line, &quote); /* without the head */
    } else {
      fputs(blank ? ".PP" : *text == '#' ? ".SH " : item ? ".IP \\(bu 2\n" : "", file);
      put_markdown(file, text + (item ? 2 : strspn(text, "# ")), &quote);
      fputc('\n', file);
    }
    table = *line == '|';
  }
  fputs(".SH SEE ALSO\n\\fBpscn\\fR(1),\n\\fBpovray\\fR(1)\n", file);
  fclose(source);
}

void write_library(FILE *file)
{
  char line[LINE_SIZE];
  FILE *header = begin_page(file, 3, "libpscn \\- exact intersection of rays with bicubic patches", PSCN_HEADER);
  fputs(".SH SYNOPSIS\n.B #include <pscn.h>\n.SH DESCRIPTION\nThe header:\n.PP\n.nf\n", file);
  while (fgets(line, sizeof line, header) != NULL) put_text(file, line);
  fputs(".fi\n", file);
  fclose(header);
}
