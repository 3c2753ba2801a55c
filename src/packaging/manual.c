/* Manual pages (man(7)), made from the help texts and from the library's header. */
#include <ctype.h>
#include <stdlib.h>
#include <string.h>

#include "library/pscn.h"
#include "packaging/pages.h"

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

void write_library(FILE *file)
{
  char line[4096];
  FILE *header = fopen(PSCN_HEADER, "r");
  if (header == NULL) perror(PSCN_HEADER), exit(4);
  fprintf(file,
          ".TH \"PSCN\" 3 \"\" \"pscn %s\" \"pscn\"\n.SH NAME\nlibpscn \\- exact intersection of rays with bicubic "
          "patches\n.SH SYNOPSIS\n.B #include <pscn.h>\n.SH DESCRIPTION\nThe header:\n.PP\n.nf\n",
          PSCN_VERSION);
  while (fgets(line, sizeof line, header) != NULL) put_text(file, line);
  fputs(".fi\n", file);
  fclose(header);
}
