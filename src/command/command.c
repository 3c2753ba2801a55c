/* What subcommands share: help texts, error lines, command lines. */
#include "command/command.h"

#include <assert.h>
#include <ctype.h>
#include <errno.h>
#include <getopt.h>
#include <limits.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/memory.h"
#include "base/source.h"
#include "base/text_buffer.h"
#include "command/interrupt.h"
#include "command/values.h"
#include "language/words.h"

enum { MESSAGE_BYTES = 8192 }; /* longer messages are cut: a path has at most half of it */

/* In the order of the help text. */
static const struct command *const commands[] = {
  &command_render, &command_trace, &command_roots, &command_dump, &command_compare,
  &command_merge,  &command_check, &command_chart, &command_help, NULL};

const struct command *command_at(size_t index) { return commands[index]; }

const char command_exit_codes[] =
  "Exit codes: 0 done, 1 a comparison failed or parts are missing, 2 usage, 3 scene or input error, 4 file error,\n"
  "5 memory or a limit, 130, 143, 129 and 152 interrupted.\n";

const struct command *command_find(const char *name)
{
  for (const struct command *const *command = commands; *command != NULL; command++)
    if (strcmp((*command)->name, name) == 0) return *command;
  return NULL;
}

enum status command_unknown(const char *name)
{
  struct guess guess = guess_begin(name, strlen(name));
  for (const struct command *const *command = commands; *command != NULL; command++)
    guess_consider(&guess, (*command)->name, strlen((*command)->name));
  return guess.best == NULL ? command_usage(NULL, "unknown command '%s'", name)
                            : command_usage(NULL, "unknown command '%s'; did you mean '%s'?", name, guess.best);
}

static void print_option(const struct command_option *option, FILE *file)
{
  enum { LABEL_SIZE = 80, LABEL_WIDTH = 22 };
  char label[LABEL_SIZE], letter[] = "    ";
  if (option->letter != '\0') snprintf(letter, sizeof letter, "-%c, ", option->letter);
  snprintf(label, sizeof label, "%s--%s %s", letter, option->name, option->argument == NULL ? "" : option->argument);
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
  fputs("\n"
        "'pscn SCENE' renders the scene. 'pscn help COMMAND' explains a command, 'pscn --version' prints the "
        "version.\n",
        file);
  fputs(command_exit_codes, file);
}

void command_print(FILE *file, const char *text)
{
  for (const char *end = text + strlen(text), *begin = text, *at = text; begin < end; begin = at) {
    for (size_t size = 1; at < end && size > 0; at += size) {
      size = source_character(at, (size_t)(end - at));
      if (!source_is_shown(at, size) && *at != '\n') size = 0;
    }
    (void)fwrite(begin, 1, (size_t)(at - begin), file);
    if (at < end) fprintf(file, "\\x%02x", (unsigned char)*at++);
  }
}

static void print_told(const struct command *command, const char *kind, const char *format, va_list arguments)
{
  char text[MESSAGE_BYTES] = "";
  (void)vsnprintf(text, sizeof text, format, arguments);
  if (command == NULL) fprintf(stderr, "pscn: %s: ", kind);
  else fprintf(stderr, "pscn %s: %s: ", command->name, kind);
  command_print(stderr, text);
  fputc('\n', stderr);
}

void command_error(const struct command *command, const char *format, ...)
{
  va_list arguments;
  va_start(arguments, format);
  print_told(command, "error", format, arguments);
  va_end(arguments);
}

void command_warning(const struct command *command, const char *format, ...)
{
  va_list arguments;
  va_start(arguments, format);
  print_told(command, "warning", format, arguments);
  va_end(arguments);
}

enum status command_usage(const struct command *command, const char *format, ...)
{
  va_list arguments;
  va_start(arguments, format);
  print_told(command, "error", format, arguments);
  va_end(arguments);
  if (command == NULL) fputs("Try 'pscn help'.\n", stderr);
  else fprintf(stderr, "Try 'pscn help %s'.\n", command->name);
  return STATUS_USAGE;
}

enum status command_out_of_memory(const struct command *command)
{
  command_error(command, "%s",
                memory_limit_reached() ? "the scene needs more memory than is allowed; --max-memory allows more"
                                       : "out of memory");
  return STATUS_LIMIT;
}

