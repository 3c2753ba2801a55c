/* pages FOLDER: writes there, when pscn is built, all that `cmake --install` installs for shells, editors and man: the
 * templates beside this file (page/page.h), filled in with the tables of the commands, the solvers and the language. */
#include <ctype.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/json_text.h"
#include "base/memory.h"
#include "base/text_buffer.h"
#include "command/command.h"
#include "language/words.h"
#include "library/pscn.h"
#include "packaging/templates.h"
#include "page/page.h"
#include "render/channels.h"
#include "scene/method.h"

static json_t *take(struct text_buffer *buffer)
{
  char *text = text_buffer_take(buffer);
  json_t *value = text == NULL ? NULL : json_string(text);
  memory_free(text);
  return value;
}

/* A value in a list, which knows whether it is the first one. */
static json_t *add(json_t *list, json_t *value)
{
  return json_append(list, json_join(json_pack("{s:b}", "first", json_array_size(list) == 0), value));
}

/* ---- roff ---- */

/* Adds text so that no line of it is a request. */
static void put(struct text_buffer *out, const char *text, size_t length)
{
  for (size_t k = 0; k < length; k++) {
    const bool first = k == 0 || text[k - 1] == '\n';
    if (first && (text[k] == '.' || text[k] == '\'')) text_buffer_add_text(out, "\\&");
    if (text[k] == '\\') text_buffer_add_text(out, "\\e");
    else if (text[k] == '-') text_buffer_add_text(out, "\\-");
    else if (text[k] == '\'') text_buffer_add_text(out, "\\(aq");
    else if (text[k] == '^') text_buffer_add_text(out, "\\(ha");
    else text_buffer_add(out, text + k, 1);
  }
}

static json_t *roff(const char *text)
{
  struct text_buffer out = {0};
  put(&out, text, strlen(text));
  return take(&out);
}

/* The paragraphs of a help text, which are filled. */
static json_t *paragraphs(const char *text)
{
  struct text_buffer out = {0};
  bool open = false;
  for (const char *line = text; *line != '\0'; line += strcspn(line, "\n") + 1) {
    if (*line != '\n' && !open) text_buffer_add_text(&out, ".PP\n");
    open = *line != '\n';
    if (open) put(&out, line, strcspn(line, "\n") + 1);
  }
  return take(&out);
}

/* Adds a line of Markdown without its end: `code` and **strong** words are bold, links are their texts.
 * `quote`: '`' or '*' within such words, which may continue on the next line, otherwise 0. */
static void put_markdown(struct text_buffer *out, const char *text, char *quote)
{
  for (; *text != '\0' && *text != '\n'; text++) {
    if ((*text == '`' && *quote != '*') || (strncmp(text, "**", 2) == 0 && *quote != '`')) {
      *quote = *quote == 0 ? *text : 0;
      text_buffer_add_text(out, *quote == 0 ? "\\fR" : "\\fB");
      text += *text == '*';
    } else if (*quote == 0 && strncmp(text, "](", 2) == 0 && strchr(text, ')') != NULL) {
      text = strchr(text, ')');
    } else if (*quote != 0 || *text != '[') {
      put(out, text, 1);
    }
  }
}

/* Adds a row of a table: its first cell is a tag, the others follow as text. */
static void put_row(struct text_buffer *out, char *row, char *quote)
{
  const char *before = ".TP\n";
  for (char *rest, *cell = strtok_r(row, "|\n", &rest); cell != NULL; cell = strtok_r(NULL, "|\n", &rest)) {
    text_buffer_add_text(out, before);
    put_markdown(out, cell + strspn(cell, " "), quote);
    before = before[0] == '.' ? "\n\\&" : " ";
  }
  text_buffer_add_text(out, "\n");
}

/* docs/language.md */
static json_t *language(void)
{
  enum { LINE_SIZE = 4096 };
  char line[LINE_SIZE], quote = 0;
  bool verbatim = false, table = false;
  struct text_buffer out = {0};
  for (const char *rest = TEMPLATE_LANGUAGE; *rest != '\0'; rest += strcspn(rest, "\n") + 1) {
    snprintf(line, sizeof line, "%.*s", (int)strcspn(rest, "\n") + 1, rest);
    const char *text = line + strspn(line, " ");
    const bool example = text - line >= 4, blank = *text == '\n', item = strncmp(text, "- ", 2) == 0;
    if (verbatim != example && !blank) text_buffer_add_text(&out, example ? ".nf\n" : ".fi\n"), verbatim = example;
    if (example) put(&out, line, strlen(line));
    else if (*line == '|') {
      if (table && line[1] != '-') put_row(&out, line, &quote); /* without the head */
    } else {
      text_buffer_add_text(&out, blank ? ".PP" : *text == '#' ? ".SH " : item ? ".IP \\(bu 2\n" : "");
      put_markdown(&out, text + (item ? 2 : strspn(text, "# ")), &quote);
      text_buffer_add_text(&out, "\n");
    }
    table = *line == '|';
  }
  return take(&out);
}

