/* pages FOLDER: writes there, when pscn is built, all that `cmake --install` installs for shells, editors and man. */
#include "packaging/pages.h"

#include <stdlib.h>
#include <string.h>
#include <unistd.h>

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

static FILE *begin(const char *name)
{
  FILE *file = fopen(name, "w");
  if (file == NULL) perror(name), exit(4);
  return file;
}

static void end(FILE *file, const char *name)
{
  const bool failed = ferror(file) != 0;
  if (fclose(file) != 0 || failed) perror(name), exit(4);
}

int main(int argc, char **argv)
{
  static const struct {
    const char *name;
    void (*write)(FILE *file);
  } pages[] = {{"pscn.3", write_library},
               {"pscn.5", write_language},
               {"pscn.bash", write_bash},
               {"_pscn", write_zsh},
               {"pscn.fish", write_fish},
               {"pscn.vim", write_vim},
               {"pscn.tmLanguage.json", write_textmate}};
  if (argc != 2 || chdir(argv[1]) != 0) return 2;
  for (size_t k = 0; k < sizeof pages / sizeof *pages; k++) {
    FILE *file = begin(pages[k].name);
    pages[k].write(file);
    end(file, pages[k].name);
  }
  const struct command *command = NULL; /* pscn itself comes first */
  for (size_t k = 0; k == 0 || command != NULL; command = command_at(k++)) {
    char name[64] = "pscn.1";
    if (command != NULL) snprintf(name, sizeof name, "pscn-%s.1", command->name);
    FILE *file = begin(name);
    write_manual(command, file);
    end(file, name);
  }
  return 0;
}