static void hear(void *context, enum told what, const char *text)
{
  const struct command_ear *ear = context;
  if (what == TOLD_ERROR) command_error(ear->command, "%s", text);
  else if (what == TOLD_WARNING) command_warning(ear->command, "%s", text);
  else if (what == TOLD_DETAIL || !ear->quiet) fprintf(stderr, "%s\n", text);
}

struct listener command_listener(struct command_ear *ear)
{
  return (struct listener){.hear = hear, .context = ear, .stop = &interrupt_signal};
}

/* The command line as a shell reads it, in quotes where there are other characters than these; NULL if memory is short.
 * The caller frees it. */
static char *command_line_text(int argc, const char **argv)
{
  static const char plain[] = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-+=./:,@%";
  struct text_buffer text = {0};
  text_buffer_add_text(&text, "pscn");
  for (int k = 0; k < argc; k++) {
    const bool quoted = argv[k][0] == '\0' || argv[k][strspn(argv[k], plain)] != '\0';
    text_buffer_add_text(&text, quoted ? " '" : " ");
    for (const char *c = argv[k]; *c != '\0'; c++) text_buffer_format(&text, *c == '\'' ? "'\\''" : "%c", *c);
    if (quoted) text_buffer_add_text(&text, "'");
  }
  return text_buffer_take(&text);
}

/* ---- command lines ----
 *
 * They are read by libc's getopt_long, which needs no installation and no memory; popt silently dropped options when
 * memory was short. We are strict where getopt_long guesses: names are written in full, so that a new option makes no
 * old line ambiguous, and an option is never another one's argument.
 */

/* getopt_long returns FIRST_LONG + the table's row for a long option, the letter for a short one. */
enum { MOST_OPTIONS = 32, FIRST_LONG = UCHAR_MAX + 1, OPERAND = 1 };

struct getopt_tables {
  struct option names[MOST_OPTIONS + 1];
  char letters[2 * MOST_OPTIONS + 3];
};

static void make_tables(const struct command *command, struct getopt_tables *out)
{
  char *letter = out->letters;
  int row = 0;
  *letter++ = '-'; /* operands are returned in place, POSIXLY_CORRECT or not */
  *letter++ = ':'; /* we print the errors */
  for (const struct command_option *option = command->options; option->name != NULL; option++, row++) {
    const bool argument = option->argument != NULL;
    assert(row < MOST_OPTIONS);
    out->names[row] = (struct option){.name = option->name, .has_arg = argument, .val = FIRST_LONG + row};
    if (option->letter != '\0') letter += sprintf(letter, argument ? "%c:" : "%c", option->letter);
  }
  *letter = '\0';
  out->names[row] = (struct option){0};
}

/* `begun`: the name of the only option that begins with the word, or NULL. */
static void unknown_option(const struct command *command, const char *word, const char *begun)
{
  const size_t length = strcspn(word, "=");
  const bool whole = word[1] == '-'; /* a word rather than letters */
  struct guess guess = guess_begin(word + 1 + whole, length - 1 - whole);
  for (const struct command_option *option = command->options; whole && option->name != NULL; option++)
    guess_consider(&guess, option->name, strlen(option->name));
  if (begun == NULL && guess.best == NULL && strchr("0123456789.", word[1]) != NULL)
    command_usage(command, "option '%s': unknown option; numbers are read from files or standard input", word);
  else if (command == &command_render && (word[0] == '+' || isupper((unsigned char)word[1])))
    command_usage(command, "option '%s': unknown option; POV-Ray's options have other names here", word);
  else if (begun == NULL && guess.best == NULL) command_usage(command, "option '%s': unknown option", word);
  else
    command_usage(command, "option '%.*s': unknown option; did you mean '--%s'?", (int)length, word,
                  begun == NULL ? guess.best : begun);
}

/* The option that getopt_long found in `word`; if `apart`, its argument is a separate word. Returns NULL, after
 * printing the error, if there is no such option or its argument is wrong. */
static const struct command_option *find_option(const struct command *command, int found, const char *word, bool apart)
{
  const int code = found == '?' || found == ':' ? optopt : found;
  const struct command_option *option = command->options;
  for (int row = 0; option->name != NULL; option++, row++)
    if (code == FIRST_LONG + row || (option->letter != '\0' && code == option->letter)) break;
  if (option->name == NULL || (code >= FIRST_LONG && strlen(option->name) != strcspn(word + 2, "=")))
    unknown_option(command, word, option->name);
  else if (found == ':') command_usage(command, "option '%s': missing argument", word);
  else if (found == '?') command_usage(command, "option '%s': option does not take an argument", word);
  else if (apart && optarg[0] == '-' && (optarg[1] == '-' || isalpha((unsigned char)optarg[1])))
    command_usage(command, "option '%s': '%s' stands where its argument %s should be", word, optarg, option->argument);
  else return option;
  return NULL;
}