/* ---- words of scenes ---- */

static json_t *add_word(json_t *list, const char *word) { return add(list, json_pack("{s:s}", "word", word)); }

/* Those of solver statements: the names of solvers, of items and of their values. Some occur twice. */
static json_t *solver_words(void)
{
  json_t *list = json_array();
  for (size_t k = 0; k < solver_count(); k++) list = add_word(list, solver_at(k)->name);
  for (size_t k = 0; k < method_item_count(); k++) list = add_word(list, method_item_at(k)->name);
  for (size_t k = 0; k < method_item_count(); k++)
    for (const char *const *word = method_item_at(k)->keywords; word != NULL && *word != NULL; word++)
      list = add_word(list, *word);
  return list;
}

/* All words of a kind, except `solver`, which has its own rules, and except those of POV-Ray's other words that solver
 * statements use. */
static json_t *words(enum words_kind kind, const json_t *of_solvers)
{
  json_t *list = json_array();
  const char *word;
  for (size_t k = 0; (word = words_at(kind, k)) != NULL; k++) {
    bool left_out = strcmp(word, "solver") == 0;
    for (size_t n = 0; n < json_array_size(of_solvers) && kind == WORDS_FOREIGN; n++)
      left_out |= strcmp(word, json_string_value(json_object_get(json_array_get(of_solvers, n), "word"))) == 0;
    if (!left_out) list = add_word(list, word);
  }
  return list;
}

/* ---- commands ---- */

/* Text for single quotes of a shell; the characters of `escaped` also get a backslash. */
static json_t *quoted(const char *text, const char *escaped)
{
  struct text_buffer out = {0};
  for (; *text != '\0'; text++)
    if (*text == '\'') text_buffer_add_text(&out, "'\\''");
    else text_buffer_format(&out, "%s%c", strchr(escaped, *text) != NULL ? "\\" : "", *text);
  return take(&out);
}

/* How the shells complete an argument: a file (of scenes, of pictures), a folder, one of some words, a list of them with
 * commas, or something that cannot be guessed. */
enum kind { OTHER, ANY_FILE, SCENE, PICTURE, FOLDER, WORDS, LIST };

static const struct {
  const char *bash, *zsh, *fish; /* %s: the words, with blanks between them */
} WAY[] = {
  [OTHER] = {":", " ", ""},
  [ANY_FILE] = {"_pscn_files", "_files", " -F"},
  [SCENE] = {"_pscn_files pscn", "_files -g \"*.pscn\"", " -k -a '(__fish_complete_suffix .pscn)'"},
  [PICTURE] = {"_pscn_files png exr", "_files -g \"*.(png|exr)\"",
               " -k -a '(__fish_complete_suffix .png; __fish_complete_suffix .exr)'"},
  [FOLDER] = {"_pscn_folders", "_files -/", " -a '(__fish_complete_directories)'"},
  [WORDS] = {"_pscn_words '%s'", "(%s)", " -a '%s'"},
  [LIST] = {"_pscn_words '%s'", "_values -s , name %s", " -a '(__fish_append , %s)'"},
};

static json_t *argument(enum kind kind, const char *name, struct text_buffer *choice)
{
  const char *text = choice->text == NULL ? "" : choice->text;
  json_t *value = json_pack("{s:o,s:o,s:o,s:o,s:o,s:b}", "bash", json_sprintf(WAY[kind].bash, text), "zsh",
                            json_sprintf(WAY[kind].zsh, text), "fish", json_sprintf(WAY[kind].fish, text), "zsh_what",
                            quoted(name, ":"), "roff_what", roff(name), "many", kind == PICTURE);
  text_buffer_free(choice);
  return value;
}

static json_t *argument_of_option(const struct command *command, const struct command_option *option)
{
  struct text_buffer choice = {0};
  const char *name = option->argument;
  if (name == NULL) return json_null();
  enum kind kind = strcmp(name, "FILE") == 0 || strcmp(name, "DIFF") == 0 ? ANY_FILE
                   : strcmp(name, "DIR") == 0                             ? FOLDER
                                                                          : OTHER;
  if (strcmp(option->name, "solver") == 0) {
    kind = WORDS;
    for (size_t k = 0; k < solver_count(); k++) text_buffer_format(&choice, k > 0 ? " %s" : "%s", solver_at(k)->name);
  } else if (strcmp(option->name, "channels") == 0 && command == &command_render) {
    kind = LIST;
    for (int k = 0; k < CHANNEL_KINDS; k++)
      text_buffer_format(&choice, k > 0 ? " %s" : "%s", channel_traits((enum channel_kind)k)->name);
  } else if (strcmp(name, "FORMAT") == 0) {
    kind = WORDS;
    text_buffer_add_text(&choice, "plain table json");
  }
  return argument(kind, name, &choice);
}

