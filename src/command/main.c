/* pscn: a table of subcommands. */
#include <stdio.h>
#include <string.h>

#include "base/version.h"
#include "command/command.h"
#include "command/interrupt.h"

int main(int argc, char **argv)
{
  interrupt_install();
  if (argc < 2) {
    command_print_overview(stderr);
    return STATUS_USAGE;
  }
  const char *name = argv[1];
  if (strcmp(name, "--version") == 0 && argc == 2) {
    printf("pscn %s\n", PSCN_VERSION);
    return (int)command_finish_output(NULL);
  }
  if (strcmp(name, "--help") == 0 || strcmp(name, "-h") == 0)
    name = command_help.name;
  const struct command *command = command_find(name);
  if (command == NULL)
    return command_usage(NULL, "unknown command '%s'", name);
  return command->run(command, argc - 1, (const char **)argv + 1);
}