/* Stores the option's argument, or passes it to the handler. */
static enum status store_option(const struct command *command, const struct command_option *option,
                                const char *argument, void *request)
{
  void *const field = (char *)request + option->offset;
  double number;
  switch (option->store) {
  case STORE_TEXT: *(const char **)field = argument; return STATUS_OK;
  case STORE_TRUE: *(bool *)field = true; return STATUS_OK;
  case STORE_NUMBER:
    if (value_number(argument, field)) return STATUS_OK;
    return command_usage(command, "option '--%s': '%s' is not a number of at least 0, such as 0.01 or 4/255",
                         option->name, argument);
  case STORE_POSITIVE:
    if (!value_number(argument, &number) || number == 0)
      return command_usage(command, "'%s' is not a %s", argument, option->what);
    *(double *)field = number;
    return STATUS_OK;
  case STORE_INTEGER:
    if (value_integer(argument, option->least, option->most, field)) return STATUS_OK;
    return command_usage(command, "'%s' is not a %s from %zu to %zu", argument, option->what, option->least,
                         option->most);
  default: return command->take(command, request, option->val, argument);
  }
}

/* Reads options into the request. *out_help: --help was among them, and is answered. */
static enum status read_line(const struct command *command, int argc, const char **argv, void *request,
                             struct command_line *out, bool *out_help)
{
  struct getopt_tables tables;
  make_tables(command, &tables);
  out->positional = argv;
  optind = 0; /* getopt_long starts anew */
  for (int at = 1, found;; at = optind) {
    found = getopt_long(argc, (char *const *)argv, tables.letters, tables.names, NULL);
    if (found == -1) break;
    if (found == OPERAND && optarg[0] == '+' && access(optarg, F_OK) != 0) {
      unknown_option(command, optarg, NULL);
      return STATUS_USAGE;
    }
    if (found == OPERAND) {
      argv[out->positional_count++] = optarg; /* after those already read */
      continue;
    }
    const bool apart = optind == at + 2;
    const struct command_option *option = find_option(command, found, argv[at], apart);
    if (option == NULL) return STATUS_USAGE;
    if (option->val == OPTION_HELP) {
      command_print_help(command, stdout);
      *out_help = true;
      return command_finish_output(command);
    }
    const bool equals = found < FIRST_LONG && !apart && optarg != NULL && optarg[0] == '='; /* -o=FILE */
    const enum status status = store_option(command, option, equals ? optarg + 1 : optarg, request);
    if (status != STATUS_OK) return status;
  }
  while (optind < argc) /* after "--" */
    argv[out->positional_count++] = argv[optind++];
  if (out->positional_count < command->operands)
    return command_usage(command, "an argument is missing: pscn %s %s", command->name, command->arguments);
  const size_t most = command->operands + (strchr(command->arguments, '[') != NULL);
  if (out->positional_count > most && strstr(command->arguments, "...") == NULL)
    return command_usage(command, "one argument too many: '%s'", out->positional[most]);
  return STATUS_OK;
}

enum status command_run(const struct command *command, int argc, const char **argv)
{
  char *text = command_line_text(argc, argv);
  void *request = malloc(command->request_size);
  struct command_line line = {.text = text == NULL ? "" : text};
  bool help = false;
  enum status status = STATUS_LIMIT;
  if (request != NULL) {
    memcpy(request, command->request, command->request_size);
    status = read_line(command, argc, argv, request, &line, &help);
    if (status == STATUS_OK && !help) status = command->run(command, request, &line);
    if (command->end != NULL) command->end(request);
  } else {
    (void)command_out_of_memory(command);
  }
  free(request);
  (void)memory_limit_use(NULL); /* that of a scene, which has not counted the text */
  memory_free(text);
  return status;
}

enum status command_finish_output(const struct command *command)
{
  if (fflush(stdout) == 0 && !ferror(stdout)) return STATUS_OK;
  command_error(command, "cannot write standard output: %s", strerror(errno));
  return STATUS_FILE;
}
