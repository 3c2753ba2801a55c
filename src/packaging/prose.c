/* Manual pages made of texts in the sources: the page of the language (Markdown) and the library's header. */
#include <string.h>

#include "library/pscn.h"
#include "packaging/pages.h"

enum { LINE_SIZE = 4096 };

/* Writes text of Markdown: `code` and **strong** words are bold, links are their texts. */
static void put_inline(FILE *file, const char *text)
{
  bool bold = false, code = false;
  for (const char *c = text; *c != '\0' && *c != '\n'; c++) {
    const bool strong = !code && strncmp(c, "**", 2) == 0;
    if (*c == '`' || strong) {
      if (!strong) code = !code;
      bold = !bold;
      fputs(bold ? "\\fB" : "\\fR", file);
      c += strong;
    } else if (!code && *c == ']' && c[1] == '(') {
      c += strcspn(c, ")");
      if (*c == '\0') return;
    } else if (code || (*c != '[' && !(*c == '\\' && c[1] != '\0'))) {
      manual_put(file, c, 1);
    }
  }
}

/* A row of a table: its first cell is a tag, the others follow as text. */
static void put_row(FILE *file, char *row)
{
  int cell = 0;
  for (char *rest, *text = strtok_r(row + 1, "|\n", &rest); text != NULL; text = strtok_r(NULL, "|\n", &rest)) {
    text += strspn(text, " ");
    fputs(cell++ == 0 ? ".TP\n\\&" : cell == 2 ? "\n\\&" : " ", file);
    put_inline(file, text);
  }
  fputc('\n', file);
}

void write_language(FILE *file, FILE *source)
{
  char line[LINE_SIZE], row[LINE_SIZE] = ""; /* row: of a table; dropped if it turns out to be its head */
  bool verbatim = false, item = false;
  fprintf(file,
          ".TH \"PSCN\" 5 \"\" \"pscn %s\" \"pscn\"\n.SH NAME\npscn \\- the scene language of pscn\n.SH DESCRIPTION\n",
          PSCN_VERSION);
  while (fgets(line, sizeof line, source) != NULL) {
    const size_t indent = strspn(line, " ");
    const bool example = indent >= 4 && !item;
    if (verbatim && !example && line[0] != '\n') fputs(".fi\n", file), verbatim = false;
    if (row[0] != '\0' && strncmp(line, "|---", 4) != 0) put_row(file, row);
    row[0] = '\0';
    if (strncmp(line, "# ", 2) == 0 || strncmp(line, "|---", 4) == 0) continue;
    if (line[0] == '\n') {
      fputs(verbatim ? "\n" : ".PP\n", file);
      item = false;
    } else if (line[0] == '#') {
      fputs(line[2] == '#' ? ".SS " : ".SH ", file);
      put_inline(file, line + strspn(line, "# "));
      fputc('\n', file);
    } else if (example) {
      if (!verbatim) fputs(".nf\n", file);
      verbatim = true;
      manual_put(file, line, strlen(line));
    } else if (line[0] == '|') {
      memcpy(row, line, strlen(line) + 1);
    } else {
      if (strncmp(line + indent, "- ", 2) == 0) fputs(".IP \\(bu 2\n", file), item = true;
      fputs("\\&", file);
      put_inline(file, line + indent + (strncmp(line + indent, "- ", 2) == 0 ? 2 : 0));
      fputc('\n', file);
    }
  }
  if (row[0] != '\0') put_row(file, row);
  fputs(".SH SEE ALSO\n\\fBpscn\\fR(1),\n\\fBpovray\\fR(1)\n", file);
}

void write_library(FILE *file, FILE *source)
{
  char line[LINE_SIZE];
  fprintf(file,
          ".TH \"PSCN\" 3 \"\" \"pscn %s\" \"pscn\"\n.SH NAME\nlibpscn \\- exact intersection of rays with bicubic "
          "patches\n.SH SYNOPSIS\n.B #include <pscn.h>\n.SH DESCRIPTION\nThe header:\n.PP\n.nf\n",
          PSCN_VERSION);
  while (fgets(line, sizeof line, source) != NULL) manual_put(file, line, strlen(line));
  fputs(".fi\n", file);
}
