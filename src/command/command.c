/* What subcommands share: help texts, error lines, command lines. */
#include "command/command.h"

#include <ctype.h>
#include <errno.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

#include "command/interrupt.h"
#include "command/values.h"
#include "language/words.h"

/* In the order of the help text. */
static const struct command *const commands[] = {
  &command_render, &command_trace, &command_roots, &command_dump,
  &command_compare, &command_check, &command_chart, &command_help, NULL
};

const struct command *command_find(const char *name)
{
  for (const struct command *const *command = commands; *command != NULL; command++) {
    if (strcmp((*command)->name, name) == 0)
      return *command;
  }
  return NULL;
}

const char *command_guess(const char *name)
{
  struct guess guess = guess_begin(name, strlen(name));
  for (const struct command *const *command = commands; *command != NULL; command++)
    guess_consider(&guess, (*command)->name, strlen((*command)->name));
  return guess.best;
}

static void print_option(const struct command_option *option, FILE *file)
{
  enum { LABEL_SIZE = 80, LABEL_WIDTH = 22 };
  char label[LABEL_SIZE], letter[] = "    ";
  if (option->letter != '\0')
    snprintf(letter, sizeof letter, "-%c, ", option->letter);
  snprintf(label, sizeof label, "%s--%s %s", letter, option->name,
           option->argument == NULL ? "" : option->argument);
  fprintf(file, "  %-*s  %s\n", LABEL_WIDTH, label, option->text);
}

void command_print_help(const struct command *command, FILE *file)
{
  fprintf(file, "usage: pscn %s%s%s%s\n%s.\n\n", command->name, command->arguments[0] == '\0' ? "" : " ",
          command->arguments, command->options[1].name == NULL ? "" : " [OPTION...]", command->summary);
  fputs(command->description, file);
  fputs("\nOptions:\n", file);
  for (const struct command_option *option = command->options; option->name != NULL; option++)
    print_option(option, file);
}

void command_print_overview(FILE *file)
{
  fputs("usage: pscn COMMAND [ARGUMENT...]\n"
        "Renders bicubic Bezier patches exactly.\n\n"
        "Commands:\n",
        file);
  for (const struct command *const *command = commands; *command != NULL; command++)
    fprintf(file, "  %-8s %-12s %s\n", (*command)->name, (*command)->arguments, (*command)->summary);
  fputs("\n'pscn SCENE' renders it. 'pscn help COMMAND' tells more of each, 'pscn --version' the version.\n"
        "Exit codes: 0 done, 1 a comparison failed, 2 usage, 3 scene or input error, 4 file error,\n"
        "5 memory or a limit, 130 and 143 interrupted.\n",
        file);
}

static void print_error(const struct command *command, const char *format, va_list arguments)
{
  if (command == NULL)
    fputs("pscn: error: ", stderr);
  else
    fprintf(stderr, "pscn %s: error: ", command->name);
  vfprintf(stderr, format, arguments);
  fputc('\n', stderr);
}

void command_error(const struct command *command, const char *format, ...)
{
  va_list arguments;
  va_start(arguments, format);
  print_error(command, format, arguments);
  va_end(arguments);
}

int command_usage(const struct command *command, const char *format, ...)
{
  va_list arguments;
  va_start(arguments, format);
  print_error(command, format, arguments);
  va_end(arguments);
  if (command == NULL)
    fputs("Try 'pscn help'.\n", stderr);
  else
    fprintf(stderr, "Try 'pscn help %s'.\n", command->name);
  return STATUS_USAGE;
}

static void hear(void *context, enum told what, const char *text)
{
  const struct command_ear *ear = context;
  if (what == TOLD_ERROR)
    command_error(ear->command, "%s", text);
  else if (what == TOLD_WARNING)
    fprintf(stderr, "pscn %s: warning: %s\n", ear->command->name, text);
  else if (what == TOLD_DETAIL || !ear->quiet)
    fprintf(stderr, "%s\n", text);
}

struct listener command_listener(struct command_ear *ear)
{
  return (struct listener){ .hear = hear, .context = ear, .stop = &interrupt_signal };
}

char *command_line_text(int argc, const char **argv)
{
  size_t size = sizeof "pscn";
  for (int k = 0; k < argc; k++)
    size += strlen(argv[k]) + 3; /* a blank and two quotes */
  char *text = malloc(size), *end = text;
  if (text == NULL)
    return NULL;
  end += sprintf(end, "pscn");
  for (int k = 0; k < argc; k++)
    end += sprintf(end, strpbrk(argv[k], " \t\n\"\\$*?;&|<>(){}`#~") == NULL ? " %s" : " '%s'", argv[k]);
  return text;
}

/* A command line while it is read. */
struct reading {
  const struct command *command;
  command_option_handler *handle;
  void *context;
  const char **next; /* the words that follow, to NULL */
  struct command_line *line;
};

/* The option of that long name, or where it is NULL of that letter; NULL where there is none. */
static const struct command_option *find_option(const struct command *command, const char *name, size_t length,
                                                char letter)
{
  for (const struct command_option *option = command->options; option->name != NULL; option++) {
    if (name != NULL ? strlen(option->name) == length && memcmp(option->name, name, length) == 0
                     : option->letter == letter)
      return option;
  }
  return NULL;
}

