/* Completions for bash, zsh and fish. */
#include <string.h>

#include "packaging/pages.h"

/* Writes text for single quotes of a shell; the characters of `escaped` also get a backslash. */
static void put_quoted(FILE *file, const char *text, const char *escaped)
{
  for (; *text != '\0'; text++)
    if (*text == '\'') fputs("'\\''", file);
    else fprintf(file, "%s%c", strchr(escaped, *text) != NULL ? "\\" : "", *text);
}

/* ---- bash ---- */

/* Writes the call that offers what an argument can be. */
static void put_bash_argument(FILE *file, const struct argument *argument)
{
  static const char *const calls[] = {
    [ARGUMENT_OTHER] = ":",
    [ARGUMENT_FILE] = "_pscn_files",
    [ARGUMENT_SCENE] = "_pscn_files pscn",
    [ARGUMENT_PICTURE] = "_pscn_files png exr",
    [ARGUMENT_FOLDER] = "_pscn_folders",
  };
  if (argument->words[0] != '\0') fprintf(file, "_pscn_words '%s'", argument->words);
  else fputs(calls[argument->kind], file);
}

static void put_bash_command(FILE *file, const struct command *command)
{
  const struct argument own = argument_of_command(command);
  fprintf(file, "    %s)\n      case $before in\n", command->name);
  for (const struct command_option *option = command->options; option->name != NULL; option++) {
    if (option->argument == NULL) continue;
    const struct argument argument = argument_of_option(command, option);
    fprintf(file, "        --%s", option->name);
    if (option->letter != '\0') fprintf(file, " | -%c", option->letter);
    fputs(") ", file);
    put_bash_argument(file, &argument);
    fputs("; return ;;\n", file);
  }
  fputs("      esac\n      case $word in\n        -*) _pscn_words '", file);
  for (const struct command_option *option = command->options; option->name != NULL; option++)
    fprintf(file, "%s--%s", option == command->options ? "" : " ", option->name);
  fputs("' ;;\n        *) ", file);
  put_bash_argument(file, &own);
  fputs(" ;;\n      esac ;;\n", file);
}

void write_bash(FILE *file)
{
  fputs("# Completion of pscn for bash, made from its tables of options.\n"
        "_pscn_words() { # also behind others and a comma\n"
        "  local before=${word%\"${word##*,}\"}\n"
        "  mapfile -t COMPREPLY < <(compgen -P \"$before\" -W \"$1\" -- \"${word##*,}\")\n"
        "}\n"
        "_pscn_folders() { compopt -o filenames 2>/dev/null; mapfile -t COMPREPLY < <(compgen -d -- \"$word\"); }\n"
        "_pscn_files() {\n"
        "  local suffix\n"
        "  compopt -o filenames 2>/dev/null\n"
        "  if [ $# -eq 0 ]; then mapfile -t COMPREPLY < <(compgen -f -- \"$word\"); return; fi\n"
        "  mapfile -t COMPREPLY < <(compgen -d -- \"$word\"; for suffix; do compgen -f -X \"!*.$suffix\" -- \"$word\"; "
        "done)\n"
        "}\n"
        "_pscn() {\n"
        "  local word=${COMP_WORDS[COMP_CWORD]} before=${COMP_WORDS[COMP_CWORD-1]} command=${COMP_WORDS[1]}\n"
        "  COMPREPLY=()\n"
        "  if [ \"$COMP_CWORD\" -eq 1 ]; then\n"
        "    case $word in\n"
        "      -*) _pscn_words '--help --version' ;;\n"
        "      */* | *.*) _pscn_files pscn ;;\n"
        "      *) _pscn_words '",
        file);
  for (size_t k = 0; command_at(k) != NULL; k++) fprintf(file, "%s%s", k > 0 ? " " : "", command_at(k)->name);
  fputs("'; [ ${#COMPREPLY[@]} -gt 0 ] || _pscn_files pscn ;;\n"
        "    esac\n"
        "    return\n"
        "  fi\n"
        "  case $command in *[./]*) command=render ;; esac # `pscn SCENE` renders it\n"
        "  case $command in\n",
        file);
  for (size_t k = 0; command_at(k) != NULL; k++) put_bash_command(file, command_at(k));
  fputs("  esac\n}\ncomplete -F _pscn pscn\n", file);
}

/* ---- zsh ---- */

/* ":what:how" behind a specification. */
static void put_zsh_argument(FILE *file, const char *what, const struct argument *argument)
{
  static const char *const ways[] = {
    [ARGUMENT_OTHER] = " ",
    [ARGUMENT_FILE] = "_files",
    [ARGUMENT_SCENE] = "_files -g \"*.pscn\"",
    [ARGUMENT_PICTURE] = "_files -g \"*.(png|exr)\"",
    [ARGUMENT_FOLDER] = "_files -/",
  };
  fputc(':', file);
  put_quoted(file, what, ":");
  if (argument->kind == ARGUMENT_WORDS) fprintf(file, ":(%s)", argument->words);
  else if (argument->kind == ARGUMENT_LIST) fprintf(file, ":_values -s , name %s", argument->words);
  else fprintf(file, ":%s", ways[argument->kind]);
}

