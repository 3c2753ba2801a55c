/* pscn chart SCENE: speed against accuracy. */
#include "chart/chart.h"

#include <stdlib.h>

#include "chart/measure.h"
#include "command/command.h"
#include "command/output.h"
#include "command/scene_file.h"
#include "language/language.h"

enum { MAX_RAYS = 1 << 22 };
enum { OPTION_SOLVER = 1 };

/* The command line's request. */
struct request {
  struct scene_request scene; /* first: passed to scene_request_take */
  struct chart_request chart;
  struct output_folder folder;
  bool no_peers;
};

static const struct command_option OPTIONS[] = {
  COMMAND_HELP_OPTION,
  COMMAND_TEXT("output", 'o', folder.path, "folder of the results; default: SCENE's name and -chart", "DIR"),
  SCENE_SIZE_OPTION("width and height in pixels; default 800x600"),
  SCENE_READING_OPTIONS,
  COMMAND_OPTION("solver", 0, OPTION_SOLVER, "only this solver and the default; may be repeated", "TEXT"),
  COMMAND_INTEGER("rays", chart.rays, 1, MAX_RAYS, "number of rays",
                  "about this many camera rays; default 2048, 1024 with --quick", "N"),
  COMMAND_INTEGER("rounds", chart.rounds, 1, MEASURE_MAX_ROUNDS, "number of rounds",
                  "number of measurements of each; default 5, 3 with --quick", "N"),
  COMMAND_TRUE("quick", 0, chart.quick, "fewer tolerances, rays and peers: under a minute"),
  COMMAND_TRUE("no-peers", 0, no_peers, "leave out Embree and POV-Ray"),
  COMMAND_TEXT("povray", 0, chart.povray.program, "POV-Ray's program; default povray", "FILE"),
  COMMAND_POSITIVE("timeout", chart.povray.timeout, "number of seconds", "limit of each run of POV-Ray; default 300",
                   "S"),
  COMMAND_TRUE("quiet", 'q', scene.quiet, "print nothing unless something is wrong"),
  COMMAND_OPTIONS_END,
};

/* --solver adds to a list. */
static enum status take_option(const struct command *command, void *context, int val, const char *argument)
{
  struct request *request = context;
  struct chart_request *chart = &request->chart;
  if (val != OPTION_SOLVER) return scene_request_take(command, &request->scene, val, argument);
  struct diagnostics diagnostics = stderr_diagnostics(command);
  struct method *solvers = realloc(chart->solvers, (chart->solver_count + 1) * sizeof *solvers);
  if (solvers == NULL) return command_out_of_memory(command);
  chart->solvers = solvers;
  return language_parse_solver(argument, &diagnostics, &solvers[chart->solver_count++]);
}

static enum status work(void *context, const struct output_job *job)
{
  struct chart_request *chart = &((struct request *)context)->chart;
  chart->folder = job->folder;
  return chart_scene(chart, job->scene, job->listener, job->out_text);
}

static const struct request DEFAULTS = {
  .scene = SCENE_REQUEST_DEFAULT,
  .chart.povray = {.program = "povray", .timeout = POVRAY_TIMEOUT},
  .folder = {.suffix = "-chart", .files = chart_files, .file_count = CHART_FILES}};

static enum status run(const struct command *command, void *context, const struct command_line *line)
{
  struct request *request = context;
  struct chart_request *chart = &request->chart;
  chart->path = request->scene.path = line->positional[0];
  chart->command_line = line->text;
  chart->width = request->scene.width;
  chart->height = request->scene.height;
  chart->povray.memory = scene_request_memory(&request->scene);
  chart->peers = !request->no_peers;
  return output_folder_fill(command, &request->folder, &request->scene, work, request);
}

static void end(void *context) { free(((struct request *)context)->chart.solvers); }

const struct command command_chart = {
  .name = "chart",
  .arguments = "SCENE",
  .summary = "Charts speed against accuracy, for every solver and the peers",
  .description =
    "Solves camera rays of the scene, chosen evenly, and their shadow rays by every solver but durand_kerner, in\n"
    "every basis, at tolerances from 1e-1 to 1e-15, with and without polish, from cold and from previous start\n"
    "values, and as in the paper; by rival methods (Newton, clipping, boxes, eigenvalues); by Embree on triangles\n"
    "and by POV-Ray, if they are installed. All take turns on one thread. A reference in quadruple precision, which\n"
    "shares nothing with them, finds the errors. DIR receives chart.csv with every point, chart.svg (drawn by\n"
    "gnuplot) and the self-contained chart.html. Standard output has the Pareto front. Solver statements of the\n"
    "scene are ignored; with --solver only the named solvers and the default are charted.\n",
  COMMAND_RUNS(1, take_option),
  .end = end,
};
