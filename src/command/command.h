/* Subcommands: what main.c and `pscn help` know of each, and what they share.
 *
 * Results go to stdout, everything else to stderr. What a command's run function answers is the exit code; of
 * STATUS_INTERRUPTED main makes interrupt_exit_code().
 */
#ifndef PSCN_COMMAND_COMMAND_H
#define PSCN_COMMAND_COMMAND_H

#include <stdbool.h>
#include <stddef.h>
#include <stdio.h>

#include "base/listener.h"
#include "base/status.h"

/* Where an option goes: to the command's handler, or at once into its request: a text, a truth, a number >= 0 or > 0,
 * an integer from least to most. */
enum command_store { STORE_NOT, STORE_TEXT, STORE_TRUE, STORE_NUMBER, STORE_POSITIVE, STORE_INTEGER };

/* A row of the table of a command's options, from which they are read and guessed and the help is written. */
struct command_option {
  const char *name;     /* "output"; NULL ends the table */
  char letter;          /* 'o', or 0 */
  int val;              /* what the handler is told of it */
  const char *text;     /* of the help */
  const char *argument; /* likewise, "FILE"; NULL: it takes none */
  enum command_store store;
  size_t offset;      /* in the request */
  size_t least, most; /* of an integer */
  const char *what;   /* that a wrong number is not: "number of samples" */
};

struct command {
  const char *name;
  const char *arguments;                /* as in the usage line, "SCENE" */
  const char *summary;                  /* one line */
  const char *description;              /* paragraphs for `pscn help NAME`, ending with a newline */
  const struct command_option *options; /* ended by COMMAND_OPTIONS_END */
  enum status (*run)(const struct command *command, int argc, const char **argv); /* argv[0] is the command's name */
};

extern const struct command command_render, command_trace, command_roots, command_dump, command_compare, command_merge,
  command_check, command_chart, command_help;

/* The commands in the order of the help text, from 0 on; NULL behind the last. */
const struct command *command_at(size_t index);

/* What exit codes mean, two lines of the help text. */
extern const char command_exit_codes[];

/* The command of that name, or NULL; then command_unknown tells so, and which may have been meant: STATUS_USAGE. */
const struct command *command_find(const char *name);
enum status command_unknown(const char *name);

/* The help text of one command, and of all. */
void command_print_help(const struct command *command, FILE *file);
void command_print_overview(FILE *file);

/* What files and names bring along, so that it steers no terminal: control characters, but for the newline, and what is no
 * UTF-8 are \xNN. */
void command_print(FILE *file, const char *text);

/* "pscn NAME: error: text" to stderr (without NAME where command is NULL), the form of all errors that no line of
 * an input has; and of warnings. command_usage adds where help is, and answers STATUS_USAGE. */
void command_error(const struct command *command, const char *format, ...) __attribute__((format(printf, 2, 3)));
void command_warning(const struct command *command, const char *format, ...) __attribute__((format(printf, 2, 3)));
enum status command_usage(const struct command *command, const char *format, ...) __attribute__((format(printf, 2, 3)));

/* Tells that memory is short; answers STATUS_LIMIT. */
enum status command_out_of_memory(const struct command *command);

/* A listener that tells on stderr: progress unless it is to be quiet, warnings and errors as "pscn NAME: ...". Stopped
 * by signals (interrupt.h). `ear` stays where it is. */
struct command_ear {
  const struct command *command;
  bool quiet;
};
struct listener command_listener(struct command_ear *ear);

/* Reads a command line into the request at `context`: `handle` is told the val and the argument (NULL where it takes
 * none) of each option that is not stored at once, and answers STATUS_OK or a status after having told its error.
 * --help is answered here. Options stand anywhere before "--". Not for several threads at once. */
struct command_line {
  const char **positional; /* positional_count of them, at the beginning of argv, which is used up */
  size_t positional_count;
  bool help; /* --help was given and answered: the command is done */
};

typedef enum status command_option_handler(const struct command *command, void *context, int val, const char *argument);

/* STATUS_USAGE after telling the error where options are wrong or the number of other arguments is not `count`, or less
 * where the command's arguments end with "...". argv ends with NULL. */
enum status command_line_read(const struct command *command, int argc, const char **argv, size_t count,
                              command_option_handler *handle, void *context,
                              struct command_line *out) STATUS_MUST_CHECK;

/* Flushes stdout; STATUS_FILE after telling the error where something was not written. Need not be checked where the
 * command fails anyway. */
enum status command_finish_output(const struct command *command);

/* The command line as a shell takes it; NULL where memory is short. To be freed. */
char *command_line_text(int argc, const char **argv);

/* A row of the table for an option that the handler is told, and for the one that every command has, which
 * command_line_read answers. `letter` is the short name, or 0. */
enum { OPTION_HELP = 1000 };
#define COMMAND_OPTION(name, letter, val, text, argument)       \
  {                                                             \
    name, letter, val, text, argument, STORE_NOT, 0, 0, 0, NULL \
  }
#define COMMAND_HELP_OPTION COMMAND_OPTION("help", 'h', OPTION_HELP, "show this text", NULL)
#define COMMAND_OPTIONS_END COMMAND_OPTION(NULL, 0, 0, NULL, NULL)

/* The same for what is stored in a field of the file's own struct request: const char *, bool, double twice, size_t. */
#define COMMAND_STORED(name, letter, store, field, text, argument, least, most, what)          \
  {                                                                                            \
    name, letter, 0, text, argument, store, offsetof(struct request, field), least, most, what \
  }
#define COMMAND_TEXT(name, letter, field, text, argument) \
  COMMAND_STORED(name, letter, STORE_TEXT, field, text, argument, 0, 0, NULL)
#define COMMAND_TRUE(name, letter, field, text) COMMAND_STORED(name, letter, STORE_TRUE, field, text, NULL, 0, 0, NULL)
#define COMMAND_NUMBER(name, field, text, argument) \
  COMMAND_STORED(name, 0, STORE_NUMBER, field, text, argument, 0, 0, NULL)
#define COMMAND_POSITIVE(name, field, what, text, argument) \
  COMMAND_STORED(name, 0, STORE_POSITIVE, field, text, argument, 0, 0, what)
#define COMMAND_INTEGER(name, field, least, most, what, text, argument) \
  COMMAND_STORED(name, 0, STORE_INTEGER, field, text, argument, least, most, what)

#endif