static void put_zsh_command(FILE *file, const struct command *command)
{
  const struct argument own = argument_of_command(command);
  fprintf(file, "    %s) _arguments -S", command->name);
  for (const struct command_option *option = command->options; option->name != NULL; option++) {
    fputs(" \\\n      ", file);
    if (option->letter != '\0')
      fprintf(file, "'(-%c --%s)'{-%c,--%s}", option->letter, option->name, option->letter, option->name);
    else fprintf(file, "--%s", option->name);
    fputs("'[", file);
    put_quoted(file, option->text, "[]:\\");
    fputs("]", file);
    if (option->argument != NULL) {
      const struct argument argument = argument_of_option(command, option);
      put_zsh_argument(file, option->argument, &argument);
    }
    fputc('\'', file);
  }
  if (own.kind != ARGUMENT_OTHER) {
    fprintf(file, " \\\n      '%s", own.kind == ARGUMENT_PICTURE ? "*" : "1");
    put_zsh_argument(file, command->arguments, &own);
    fputc('\'', file);
  }
  fputs(" ;;\n", file);
}

void write_zsh(FILE *file)
{
  fputs("#compdef pscn\n# Completion of pscn for zsh, made from its tables of options.\n"
        "local -a subcommands\nsubcommands=(\n",
        file);
  for (size_t k = 0; command_at(k) != NULL; k++) {
    fprintf(file, "  '%s:", command_at(k)->name);
    put_quoted(file, command_at(k)->summary, ":\\");
    fputs("'\n", file);
  }
  fputs(")\nif (( CURRENT == 2 )); then\n"
        "  _describe command subcommands\n"
        "  _files -g \"*.pscn\"\n"
        "else\n"
        "  shift words\n"
        "  (( CURRENT-- ))\n"
        "  [[ $words[1] != *[./]* ]] || words[1]=render # `pscn SCENE` renders it\n"
        "  case $words[1] in\n",
        file);
  for (size_t k = 0; command_at(k) != NULL; k++) put_zsh_command(file, command_at(k));
  fputs("  esac\nfi\n", file);
}

/* ---- fish ---- */

static void put_fish_argument(FILE *file, const struct argument *argument)
{
  static const char *const ways[] = {
    [ARGUMENT_OTHER] = "",
    [ARGUMENT_FILE] = " -F",
    [ARGUMENT_SCENE] = " -k -a '(__fish_complete_suffix .pscn)'",
    [ARGUMENT_PICTURE] = " -k -a '(__fish_complete_suffix .png; __fish_complete_suffix .exr)'",
    [ARGUMENT_FOLDER] = " -a '(__fish_complete_directories)'",
  };
  if (argument->kind == ARGUMENT_WORDS) fprintf(file, " -a '%s'", argument->words);
  else if (argument->kind == ARGUMENT_LIST) fprintf(file, " -a '(__fish_append , %s)'", argument->words);
  else fputs(ways[argument->kind], file);
}

void write_fish(FILE *file)
{
  fputs("# Completion of pscn for fish, made from its tables of options.\n"
        "function __pscn_is\n"
        "  set -l word (commandline -opc)[2]\n"
        "  test \"$word\" = $argv[1]; or begin; test $argv[1] = render; and string match -qr '[./]' -- $word; end\n"
        "end\n"
        "complete -c pscn -f\n"
        "complete -c pscn -n __fish_use_subcommand -l version -d 'show the version'\n"
        "complete -c pscn -n __fish_use_subcommand -k -a '(__fish_complete_suffix .pscn)'\n",
        file);
  for (size_t k = 0; command_at(k) != NULL; k++) {
    const struct command *command = command_at(k);
    const struct argument own = argument_of_command(command);
    fprintf(file, "complete -c pscn -n __fish_use_subcommand -a %s -d '", command->name);
    put_quoted(file, command->summary, "\\");
    fputs("'\n", file);
    if (own.kind != ARGUMENT_OTHER) {
      fprintf(file, "complete -c pscn -n '__pscn_is %s'", command->name);
      put_fish_argument(file, &own);
      fputc('\n', file);
    }
    for (const struct command_option *option = command->options; option->name != NULL; option++) {
      fprintf(file, "complete -c pscn -n '__pscn_is %s' -l %s", command->name, option->name);
      if (option->letter != '\0') fprintf(file, " -s %c", option->letter);
      if (option->argument != NULL) {
        const struct argument argument = argument_of_option(command, option);
        fputs(" -r", file);
        put_fish_argument(file, &argument);
      }
      fputs(" -d '", file);
      put_quoted(file, option->text, "\\");
      fputs("'\n", file);
    }
  }
}
