/* pages FOLDER LANGUAGE HEADER: writes there, when pscn is built, all that `cmake --install` installs for shells, editors and man. */
#include "packaging/pages.h"

#include <string.h>

#include "algebra/solver.h"
#include "render/channels.h"

static void add_word(struct argument *argument, const char *word)
{
  const size_t used = strlen(argument->words);
  snprintf(argument->words + used, sizeof argument->words - used, "%s%s", used > 0 ? " " : "", word);
}

struct argument argument_of_option(const struct command *command, const struct command_option *option)
{
  static const struct {
    const char *argument;
    enum argument_kind kind;
  } kinds[] = {{"FILE", ARGUMENT_FILE}, {"DIFF", ARGUMENT_FILE}, {"DIR", ARGUMENT_FOLDER}};
  struct argument argument = {.kind = ARGUMENT_OTHER};
  for (size_t k = 0; k < sizeof kinds / sizeof *kinds; k++)
    if (strcmp(option->argument, kinds[k].argument) == 0) argument.kind = kinds[k].kind;
  if (strcmp(option->name, "solver") == 0)
    for (size_t k = 0; k < solver_count(); k++) add_word(&argument, solver_at(k)->name);
  else if (strcmp(option->name, "channels") == 0 && command == &command_render)
    for (int kind = 0; kind < CHANNEL_KINDS; kind++) add_word(&argument, channel_traits((enum channel_kind)kind)->name);
  else if (strcmp(option->argument, "FORMAT") == 0) add_word(&argument, "plain table json");
  if (argument.words[0] != '\0') argument.kind = strcmp(option->name, "channels") == 0 ? ARGUMENT_LIST : ARGUMENT_WORDS;
  return argument;
}

struct argument argument_of_command(const struct command *command)
{
  struct argument argument = {.kind = ARGUMENT_OTHER};
  if (strncmp(command->arguments, "SCENE", 5) == 0) argument.kind = ARGUMENT_SCENE;
  else if (strcmp(command->arguments, "[COMMAND]") == 0) {
    argument.kind = ARGUMENT_WORDS;
    for (size_t k = 0; command_at(k) != NULL; k++) add_word(&argument, command_at(k)->name);
    add_word(&argument, "solver channels");
  } else if (strcmp(command->arguments, "[FILE]") == 0) {
    argument.kind = ARGUMENT_FILE;
  } else if (command->arguments[0] != '\0') {
    argument.kind = ARGUMENT_PICTURE;
  }
  return argument;
}

/* Opens FOLDER/NAME; NULL, after an error, if it cannot. */
static FILE *begin(const char *folder, const char *name)
{
  char path[4096];
  snprintf(path, sizeof path, "%s/%s", folder, name);
  FILE *file = fopen(path, "w");
  if (file == NULL) perror(path);
  return file;
}

static bool end(FILE *file, const char *name)
{
  const bool written = ferror(file) == 0;
  if (fclose(file) == 0 && written) return true;
  perror(name);
  return false;
}

/* Makes FOLDER/NAME of the file `from`. */
static bool convert(const char *folder, const char *name, const char *from, void (*write)(FILE *file, FILE *source))
{
  FILE *source = fopen(from, "r"), *file = source == NULL ? NULL : begin(folder, name);
  if (source == NULL) perror(from);
  if (file != NULL) write(file, source);
  const bool done = file != NULL && end(file, name);
  if (source != NULL) fclose(source);
  return done;
}

int main(int argc, char **argv)
{
  static const struct {
    const char *name;
    void (*write)(FILE *file);
  } pages[] = {{"pscn.bash", write_bash},
               {"_pscn", write_zsh},
               {"pscn.fish", write_fish},
               {"pscn.vim", write_vim},
               {"pscn.tmLanguage.json", write_textmate}};
  if (argc != 4) return 2;
  bool done = convert(argv[1], "pscn.5", argv[2], write_language) && convert(argv[1], "pscn.3", argv[3], write_library);
  for (size_t k = 0; k < sizeof pages / sizeof *pages && done; k++) {
    FILE *file = begin(argv[1], pages[k].name);
    if (file == NULL) return 4;
    pages[k].write(file);
    done = end(file, pages[k].name);
  }
  const struct command *command = NULL; /* pscn itself comes first */
  for (size_t k = 0; done; command = command_at(k++)) {
    char name[64] = "pscn.1";
    if (k > 0 && command == NULL) break;
    if (command != NULL) snprintf(name, sizeof name, "pscn-%s.1", command->name);
    FILE *file = begin(argv[1], name);
    if (file == NULL) return 4;
    write_manual(command, file);
    done = end(file, name);
  }
  return done ? 0 : 4;
}
