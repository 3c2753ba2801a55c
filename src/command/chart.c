/* pscn chart SCENE: speed against accuracy. */
#include "chart/chart.h"

#include <math.h>
#include <stdlib.h>

#include "chart/measure.h"
#include "check/povray.h"
#include "command/command.h"
#include "command/output.h"
#include "command/scene_file.h"
#include "command/values.h"

enum {
  OPTION_OUTPUT = 1,
  OPTION_RAYS,
  OPTION_ROUNDS,
  OPTION_QUICK,
  OPTION_NO_PEERS,
  OPTION_POVRAY,
  OPTION_TIMEOUT,
  OPTION_QUIET
};

enum { MAX_RAYS = 1 << 22 };

static const struct command_option OPTIONS[] = {
  COMMAND_HELP_OPTION,
  COMMAND_OPTION("output", 'o', OPTION_OUTPUT, "folder of the results; default: SCENE's name and -chart", "DIR"),
  SCENE_SIZE_OPTION("of the picture in pixels; default 800x600"),
  COMMAND_OPTION("rays", 0, OPTION_RAYS, "about so many camera rays; default 2048, 1024 with --quick", "N"),
  COMMAND_OPTION("rounds", 0, OPTION_ROUNDS, "measure each so often; default 5, 3 with --quick", "N"),
  COMMAND_FLAG("quick", 0, OPTION_QUICK, "fewer tolerances, rays and peers: under a minute"),
  COMMAND_FLAG("no-peers", 0, OPTION_NO_PEERS, "ask neither Embree nor POV-Ray"),
  COMMAND_OPTION("povray", 0, OPTION_POVRAY, "the program; default povray", "FILE"),
  COMMAND_OPTION("timeout", 0, OPTION_TIMEOUT, "seconds that each run of it may take; default 300", "S"),
  COMMAND_FLAG("quiet", 'q', OPTION_QUIET, "say nothing unless something is wrong"),
  COMMAND_OPTIONS_END
};

/* What the command line says. */
struct line {
  struct chart_request request;
  struct scene_request scene;
  struct output_folder folder;
  struct command_ear ear;
};

static enum status take_option(const struct command *command, void *context, int val, const char *argument)
{
  struct line *line = context;
  struct chart_request *request = &line->request;
  switch (val) {
  case OPTION_OUTPUT:
    line->folder.path = argument;
    break;
  case OPTION_SIZE:
    return scene_request_take(command, &line->scene, val, argument);
  case OPTION_RAYS:
    if (!value_integer(argument, 1, MAX_RAYS, &request->rays))
      return (enum status)command_usage(command, "'%s' is no number of rays from 1 to %d", argument, MAX_RAYS);
    break;
  case OPTION_ROUNDS:
    if (!value_integer(argument, 1, MEASURE_MAX_ROUNDS, &request->rounds))
      return (enum status)command_usage(command, "'%s' is no number of rounds from 1 to %d", argument,
                                        MEASURE_MAX_ROUNDS);
    break;
  case OPTION_QUICK:
    request->quick = true;
    break;
  case OPTION_NO_PEERS:
    request->peers = false;
    break;
  case OPTION_POVRAY:
    request->program = argument;
    break;
  case OPTION_TIMEOUT:
    if (!value_number(argument, &request->timeout) || request->timeout == 0)
      return (enum status)command_usage(command, "'%s' is no number of seconds", argument);
    break;
  default:
    line->ear.quiet = true;
    break;
  }
  return STATUS_OK;
}

static enum status work(void *context, const char *folder, struct page *out_text)
{
  struct line *line = context;
  struct chart_request *request = &line->request;
  const struct listener listener = command_listener(&line->ear);
  struct scene *scene = NULL;
  request->folder = folder;
  request->memory = scene_request_memory(&line->scene);
  request->width = line->scene.width;
  request->height = line->scene.height;
  enum status status = scene_file_load(line->ear.command, &line->scene, &scene);
  if (status == STATUS_OK)
    status = chart_scene(request, scene, &listener, out_text);
  scene_destroy(scene);
  return status;
}

static int run(const struct command *command, int argc, const char **argv)
{
  struct line line = { .request = { .program = "povray", .timeout = POVRAY_TIMEOUT, .peers = true },
                       .scene = { .width = DEFAULT_WIDTH, .height = DEFAULT_HEIGHT, .tolerance = NAN },
                       .folder = { .suffix = "-chart", .page = "chart.html" },
                       .ear = { .command = command } };
  struct command_line arguments;
  char *command_line = command_line_text(argc, argv);
  enum status status = command_line_read(command, argc, argv, 1, take_option, &line, &arguments);
  if (status == STATUS_OK && !arguments.help) {
    line.request.path = line.scene.path = line.folder.scene = arguments.positional[0];
    line.request.command_line = command_line == NULL ? "" : command_line;
    line.folder.quiet = line.ear.quiet;
    status = output_folder_fill(command, &line.folder, work, &line);
  }
  free(command_line);
  return (int)status;
}

const struct command command_chart = {
  .name = "chart",
  .arguments = "SCENE",
  .summary = "Charts speed against accuracy, for every solver and the peers",
  .description =
    "Camera rays of the scene, chosen evenly, and their shadow rays are answered by every solver, in every basis, at\n"
    "tolerances from 1e-1 to 1e-15, with and without polish, from cold and from previous start values, and as in the\n"
    "paper; by plain Newton from the middle of each part of a patch; by Embree on triangles, where its module is\n"
    "built; and by POV-Ray, where it is installed. Each is timed in turns on one thread, and judged by a\n"
    "reference in quadruple precision that shares nothing with them. DIR receives chart.csv with every point,\n"
    "chart.svg with the Pareto front (drawn by gnuplot), and chart.html, which needs nothing beside itself. Standard\n"
    "output has the front. Solver statements of the scene mean nothing here.\n",
  .options = OPTIONS,
  .run = run,
};
