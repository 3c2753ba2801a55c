/* The order of a chart's work. */
#include "chart/chart.h"

#include <assert.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/sort.h"
#include "chart/work.h"
#include "scene/method.h"

enum {
  RAYS = 2048,
  QUICK_RAYS = 1024, /* of the camera, about */
  ROUNDS = 5,
  QUICK_ROUNDS = 3
};

/* ---- points, measured and judged ---- */

void chart_note(struct chart *chart, const char *format, ...)
{
  if (chart->note_count == CHART_NOTES) return;
  char *note = chart->notes[chart->note_count++];
  va_list arguments;
  va_start(arguments, format);
  vsnprintf(note, sizeof chart->notes[0], format, arguments);
  va_end(arguments);
  listener_tell(chart->listener, TOLD_PROGRESS, "%s", note);
}

struct chart_point *chart_add(struct chart *chart, const struct chart_point *said, const struct timing time[RAY_KINDS])
{
  assert(chart->point_count < chart->point_room);
  struct chart_point *point = &chart->points[chart->point_count++];
  *point = *said;
  memcpy(point->time, time, sizeof point->time);
  judge_answers(chart->rays[RAYS_CAMERA].count, chart->truths[RAYS_CAMERA], chart->answers, chart->errors,
                &point->camera);
  return point;
}

enum status chart_measure(struct chart *chart, size_t count, const struct runner runners[],
                          const struct chart_point said[], struct timing out_yard[RAY_KINDS])
{
  struct runner turns[1 + CHART_BATCH] = {pscn_runner_face(&chart->yardstick)};
  struct timing time[1 + CHART_BATCH][RAY_KINDS];
  const struct ray_list *shadow = &chart->rays[RAYS_SHADOW];
  const size_t counts[RAY_KINDS] = {chart->rays[RAYS_CAMERA].count, shadow->count};
  assert(count <= CHART_BATCH);
  memcpy(turns + 1, runners, count * sizeof *runners);
  const enum status status = measure_rounds(turns, 1 + count, counts, chart->rounds, chart->listener->stop, time);
  if (status != STATUS_OK) return status;
  for (size_t k = 0; k < count; k++) {
    runners[k].run(runners[k].context, RAYS_CAMERA, chart->answers);
    struct chart_point *point = chart_add(chart, &said[k], time[1 + k]);
    runners[k].run(runners[k].context, RAYS_SHADOW, chart->answers);
    judge_occluded(shadow->count, shadow->rays, chart->truths[RAYS_SHADOW], chart->answers, &point->shadow);
    point->has_shadow = true;
  }
  if (out_yard != NULL) memcpy(out_yard, time[0], sizeof time[0]);
  return STATUS_OK;
}

/* ---- the rays, and the truth about them ---- */

/* The camera rays, and the shadow rays of their hits. */
static enum status prepare_rays(struct chart *chart, const struct method *options)
{
  struct ray_list *camera = &chart->rays[RAYS_CAMERA];
  enum status status = rays_of_camera(chart->scene, chart->request->width, chart->request->height, chart->wanted,
                                      chart->arena, camera);
  if (status == STATUS_OK) status = pscn_runner_create(chart->scene, options, chart->rays, &chart->yardstick);
  if (status != STATUS_OK) return status;
  struct hit *hits = arena_alloc(chart->arena, camera->count + 1, sizeof *hits);
  if (hits == NULL) return STATUS_LIMIT;
  pscn_runner_hits(&chart->yardstick, hits);
  return rays_of_shadows(chart->scene, chart->yardstick.tracer, camera, hits, chart->arena, &chart->rays[RAYS_SHADOW]);
}

static enum status find_truths(struct chart *chart)
{
  const size_t camera = chart->rays[RAYS_CAMERA].count, shadow = chart->rays[RAYS_SHADOW].count;
  listener_tell(chart->listener, TOLD_PROGRESS, "reference: %zu camera rays, %zu shadow rays", camera, shadow);
  chart->answers = arena_alloc(chart->arena, camera + shadow + 1, sizeof *chart->answers);
  chart->errors = arena_alloc(chart->arena, 2 * camera + 1, sizeof *chart->errors);
  enum status status = chart->answers != NULL && chart->errors != NULL ? STATUS_OK : STATUS_LIMIT;
  for (int kind = 0; kind < RAY_KINDS && status == STATUS_OK; kind++) {
    struct truth *truths = arena_alloc(chart->arena, chart->rays[kind].count + 1, sizeof *truths);
    chart->truths[kind] = truths;
    status = truths == NULL ? STATUS_LIMIT
                            : judge_truths(chart->scene, &chart->rays[kind], chart->listener->stop, truths);
  }
  return status;
}

/* ---- the sweep over our own solvers ---- */

