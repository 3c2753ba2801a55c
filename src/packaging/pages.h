/* What shells, editors and man read about pscn, written from the tables of the commands and of the language. */
#ifndef PSCN_PACKAGING_PAGES_H
#define PSCN_PACKAGING_PAGES_H

#include <stdio.h>

#include "command/command.h"

/* The manual page of a command, or for NULL that of pscn. */
void write_manual(const struct command *command, FILE *file);

/* That of the library, which shows its header, and that of the scene language, made of docs/language.md. */
void write_library(FILE *file);
void write_language(FILE *file);

/* Completions for the shells. */
void write_bash(FILE *file);
void write_zsh(FILE *file);
void write_fish(FILE *file);

/* The words of the scene language, highlighted: for Vim, and as a TextMate grammar, which VS Code reads. */
void write_vim(FILE *file);
void write_textmate(FILE *file);

/* The argument of an option or a command: a file (of scenes, of pictures), a folder, one of some words, a list of them
 * with commas, or something that cannot be guessed. */
enum argument_kind {
  ARGUMENT_OTHER,
  ARGUMENT_FILE,
  ARGUMENT_SCENE,
  ARGUMENT_PICTURE,
  ARGUMENT_FOLDER,
  ARGUMENT_WORDS,
  ARGUMENT_LIST
};

struct argument {
  enum argument_kind kind;
  char words[1024]; /* of ARGUMENT_WORDS and ARGUMENT_LIST, separated by blanks */
};

/* The argument of an option that takes one, and that of the command itself. */
struct argument argument_of_option(const struct command *command, const struct command_option *option);
struct argument argument_of_command(const struct command *command);

#endif