static enum status unknown_option(const struct command *command, const char *word)
{
  const size_t length = strcspn(word, "=");
  const bool whole = word[1] == '-'; /* a word rather than letters */
  struct guess guess = guess_begin(word + 1 + whole, length - 1 - whole);
  for (const struct command_option *option = command->options; whole && option->name != NULL; option++)
    guess_consider(&guess, option->name, strlen(option->name));
  return (enum status)(guess.best == NULL
                         ? command_usage(command, "option '%s': unknown option", word)
                         : command_usage(command, "option '%.*s': unknown option; did you mean '--%s'?", (int)length,
                                         word, guess.best));
}

/* Hands an option over, with its argument: `joined`, where that is a part of the same word, else the next word. `said` is
 * how it stands on the command line. */
static enum status take_option(struct reading *reading, const struct command_option *option, const char *said,
                               const char *joined)
{
  const char *argument = joined;
  if (option->val == OPTION_HELP) {
    command_print_help(reading->command, stdout);
    reading->line->help = true;
    return command_finish_output(reading->command);
  }
  if (option->argument == NULL && joined != NULL)
    return (enum status)command_usage(reading->command, "option '%s': option does not take an argument", said);
  if (option->argument != NULL && joined == NULL) {
    argument = *reading->next;
    if (argument == NULL)
      return (enum status)command_usage(reading->command, "option '%s': missing argument", said);
    if (argument[0] == '-' && (argument[1] == '-' || isalpha((unsigned char)argument[1])))
      return (enum status)command_usage(reading->command, "option '%s': '%s' stands where its argument %s should be",
                                        said, argument, option->argument);
    reading->next++;
  }
  char *field = (char *)reading->context + option->offset;
  switch (option->store) {
  case STORE_TEXT:
    *(const char **)(void *)field = argument;
    return STATUS_OK;
  case STORE_TRUE:
    *(bool *)field = true;
    return STATUS_OK;
  case STORE_NUMBER:
    if (value_number(argument, (double *)(void *)field))
      return STATUS_OK;
    return (enum status)command_usage(reading->command, "'%s' is no number from 0 up, such as 0.01 or 4/255", argument);
  default:
    return reading->handle(reading->command, reading->context, option->val, argument);
  }
}

/* "--name", "--name=argument". */
static enum status read_long(struct reading *reading, const char *word)
{
  const size_t length = strcspn(word + 2, "=");
  const struct command_option *option = find_option(reading->command, word + 2, length, 0);
  if (option == NULL)
    return unknown_option(reading->command, word);
  return take_option(reading, option, word, word[2 + length] == '=' ? word + 2 + length + 1 : NULL);
}

/* "-a", "-abc" of several options, of which the last one may have its argument behind it. */
static enum status read_letters(struct reading *reading, const char *word)
{
  enum status status = STATUS_OK;
  for (const char *letter = word + 1; *letter != '\0' && status == STATUS_OK && !reading->line->help; letter++) {
    const struct command_option *option = find_option(reading->command, NULL, 0, *letter);
    if (option == NULL)
      return unknown_option(reading->command, word);
    const bool joined = option->argument != NULL && letter[1] != '\0';
    status = take_option(reading, option, word, joined ? letter + 1 + (letter[1] == '=') : NULL);
    if (joined)
      break;
  }
  return status;
}

enum status command_line_read(const struct command *command, int argc, const char **argv, size_t count,
                              command_option_handler *handle, void *context, struct command_line *out)
{
  *out = (struct command_line){ .positional = argv };
  struct reading reading = { command, handle, context, argv + (argc > 0), out };
  enum status status = STATUS_OK;
  bool options = true; /* until "--" */
  while (status == STATUS_OK && !out->help && *reading.next != NULL) {
    const char *word = *reading.next++;
    if (!options || word[0] != '-' || word[1] == '\0')
      argv[out->positional_count++] = word; /* behind what has been read already */
    else if (word[1] != '-')
      status = read_letters(&reading, word);
    else if (word[2] != '\0')
      status = read_long(&reading, word);
    else
      options = false;
  }
  if (status != STATUS_OK || out->help)
    return status;
  if (out->positional_count < count)
    return (enum status)command_usage(command, "an argument is missing: pscn %s %s", command->name, command->arguments);
  if (out->positional_count > count)
    return (enum status)command_usage(command, "one argument too many: '%s'", out->positional[count]);
  return STATUS_OK;
}

enum status command_finish_output(const struct command *command)
{
  if (fflush(stdout) == 0 && !ferror(stdout))
    return STATUS_OK;
  command_error(command, "cannot write standard output: %s", strerror(errno));
  return STATUS_FILE;
}

enum status command_written(const struct command *command, const char *path, enum status status, int reason)
{
  if (status == STATUS_FILE || status == STATUS_LIMIT)
    command_error(command, "cannot write '%s': %s", path, strerror(reason));
  return status;
}