static json_t *argument_of_command(const struct command *command)
{
  struct text_buffer choice = {0};
  const char *name = command->arguments;
  const enum kind kind = strncmp(name, "SCENE", 5) == 0   ? SCENE
                         : strcmp(name, "[COMMAND]") == 0 ? WORDS
                         : strcmp(name, "[FILE]") == 0    ? ANY_FILE
                                                          : PICTURE;
  for (size_t k = 0; kind == WORDS && command_at(k) != NULL; k++)
    text_buffer_format(&choice, "%s ", command_at(k)->name);
  text_buffer_add_text(&choice, "solver channels");
  return argument(kind, name, &choice);
}

static json_t *option_value(const struct command *command, const struct command_option *option)
{
  return json_pack("{s:s,s:o,s:o,s:o,s:o,s:o,s:o}", "option", option->name, "letter",
                   option->letter == '\0' ? json_null() : json_sprintf("%c", option->letter), "argument",
                   argument_of_option(command, option), "zsh_text", quoted(option->text, "[]:\\"), "fish_text",
                   quoted(option->text, "\\"), "roff_option", roff(option->name), "roff_text", roff(option->text));
}

static json_t *command_value(const struct command *command)
{
  char title[64], subject[256];
  json_t *options = json_array();
  snprintf(title, sizeof title, "PSCN-%s", command->name);
  for (char *c = title; *c != '\0'; c++) *c = (char)toupper((unsigned char)*c);
  snprintf(subject, sizeof subject, "%s", command->summary);
  subject[0] = (char)tolower((unsigned char)subject[0]);
  for (const struct command_option *option = command->options; option->name != NULL; option++)
    options = add(options, option_value(command, option));
  return json_pack("{s:s,s:s,s:b,s:o,s:o,s:o,s:o,s:o,s:o,s:o}", "command", command->name, "title", title, "optional",
                   json_array_size(options) > 1, "argument", argument_of_command(command), "options", options,
                   "zsh_summary", quoted(command->summary, ":\\"), "fish_summary", quoted(command->summary, "\\"),
                   "roff_summary", roff(command->summary), "roff_subject", roff(subject), "roff_description",
                   paragraphs(command->description));
}

/* ---- pages ---- */

static json_t *all_values(void)
{
  json_t *commands = json_array(), *of_solvers = solver_words();
  for (size_t k = 0; command_at(k) != NULL; k++) commands = add(commands, command_value(command_at(k)));
  return json_pack("{s:s,s:o,s:o,s:o,s:o,s:o,s:o,s:o,s:o,s:o,s:o}", "version", PSCN_VERSION, "header",
                   roff(TEMPLATE_HEADER), "language", language(), "exit_codes",
                   roff(strchr(command_exit_codes, ':') + 2), "commands", commands, "statements",
                   words(WORDS_STATEMENTS, of_solvers), "items", words(WORDS_ITEMS, of_solvers), "values",
                   words(WORDS_VALUES, of_solvers), "directives", words(WORDS_DIRECTIVES, of_solvers), "foreign",
                   words(WORDS_FOREIGN, of_solvers), "solver_words", of_solvers);
}

static void write_page(const char *name, const char *template, const json_t *values)
{
  struct text_buffer text = {0};
  fill_template(&text, template, values);
  FILE *file = text.failed ? NULL : fopen(name, "w");
  const bool whole = file != NULL && fwrite(text.text, 1, text.length, file) == text.length;
  if (file == NULL || fclose(file) != 0 || !whole) perror(name), exit(4);
  text_buffer_free(&text);
}

int main(int argc, char **argv)
{
  static const struct {
    const char *name, *template;
  } pages[] = {{"pscn.1", TEMPLATE_MANUAL},
               {"pscn.3", TEMPLATE_LIBRARY_MANUAL},
               {"pscn.5", TEMPLATE_LANGUAGE_MANUAL},
               {"pscn.bash", TEMPLATE_BASH},
               {"_pscn", TEMPLATE_ZSH},
               {"pscn.fish", TEMPLATE_FISH},
               {"pscn.vim", TEMPLATE_VIM},
               {"pscn.tmLanguage.json", TEMPLATE_GRAMMAR}};
  if (argc != 2 || chdir(argv[1]) != 0) return 2;
  json_t *values = all_values();
  for (size_t k = 0; k < sizeof pages / sizeof *pages; k++) write_page(pages[k].name, pages[k].template, values);
  for (size_t k = 0; command_at(k) != NULL; k++) {
    char name[64];
    snprintf(name, sizeof name, "pscn-%s.1", command_at(k)->name);
    (void)json_object_set(values, "page", json_array_get(json_object_get(values, "commands"), k));
    write_page(name, TEMPLATE_MANUAL, values);
  }
  json_decref(values);
  return 0;
}
