/* pscn chart SCENE: speed against accuracy. */
#include "command/chart.h"

#include <assert.h>
#include <math.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/atomic_file.h"
#include "base/sort.h"
#include "command/interrupt.h"
#include "command/output.h"
#include "command/values.h"

enum {
  OPTION_OUTPUT = 1,
  OPTION_RAYS,
  OPTION_ROUNDS,
  OPTION_QUICK,
  OPTION_NO_PEERS,
  OPTION_POVRAY,
  OPTION_QUIET
};

enum {
  MAX_RAYS = 1 << 22,
  RAYS = 2048, QUICK_RAYS = 1024, /* of the camera, about */
  ROUNDS = 5, QUICK_ROUNDS = 3,
  BATCH = 24                      /* points measured in turns; the default solver takes part in every batch */
};

static const struct poptOption OPTIONS[] = {
  COMMAND_HELP_OPTION,
  COMMAND_OPTION("output", 'o', OPTION_OUTPUT, "folder of the results; default: SCENE's name and -chart", "DIR"),
  SCENE_SIZE_OPTION("of the picture in pixels; default 800x600"),
  COMMAND_OPTION("rays", 0, OPTION_RAYS, "about so many camera rays; default 2048, 1024 with --quick", "N"),
  COMMAND_OPTION("rounds", 0, OPTION_ROUNDS, "measure each so often; default 5, 3 with --quick", "N"),
  COMMAND_FLAG("quick", 0, OPTION_QUICK, "fewer tolerances, rays and peers: under a minute"),
  COMMAND_FLAG("no-peers", 0, OPTION_NO_PEERS, "ask neither Embree nor POV-Ray"),
  COMMAND_OPTION("povray", 0, OPTION_POVRAY, "the program; default povray", "FILE"),
  COMMAND_FLAG("quiet", 'q', OPTION_QUIET, "say nothing unless something is wrong"),
  POPT_TABLEEND
};

static enum status take_option(const struct command *command, void *context, int val, const char *argument)
{
  struct chart *chart = context;
  switch (val) {
  case OPTION_OUTPUT:
    chart->output = argument;
    break;
  case OPTION_SIZE:
    return scene_request_take(command, &chart->scene_request, val, argument);
  case OPTION_RAYS:
    if (!value_integer(argument, 1, MAX_RAYS, &chart->wanted))
      return (enum status)command_usage(command, "'%s' is no number of rays from 1 to %d", argument, MAX_RAYS);
    break;
  case OPTION_ROUNDS:
    if (!value_integer(argument, 1, MEASURE_MAX_ROUNDS, &chart->rounds))
      return (enum status)command_usage(command, "'%s' is no number of rounds from 1 to %d", argument,
                                        MEASURE_MAX_ROUNDS);
    break;
  case OPTION_QUICK:
    chart->quick = true;
    break;
  case OPTION_NO_PEERS:
    chart->peers = false;
    break;
  case OPTION_POVRAY:
    chart->program = argument;
    break;
  default:
    chart->quiet = true;
    break;
  }
  return STATUS_OK;
}

void chart_tell(const struct chart *chart, const char *format, ...)
{
  if (chart->quiet)
    return;
  va_list arguments;
  va_start(arguments, format);
  vfprintf(stderr, format, arguments);
  fputc('\n', stderr);
  va_end(arguments);
}

void chart_note(struct chart *chart, const char *format, ...)
{
  if (chart->note_count == CHART_NOTES)
    return;
  char *note = chart->notes[chart->note_count++];
  va_list arguments;
  va_start(arguments, format);
  vsnprintf(note, sizeof chart->notes[0], format, arguments);
  va_end(arguments);
  chart_tell(chart, "%s", note);
}

struct chart_point *chart_add(struct chart *chart, enum family family)
{
  const struct timing unknown = { NAN, NAN, NAN, NAN, NAN, NAN };
  assert(chart->point_count < chart->point_room);
  struct chart_point *point = &chart->points[chart->point_count++];
  *point = (struct chart_point){ .family = family, .time = { unknown, unknown } };
  return point;
}

