/* pscn help [COMMAND] */
#include <string.h>

#include "command/command.h"

static const struct command_option OPTIONS[] = {COMMAND_HELP_OPTION, COMMAND_OPTIONS_END};

static enum status run(const struct command *command, int argc, const char **argv)
{
  if (argc > 2) return command_usage(NULL, "one argument too many: '%s'", argv[2]);
  if (argc < 2) {
    command_print_overview(stdout);
    return command_finish_output(command);
  }
  const bool itself = strcmp(argv[1], "--help") == 0 || strcmp(argv[1], "-h") == 0;
  const struct command *subject = itself ? command : command_find(argv[1]);
  if (subject == NULL) return command_unknown(argv[1]);
  command_print_help(subject, stdout);
  return command_finish_output(command);
}

const struct command command_help = {
  .name = "help",
  .arguments = "[COMMAND]",
  .summary = "Tells how pscn or one of its commands is used",
  .description = "Without an argument the commands are listed.\n",
  .options = OPTIONS,
  .run = run,
};
