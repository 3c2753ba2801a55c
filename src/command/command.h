/* The subcommands: what main.c and `pscn help` know of each, and what they share.
 *
 * Results go to stdout, everything else to stderr. A command's run function returns the exit code; main turns
 * STATUS_INTERRUPTED into interrupt_exit_code().
 */
#ifndef PSCN_COMMAND_COMMAND_H
#define PSCN_COMMAND_COMMAND_H

#include <stdbool.h>
#include <stddef.h>
#include <stdio.h>

#include "base/listener.h"
#include "base/status.h"

/* Where an option goes: to the command's handler, or directly into its request, as a text, a truth value, a number >= 0
 * or > 0, or an integer from least to most. */
enum command_store { STORE_NOT, STORE_TEXT, STORE_TRUE, STORE_NUMBER, STORE_POSITIVE, STORE_INTEGER };

/* A row of a command's table of options. The table serves to read them, to guess misspelt ones and to print the
 * help. */
struct command_option {
  const char *name;     /* "output"; NULL ends the table */
  char letter;          /* 'o', or 0 */
  int val;              /* passed to the handler */
  const char *text;     /* for the help */
  const char *argument; /* for the help, "FILE"; NULL: takes none */
  enum command_store store;
  size_t offset;      /* in the request */
  size_t least, most; /* of an integer */
  const char *what;   /* for errors: "number of samples" */
};

struct command_line {
  const char **positional; /* positional_count of them, at the beginning of argv, which is overwritten */
  size_t positional_count;
  const char *text; /* all of it, quoted for a shell; "" if memory is short */
};

struct command;
typedef enum status command_option_handler(const struct command *command, void *request, int val, const char *argument);

struct command {
  const char *name;
  const char *arguments;                /* as in the usage line, "SCENE" */
  const char *summary;                  /* one line */
  const char *description;              /* paragraphs for `pscn help NAME`, ending with a newline */
  const struct command_option *options; /* ended by COMMAND_OPTIONS_END */
  size_t operands; /* how many arguments are not options; one more is allowed if `arguments` names one in brackets, any
                      number if it ends with "..." */
  command_option_handler *take; /* gets the val and the argument (NULL if it takes none) of each option that is not
                                   stored directly. It returns STATUS_OK, or another status after printing its error */
  const void *request;          /* the file's struct request before options are read */
  size_t request_size;
  enum status (*run)(const struct command *command, void *request, const struct command_line *line);
  void (*end)(void *request); /* frees what `take` and `run` have put there; or NULL */
};

/* Reads the command line and runs the command, or prints its help or an error. Options may stand anywhere before "--".
 * argv[0] is the command's name, and argv ends with NULL. Not thread-safe. */
enum status command_run(const struct command *command, int argc, const char **argv) STATUS_MUST_CHECK;

extern const struct command command_render, command_trace, command_roots, command_dump, command_compare, command_merge,
  command_check, command_chart, command_help;

/* The commands by index from 0, in the order of the help text; NULL after the last. */
const struct command *command_at(size_t index);

/* The meaning of the exit codes, two lines of the help text. */
extern const char command_exit_codes[];

/* Finds a command by name, or NULL. For the latter, command_unknown prints the error, with the name that may have been
 * meant, and returns STATUS_USAGE. */
const struct command *command_find(const char *name);
enum status command_unknown(const char *name);

/* Print the help text of one command, and of all. */
void command_print_help(const struct command *command, FILE *file);
void command_print_overview(FILE *file);

/* Prints text from files and names so that it cannot control the terminal: control characters other than newline, and
 * bytes that are not UTF-8, become \xNN. */
void command_print(FILE *file, const char *text);

/* Print "pscn NAME: error: text" to stderr, or "warning" (without NAME if command is NULL). All errors that are not
 * about a line of input have this form. command_usage also says where help is, and returns STATUS_USAGE. */
void command_error(const struct command *command, const char *format, ...) __attribute__((format(printf, 2, 3)));
void command_warning(const struct command *command, const char *format, ...) __attribute__((format(printf, 2, 3)));
enum status command_usage(const struct command *command, const char *format, ...) __attribute__((format(printf, 2, 3)));

/* Prints that memory is short; returns STATUS_LIMIT. */
enum status command_out_of_memory(const struct command *command);

/* A listener that prints to stderr: progress unless `quiet`, warnings and errors as "pscn NAME: ...". Signals stop it
 * (interrupt.h). `ear` must outlive it. */
struct command_ear {
  const struct command *command;
  bool quiet;
};
struct listener command_listener(struct command_ear *ear);

/* Flushes stdout. Returns STATUS_FILE, after printing the error, if something was not written. Need not be checked if
 * the command fails anyway. */
enum status command_finish_output(const struct command *command);

/* Rows of the table: one for an option that goes to the handler, and the one for --help, which every command has and
 * command_run answers. `letter` is the short name, or 0. */
enum { OPTION_HELP = 1000 };
#define COMMAND_OPTION(name, letter, val, text, argument)       \
  {                                                             \
    name, letter, val, text, argument, STORE_NOT, 0, 0, 0, NULL \
  }
#define COMMAND_HELP_OPTION COMMAND_OPTION("help", 'h', OPTION_HELP, "show this text", NULL)
#define COMMAND_OPTIONS_END COMMAND_OPTION(NULL, 0, 0, NULL, NULL)

/* The members of a command whose file has OPTIONS, DEFAULTS, its struct request before options are read, and run. */
#define COMMAND_RUNS(count, taker)                                                                             \
  .options = OPTIONS, .operands = count, .take = taker, .request = &DEFAULTS, .request_size = sizeof DEFAULTS, \
  .run = run

/* Rows for options stored in a field of the file's own struct request: const char *, bool, double twice, size_t. */
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