void chart_judge(struct chart *chart, struct chart_point *point)
{
  const struct ray_list *camera = &chart->rays[RAYS_CAMERA], *shadow = &chart->rays[RAYS_SHADOW];
  judge_answers(camera->count, chart->truths[RAYS_CAMERA], chart->answers, chart->errors, &point->camera);
  if (point->has_shadow)
    judge_occluded(shadow->count, shadow->rays, chart->truths[RAYS_SHADOW], chart->occluded, &point->shadow);
}

/* ---- the rays, and the truth about them ---- */

static enum status prepare_rays(struct chart *chart, const struct method *options)
{
  enum status status = rays_of_camera(chart->scene, chart->scene_request.width, chart->scene_request.height,
                                      chart->wanted, chart->arena, &chart->rays[RAYS_CAMERA]);
  if (status == STATUS_OK)
    status = pscn_runner_create(chart->scene, options, chart->rays, &chart->yardstick);
  const size_t count = chart->rays[RAYS_CAMERA].count;
  struct hit *hits = status == STATUS_OK ? arena_alloc(chart->arena, count + 1, sizeof *hits) : NULL;
  if (hits == NULL)
    return STATUS_LIMIT;
  pscn_runner_hits(&chart->yardstick, hits);
  return rays_of_shadows(chart->scene, &chart->rays[RAYS_CAMERA], hits, chart->arena, &chart->rays[RAYS_SHADOW]);
}

static enum status find_truths(struct chart *chart)
{
  const size_t camera = chart->rays[RAYS_CAMERA].count, shadow = chart->rays[RAYS_SHADOW].count;
  chart_tell(chart, "reference: %zu camera rays, %zu shadow rays", camera, shadow);
  chart->answers = arena_alloc(chart->arena, camera + 1, sizeof *chart->answers);
  chart->occluded = arena_alloc(chart->arena, shadow + 1, sizeof *chart->occluded);
  chart->errors = arena_alloc(chart->arena, 2 * camera + 1, sizeof *chart->errors);
  const bool room = chart->answers != NULL && chart->occluded != NULL && chart->errors != NULL;
  enum status status = room ? STATUS_OK : STATUS_LIMIT;
  for (int kind = 0; kind < RAY_KINDS && status == STATUS_OK; kind++) {
    struct truth *truths = arena_alloc(chart->arena, chart->rays[kind].count + 1, sizeof *truths);
    chart->truths[kind] = truths;
    status = truths == NULL ? STATUS_LIMIT : judge_truths(chart->scene, &chart->rays[kind], &interrupt_signal, truths);
  }
  return status;
}

/* ---- the sweep over our own solvers ---- */

static void judge_ours(struct chart *chart, struct pscn_runner *runner, struct chart_point *point)
{
  const size_t count = chart->rays[RAYS_CAMERA].count;
  struct hit *hits = malloc((count + 1) * sizeof *hits);
  if (hits == NULL)
    return;
  pscn_runner_hits(runner, hits);
  for (size_t k = 0; k < count; k++)
    chart->answers[k] = (struct answer){ hits[k].patch == HIT_NONE ? INFINITY : hits[k].t, hits[k].patch };
  pscn_runner_occluded(runner, chart->occluded);
  point->has_shadow = true;
  chart_judge(chart, point);
  free(hits);
}

/* Measures and judges sweep[0..count), count <= BATCH, with the yardstick in front. */
static enum status run_batch(struct chart *chart, const struct sweep_point *sweep, size_t count)
{
  static struct pscn_runner ours[BATCH];
  struct runner runners[1 + BATCH] = { pscn_runner_face(&chart->yardstick) };
  struct timing time[1 + BATCH][RAY_KINDS];
  const size_t counts[RAY_KINDS] = { chart->rays[RAYS_CAMERA].count, chart->rays[RAYS_SHADOW].count };
  memset(ours, 0, sizeof ours);
  enum status status = STATUS_OK;
  for (size_t k = 0; k < count && status == STATUS_OK; k++) {
    status = pscn_runner_create(chart->scene, &sweep[k].options, chart->rays, &ours[k]);
    runners[1 + k] = pscn_runner_face(&ours[k]);
  }
  if (status == STATUS_OK)
    status = measure_rounds(runners, 1 + count, counts, chart->rounds, &interrupt_signal, time);
  if (status == STATUS_OK) {
    for (int kind = 0; kind < RAY_KINDS; kind++)
      chart->yard[kind][chart->yard_count] = time[0][kind].median;
    chart->yard_count++;
  }
  for (size_t k = 0; k < count && status == STATUS_OK; k++) {
    struct chart_point *point = chart_add(chart, sweep[k].family);
    point->ours = true;
    point->options = sweep[k].options;
    method_text(&point->options, point->name, sizeof point->name);
    memcpy(point->time, time[1 + k], sizeof point->time);
    judge_ours(chart, &ours[k], point);
  }
  for (size_t k = 0; k < count; k++)
    pscn_runner_free(&ours[k]);
  return status;
}

