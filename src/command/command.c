/* What subcommands share: help texts, error lines, command lines. */
#include "command/command.h"

#include <errno.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

#include "command/interrupt.h"

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

static void print_option(const struct poptOption *option, FILE *file)
{
  enum { LABEL_SIZE = 80, LABEL_WIDTH = 22 };
  char label[LABEL_SIZE], letter[] = "    ";
  if (option->shortName != '\0')
    snprintf(letter, sizeof letter, "-%c, ", option->shortName);
  snprintf(label, sizeof label, "%s--%s %s", letter, option->longName,
           option->argDescrip == NULL ? "" : option->argDescrip);
  fprintf(file, "  %-*s  %s\n", LABEL_WIDTH, label, option->descrip);
}

void command_print_help(const struct command *command, FILE *file)
{
  fprintf(file, "usage: pscn %s%s%s%s\n%s.\n\n", command->name, command->arguments[0] == '\0' ? "" : " ",
          command->arguments, command->options[1].longName == NULL ? "" : " [OPTION...]", command->summary);
  fputs(command->description, file);
  fputs("\nOptions:\n", file);
  for (const struct poptOption *option = command->options; option->longName != NULL; option++)
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
  fputs("\n'pscn help COMMAND' tells more of each, 'pscn --version' the version.\n"
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

/* Keeps an option's argument until command_line_free. */
static bool take(struct command_line *line, char *argument)
{
  char **taken = realloc(line->taken, (line->taken_count + 1) * sizeof *taken);
  if (taken == NULL)
    return false;
  line->taken = taken;
  line->taken[line->taken_count++] = argument;
  return true;
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

static enum status read_options(const struct command *command, command_option_handler *handle, void *context,
                                struct command_line *line)
{
  int val;
  while ((val = poptGetNextOpt(line->context)) >= 0) {
    if (val == OPTION_HELP) {
      command_print_help(command, stdout);
      line->help = true;
      return command_finish_output(command);
    }
    char *argument = poptGetOptArg(line->context);
    if (argument != NULL && !take(line, argument)) {
      free(argument);
      command_error(command, "out of memory");
      return STATUS_LIMIT;
    }
    const enum status status = handle(command, context, val, argument);
    if (status != STATUS_OK)
      return status;
  }
  if (val < -1)
    return (enum status)command_usage(command, "option '%s': %s", poptBadOption(line->context, POPT_BADOPTION_NOALIAS),
                                      poptStrerror(val));
  return STATUS_OK;
}

enum status command_line_read(const struct command *command, int argc, const char **argv, size_t count,
                              command_option_handler *handle, void *context, struct command_line *out)
{
  *out = (struct command_line){ 0 };
  out->context = poptGetContext(NULL, argc, argv, command->options, 0);
  if (out->context == NULL) {
    command_error(command, "out of memory");
    return STATUS_LIMIT;
  }
  const enum status status = read_options(command, handle, context, out);
  if (status != STATUS_OK || out->help)
    return status;
  out->positional = poptGetArgs(out->context);
  while (out->positional != NULL && out->positional[out->positional_count] != NULL)
    out->positional_count++;
  if (out->positional_count < count)
    return (enum status)command_usage(command, "an argument is missing: pscn %s %s", command->name, command->arguments);
  if (out->positional_count > count)
    return (enum status)command_usage(command, "one argument too many: '%s'", out->positional[count]);
  return STATUS_OK;
}

void command_line_free(struct command_line *line)
{
  for (size_t k = 0; k < line->taken_count; k++)
    free(line->taken[k]);
  free(line->taken);
  if (line->context != NULL)
    poptFreeContext(line->context);
  *line = (struct command_line){ 0 };
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