/* Runs sweep[0..count), count <= CHART_BATCH. */
static enum status run_batch(struct chart *chart, const struct sweep_point *sweep, size_t count)
{
  struct pscn_runner ours[CHART_BATCH];
  struct runner runners[CHART_BATCH];
  struct chart_point said[CHART_BATCH];
  struct timing yard[RAY_KINDS];
  enum status status = STATUS_OK;
  memset(ours, 0, sizeof ours);
  for (size_t k = 0; k < count && status == STATUS_OK; k++) {
    status = pscn_runner_create(chart->scene, &sweep[k].options, chart->rays, &ours[k]);
    runners[k] = pscn_runner_face(&ours[k]);
    said[k] = (struct chart_point){.family = sweep[k].family, .ours = true, .options = sweep[k].options};
    method_text(&sweep[k].options, said[k].name, sizeof said[k].name);
    if (chart->point_count + k == 0) strcpy(said[k].label, "default");
    else if (chart->request->solver_count > 0 && strstr(said[k].name, "form paper") != NULL)
      snprintf(said[k].label, sizeof said[k].label, "%g", sweep[k].options.roots.tolerance);
  }
  if (status == STATUS_OK) status = chart_measure(chart, count, runners, said, yard);
  for (int kind = 0; kind < RAY_KINDS && status == STATUS_OK; kind++)
    chart->yard[kind][chart->yard_count] = yard[kind].median;
  chart->yard_count += status == STATUS_OK;
  for (size_t k = 0; k < count; k++) pscn_runner_free(&ours[k]);
  return status;
}

static enum status sweep_solvers(struct chart *chart, const struct sweep_point *sweep, size_t count)
{
  enum status status = STATUS_OK;
  for (size_t k = 0; k < count && status == STATUS_OK; k += CHART_BATCH) {
    listener_tell(chart->listener, TOLD_PROGRESS, "solvers: %zu of %zu", k, count);
    status = run_batch(chart, sweep + k, count - k < CHART_BATCH ? count - k : CHART_BATCH);
  }
  return status;
}

/* ---- the work ---- */

static enum status make_room(struct chart *chart)
{
  chart->arena = arena_create();
  chart->point_room = SWEEP_MOST + chart->request->solver_count + CHART_PEER_POINTS;
  chart->points = chart->arena == NULL ? NULL : arena_alloc(chart->arena, chart->point_room, sizeof *chart->points);
  return chart->points == NULL ? STATUS_LIMIT : STATUS_OK;
}

static void level_times(struct chart *chart)
{
  double yard[RAY_KINDS];
  for (int kind = 0; kind < RAY_KINDS; kind++) {
    sort_numbers(chart->yard[kind], chart->yard_count);
    yard[kind] = sorted_quantile(chart->yard[kind], chart->yard_count, 0.5);
  }
  point_level(chart->points, chart->point_count, yard);
}

static enum status measure(struct chart *chart)
{
  const struct chart_request *request = chart->request;
  struct sweep_point *sweep = arena_alloc(chart->arena, chart->point_room, sizeof *sweep);
  size_t count = 1 + request->solver_count;
  if (sweep == NULL) return STATUS_LIMIT;
  if (request->solver_count > 0) point_choice(request->solvers, request->solver_count, sweep);
  else count = point_sweep(request->quick, sweep);
  for (int kind = 0; kind < RAY_KINDS; kind++) {
    chart->yard[kind] = arena_alloc(chart->arena, count / CHART_BATCH + 1, sizeof *chart->yard[kind]);
    if (chart->yard[kind] == NULL) return STATUS_LIMIT;
  }
  scene_override_solver(chart->scene, &sweep[0].options);
  enum status status = prepare_rays(chart, &sweep[0].options);
  if (status == STATUS_OK) status = find_truths(chart);
  if (status == STATUS_OK) status = sweep_solvers(chart, sweep, count);
  if (status == STATUS_OK && chart->points[0].camera.hits == 0)
    chart_note(chart, "No camera ray hits anything: there is no error of T, so there is neither a figure nor a front.");
  if (status == STATUS_OK) status = chart_peers(chart);
  if (status == STATUS_OK) {
    level_times(chart);
    point_front(chart->points, chart->point_count);
  }
  return status;
}

enum status chart_scene(const struct chart_request *request, struct scene *scene, const struct listener *listener,
                        struct text_buffer *out_text)
{
  *out_text = (struct text_buffer){0};
  if (!judge_available())
    return listener_fail(listener, STATUS_LIMIT,
                         "this build cannot judge answers: its compiler has no quadruple precision");
  struct chart chart = {.request = request,
                        .listener = listener,
                        .scene = scene,
                        .wanted = request->rays > 0 ? request->rays
                                  : request->quick  ? QUICK_RAYS
                                                    : RAYS,
                        .rounds = request->rounds > 0 ? request->rounds
                                  : request->quick    ? QUICK_ROUNDS
                                                      : ROUNDS};
  enum status status = make_room(&chart);
  if (status == STATUS_OK) status = measure(&chart);
  if (status == STATUS_LIMIT) (void)listener_out_of_memory(listener);
  if (status == STATUS_OK) status = chart_write(&chart, out_text);
  pscn_runner_free(&chart.yardstick);
  arena_destroy(chart.arena);
  return status;
}
