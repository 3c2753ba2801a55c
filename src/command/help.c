/* pscn help [COMMAND | solver | channels] */
#include <string.h>

#include "command/command.h"
#include "render/channels.h"
#include "scene/method.h"

static const struct command_option OPTIONS[] = {COMMAND_HELP_OPTION, COMMAND_OPTIONS_END};

/* "start cold|previous", "split auto|N" */
static void print_item(const struct method_item *item)
{
  enum { LABEL_WIDTH = 36 };
  static const char *const number[] = {[METHOD_ITEM_NUMBER] = "X", [METHOD_ITEM_INTEGER] = "N"};
  int width = printf("  %s ", item->name);
  for (size_t k = 0; item->keywords != NULL && item->keywords[k] != NULL; k++)
    width += printf("%s%s", k == 0 ? "" : "|", item->keywords[k]);
  if (item->kind != METHOD_ITEM_KEYWORD) width += printf("%s%s", item->keywords == NULL ? "" : "|", number[item->kind]);
  printf("%*s  %s\n", width < LABEL_WIDTH + 2 ? LABEL_WIDTH + 2 - width : 0, "", item->summary);
}

static void print_solver_help(void)
{
  puts("usage: solver NAME { ITEM VALUE ... }          in a scene\n"
       "       --solver 'NAME { ITEM VALUE ... }'       of render, trace, roots, dump and check\n"
       "Chooses how roots are found. Every item may be left out, and so may empty braces.\n"
       "\n"
       "Names:");
  for (size_t k = 0; k < solver_count(); k++) printf("  %-15s %s\n", solver_at(k)->name, solver_at(k)->summary);
  puts("\nItems:");
  for (size_t k = 0; k < method_item_count(); k++) print_item(method_item_at(k));
}

static void print_channels_help(void)
{
  puts(
    "usage: --channels NAME[,NAME...]       of render, into an EXR\n"
    "The values of each pixel; their names in the file are in brackets. All but rgb need EXR and have 32 bits. From\n"
    "depth on they are those of one sample, the middle one: the pixel's centre if the number of samples is odd.\n"
    "\n"
    "Names:");
  for (int kind = 0; kind < CHANNEL_KINDS; kind++) {
    const struct channel_traits *traits = channel_traits((enum channel_kind)kind);
    printf("  %-10s  %s (", traits->name, traits->summary);
    for (size_t k = 0; k < traits->width; k++) printf("%s%s", k == 0 ? "" : ", ", traits->value_names[k]);
    puts(")");
  }
}

static const struct {
  const char *name;
  void (*print)(void);
} TOPICS[] = {{"solver", print_solver_help}, {"channels", print_channels_help}};

static const char DEFAULTS = 0; /* it has no options */

static enum status run(const struct command *command, void *request, const struct command_line *line)
{
  const char *name = line->positional_count == 0 ? NULL : line->positional[0];
  (void)request;
  if (name == NULL) {
    command_print_overview(stdout);
    return command_finish_output(command);
  }
  for (size_t k = 0; k < sizeof TOPICS / sizeof *TOPICS; k++) {
    if (strcmp(name, TOPICS[k].name) != 0) continue;
    TOPICS[k].print();
    return command_finish_output(command);
  }
  const struct command *subject = command_find(name);
  if (subject == NULL) return command_unknown(name);
  command_print_help(subject, stdout);
  return command_finish_output(command);
}

const struct command command_help = {
  .name = "help",
  .arguments = "[COMMAND]",
  .summary = "Explains pscn or one of its commands",
  .description =
    "Without an argument it lists the commands. `pscn help solver` lists the solvers and their items, `pscn help\n"
    "channels` the channels of a picture.\n",
  COMMAND_RUNS(0, NULL),
};