static enum status sweep_solvers(struct chart *chart, const struct sweep_point *sweep, size_t count)
{
  enum status status = STATUS_OK;
  for (size_t k = 0; k < count && status == STATUS_OK; k += BATCH) {
    chart_tell(chart, "solvers: %zu of %zu", k, count);
    status = run_batch(chart, sweep + k, count - k < BATCH ? count - k : BATCH);
  }
  return status;
}

/* ---- the results ---- */

enum { CSV, SVG, PAGE, RESULTS };

struct results {
  const char *name[RESULTS];
  struct page page[RESULTS]; /* SVG may be empty */
};

static void results_free(struct results *results)
{
  for (int k = 0; k < RESULTS; k++)
    page_free(&results->page[k]);
}

static enum status make_results(struct chart *chart, struct results *out)
{
  *out = (struct results){ .name = { "chart.csv", "chart.svg", "chart.html" } };
  chart_csv(chart, &out->page[CSV]);
  if (out->page[CSV].failed)
    return STATUS_LIMIT;
  const enum status status = chart_plot(chart, &out->page[SVG].text, &out->page[SVG].length);
  if (status != STATUS_OK)
    return status;
  chart_page(chart, out->page[SVG].text, &out->page[PAGE]);
  return page_finish(&out->page[PAGE]);
}

static void result_path(const struct chart *chart, const char *name, char out[SCRATCH_PATH_SIZE])
{
  snprintf(out, SCRATCH_PATH_SIZE, "%s/%s", chart->output, name);
}

/* All files, or none. A figure of an earlier chart goes where this one has none. */
static enum status write_results(const struct chart *chart, const struct results *results)
{
  char path[SCRATCH_PATH_SIZE];
  enum status status = STATUS_OK;
  for (int k = 0; k < RESULTS && status == STATUS_OK; k++) {
    int reason = 0;
    result_path(chart, results->name[k], path);
    if (results->page[k].text == NULL)
      (void)unlink(path);
    else
      status = atomic_file_write(path, results->page[k].text, results->page[k].length, &interrupt_signal, &reason);
    command_written(chart->command, path, status, reason);
    for (int made = 0; made < k && status != STATUS_OK; made++) {
      result_path(chart, results->name[made], path);
      (void)unlink(path);
    }
  }
  return status;
}

static enum status show_results(struct chart *chart)
{
  struct results results;
  enum status status = make_results(chart, &results);
  if (status == STATUS_OK)
    status = write_results(chart, &results);
  results_free(&results);
  if (status == STATUS_OK && !chart->quiet) {
    chart_print(chart);
    printf("\n%s/chart.html shows it\n", chart->output);
  }
  return status == STATUS_OK ? command_finish_output(chart->command) : status;
}

/* ---- the work ---- */

static enum status load(struct chart *chart)
{
  enum status status = scene_file_load(&chart->scene_request, &chart->scene);
  if (status != STATUS_OK)
    return status;
  chart->arena = arena_create();
  const size_t sweep = point_sweep(chart->quick, NULL);
  chart->point_room = sweep + CHART_PEER_POINTS;
  chart->points = chart->arena == NULL ? NULL : arena_alloc(chart->arena, chart->point_room, sizeof *chart->points);
  return chart->points == NULL ? STATUS_LIMIT : STATUS_OK;
}

static void level_times(struct chart *chart)
{
  double yard[RAY_KINDS];
  for (int kind = 0; kind < RAY_KINDS; kind++) {
    sort_numbers(chart->yard[kind], chart->yard_count);
    yard[kind] = chart->yard[kind][chart->yard_count / 2];
  }
  point_level(chart->points, chart->point_count, yard);
}

