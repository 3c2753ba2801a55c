/* What shells, editors and man read of pscn, written from the tables that the commands and the language use. */
#ifndef PSCN_PACKAGING_PAGES_H
#define PSCN_PACKAGING_PAGES_H

#include <stdio.h>

#include "command/command.h"

/* The manual page of a command; with NULL that of pscn. */
void write_manual(const struct command *command, FILE *file);

/* Completions for the shells. */
void write_bash(FILE *file);
void write_zsh(FILE *file);
void write_fish(FILE *file);

/* The words of the scene language coloured: for Vim, and as a TextMate grammar, which VS Code reads. */
void write_vim(FILE *file);
void write_textmate(FILE *file);

/* What stands behind an option or a command: a file (of scenes, of pictures), a folder, one of some words, or what
 * nobody can guess. */
enum argument_kind { ARGUMENT_OTHER, ARGUMENT_FILE, ARGUMENT_SCENE, ARGUMENT_PICTURE, ARGUMENT_FOLDER, ARGUMENT_WORDS };

struct argument {
  enum argument_kind kind;
  char words[1024]; /* of ARGUMENT_WORDS, with blanks between them */
};

/* Of an option that takes one, and of what the command itself takes. */
struct argument argument_of_option(const struct command *command, const struct command_option *option);
struct argument argument_of_command(const struct command *command);

#endif
