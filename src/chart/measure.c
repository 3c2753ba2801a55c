/* Rounds of measurements. */
#include "chart/measure.h"

#include <math.h>
#include <stdlib.h>

#include "base/clock.h"
#include "base/sort.h"

static double thread_seconds(void) { return clock_seconds(CLOCK_THREAD_CPUTIME_ID); }

/* Summarises values[round], in seconds, of the runner and of the yardstick. Sorts a copy. */
static struct timing summarise(const double *values, const double *yard, size_t rounds, size_t rays)
{
  double sorted[MEASURE_MAX_ROUNDS], ratio[MEASURE_MAX_ROUNDS];
  for (size_t k = 0; k < rounds; k++) sorted[k] = 1e9 * values[k] / (double)rays, ratio[k] = values[k] / yard[k];
  sort_numbers(sorted, rounds);
  sort_numbers(ratio, rounds);
  return (struct timing){.least = sorted[0],
                         .lower = sorted_quantile(sorted, rounds, 0.25),
                         .median = sorted_quantile(sorted, rounds, 0.5),
                         .upper = sorted_quantile(sorted, rounds, 0.75),
                         .most = sorted[rounds - 1],
                         .ratio = sorted_quantile(ratio, rounds, 0.5)};
}

/* The least duration of a turn, in seconds. Fast runners repeat, after one unmeasured run, because the runner before
 * has left its own data in the caches. */
#define LEAST_TURN 1e-3

enum { MOST_REPEATS = 1000 };

/* Seconds of one run, from a turn of `repeats`. */
static double take_turn(const struct runner *runner, enum ray_kind kind, size_t repeats)
{
  if (repeats > 1) runner->run(runner->context, kind, NULL);
  const double start = thread_seconds();
  for (size_t k = 0; k < repeats; k++) runner->run(runner->context, kind, NULL);
  return (thread_seconds() - start) / (double)repeats;
}

static size_t repeats_for(double seconds)
{
  const double repeats = ceil(LEAST_TURN / fmax(seconds, LEAST_TURN / MOST_REPEATS));
  return (size_t)repeats;
}

enum status measure_rounds(const struct runner *runners, size_t count, const size_t counts[RAY_KINDS], size_t rounds,
                           const atomic_int *stop, struct timing (*out)[RAY_KINDS])
{
  double(*seconds)[RAY_KINDS][MEASURE_MAX_ROUNDS] = calloc(count, sizeof *seconds);
  size_t(*repeats)[RAY_KINDS] = calloc(count, sizeof *repeats);
  if (seconds == NULL || repeats == NULL) {
    free(seconds);
    free(repeats);
    return STATUS_LIMIT;
  }
  bool stopped = false;
  for (size_t round = 0; round <= rounds && !stopped; round++) { /* the first only determines the repeats */
    for (size_t k = 0; k < count && !stopped; k++) {
      for (int kind = 0; kind < RAY_KINDS; kind++) {
        if (counts[kind] == 0) continue;
        if (round == 0) repeats[k][kind] = repeats_for(take_turn(&runners[k], (enum ray_kind)kind, 1));
        else seconds[k][kind][round - 1] = take_turn(&runners[k], (enum ray_kind)kind, repeats[k][kind]);
      }
      stopped = stop != NULL && atomic_load(stop) != 0;
    }
  }
  for (size_t k = 0; k < count; k++) {
    for (int kind = 0; kind < RAY_KINDS; kind++) {
      const bool known = counts[kind] > 0 && rounds > 0;
      out[k][kind] = known ? summarise(seconds[k][kind], seconds[0][kind], rounds, counts[kind])
                           : (struct timing){NAN, NAN, NAN, NAN, NAN, NAN};
    }
  }
  free(seconds);
  free(repeats);
  return stopped ? STATUS_INTERRUPTED : STATUS_OK;
}

/* ---- pscn itself ---- */

enum status pscn_runner_create(const struct scene *scene, const struct method *options, const struct ray_list *rays,
                               struct pscn_runner *out)
{
  *out = (struct pscn_runner){.scene = *scene, .options = *options, .rays = rays};
  out->scene.solvers = &out->options;
  out->scene.solver_count = 1;
  const enum status status = intersector_create(&out->scene, &out->intersector);
  return status != STATUS_OK ? status : tracer_create(out->intersector, &out->tracer);
}

void pscn_runner_free(struct pscn_runner *runner)
{
  tracer_destroy(runner->tracer);
  intersector_destroy(runner->intersector);
  *runner = (struct pscn_runner){.tracer = NULL};
}

/* Writes hits or answers, whichever are not NULL. */
static void trace(struct pscn_runner *runner, enum ray_kind kind, struct hit *hits, struct answer *answers)
{
  const struct ray_list *list = &runner->rays[kind];
  for (size_t p = 0; p < list->packet_count; p++) {
    const struct ray_packet *packet = &list->packets[p];
    const struct ray *rays = &list->rays[packet->first];
    struct hit own_hits[PACKET_SIZE], *hit = hits == NULL ? own_hits : hits + packet->first;
    bool occluded[PACKET_SIZE];
    if (packet->new_run) tracer_forget(runner->tracer);
    if (kind == RAYS_CAMERA) tracer_closest(runner->tracer, packet->count, rays, hit);
    else tracer_occluded(runner->tracer, packet->count, rays, occluded);
    for (size_t k = 0; k < packet->count && answers != NULL; k++) {
      const bool met = kind == RAYS_CAMERA ? hit[k].patch != HIT_NONE : occluded[k];
      answers[packet->first + k] = kind == RAYS_CAMERA ? (struct answer){met ? hit[k].t : INFINITY, hit[k].patch}
                                                       : (struct answer){met ? 0 : INFINITY, ANSWER_PATCH_UNKNOWN};
    }
  }
}

static void run(void *context, enum ray_kind kind, struct answer *answers) { trace(context, kind, NULL, answers); }

struct runner pscn_runner_face(struct pscn_runner *runner) { return (struct runner){run, runner}; }

void pscn_runner_hits(struct pscn_runner *runner, struct hit *hits) { trace(runner, RAYS_CAMERA, hits, NULL); }