static enum status measure(struct chart *chart)
{
  const size_t count = point_sweep(chart->quick, NULL);
  struct sweep_point *sweep = arena_alloc(chart->arena, count, sizeof *sweep);
  if (sweep == NULL)
    return STATUS_LIMIT;
  for (int kind = 0; kind < RAY_KINDS; kind++) {
    chart->yard[kind] = arena_alloc(chart->arena, count / BATCH + 1, sizeof *chart->yard[kind]);
    if (chart->yard[kind] == NULL)
      return STATUS_LIMIT;
  }
  (void)point_sweep(chart->quick, sweep);
  scene_override_solver(chart->scene, &sweep[0].options);
  enum status status = prepare_rays(chart, &sweep[0].options);
  if (status == STATUS_OK)
    status = find_truths(chart);
  if (status == STATUS_OK)
    status = sweep_solvers(chart, sweep, count);
  if (status == STATUS_OK)
    status = chart_peers(chart);
  if (status == STATUS_OK) {
    level_times(chart);
    point_front(chart->points, chart->point_count);
  }
  return status;
}

static enum status chart_scene(struct chart *chart)
{
  bool made = false;
  if (!judge_available()) {
    command_error(chart->command, "this build has no reference: its compiler has no quadruple precision, so nothing "
                                  "can be judged");
    return STATUS_LIMIT;
  }
  enum status status = load(chart);
  interrupt_defer();
  if (status == STATUS_OK)
    status = output_folder_make(chart->command, chart->output, &made);
  if (status == STATUS_OK)
    status = measure(chart);
  if (status == STATUS_OK)
    status = show_results(chart);
  if (status != STATUS_OK && made)
    (void)rmdir(chart->output); /* stays where something is in it after all */
  if (status == STATUS_LIMIT)
    command_error(chart->command, "out of memory");
  pscn_runner_free(&chart->yardstick);
  arena_destroy(chart->arena);
  scene_destroy(chart->scene);
  return status;
}

static int run(const struct command *command, int argc, const char **argv)
{
  struct chart chart = { .command = command, .program = "povray", .peers = true,
                         .scene_request = { .width = DEFAULT_WIDTH, .height = DEFAULT_HEIGHT, .tolerance = NAN } };
  struct command_line line;
  char *default_name = NULL;
  enum status status = command_line_read(command, argc, argv, 1, take_option, &chart, &line);
  if (status == STATUS_OK && !line.help) {
    chart.scene_request.path = line.positional[0];
    if (chart.wanted == 0)
      chart.wanted = chart.quick ? QUICK_RAYS : RAYS;
    if (chart.rounds == 0)
      chart.rounds = chart.quick ? QUICK_ROUNDS : ROUNDS;
    if (chart.output == NULL)
      chart.output = default_name = output_folder_name(chart.scene_request.path, "-chart");
    if (chart.output != NULL)
      status = chart_scene(&chart);
    else
      status = STATUS_LIMIT;
  }
  free(default_name);
  command_line_free(&line);
  return status == STATUS_INTERRUPTED || atomic_load(&interrupt_signal) != 0 ? interrupt_exit_code() : (int)status;
}

const struct command command_chart = {
  .name = "chart",
  .arguments = "SCENE",
  .summary = "Charts speed against accuracy, for every solver and the peers",
  .description =
    "Camera rays of the scene, chosen evenly, and their shadow rays are answered by every solver, in every basis, at\n"
    "tolerances from 1e-1 to 1e-15, with and without polish, from cold and from previous start values, and as in the\n"
    "paper; by plain Newton from the middle of each part of a patch; by Embree on triangles, where pscn-embree stands\n"
    "beside pscn; and by POV-Ray, where it is installed. Each is timed in turns on one thread, and judged by a\n"
    "reference in quadruple precision that shares nothing with them. DIR receives chart.csv with every point,\n"
    "chart.svg with the Pareto front (drawn by gnuplot), and chart.html, which needs nothing beside itself. Standard\n"
    "output has the front. Solver statements of the scene mean nothing here.\n",
  .options = OPTIONS,
  .run = run,
};
