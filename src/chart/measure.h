/* Times of several ways to answer the same rays, taken in turns on one thread.
 *
 * Others use the machine too: every round asks each runner once, so that what disturbs disturbs all, and the ratio to
 * the first runner, the yardstick, is taken within a round.
 */
#ifndef PSCN_CHART_MEASURE_H
#define PSCN_CHART_MEASURE_H

#include <stdatomic.h>
#include <stddef.h>

#include "base/status.h"
#include "chart/judge.h"
#include "chart/rays.h"

enum { MEASURE_MAX_ROUNDS = 64 };

/* Nanoseconds of CPU time a ray over the rounds: least, quartiles, most; and the median ratio to the yardstick. All NAN
 * where nothing was measured. */
struct timing {
  double least, lower, median, upper, most, ratio;
};

/* The two kinds of rays of a chart. */
enum ray_kind { RAYS_CAMERA, RAYS_SHADOW, RAY_KINDS };

/* Answers all rays of a kind: into `answers`, of a shadow ray those of some hit, or where that is NULL for nothing but
 * the time it takes. */
struct runner {
  void (*run)(void *context, enum ray_kind kind, struct answer *answers);
  void *context;
};

/* Runs each runner once unmeasured, then gives it `rounds` turns (at most MEASURE_MAX_ROUNDS); in a turn of fast ones
 * the run is repeated until 1 ms is full, with warm caches. counts[kind] is the number of rays; where there are none
 * all is NAN. out[runner][kind]. STATUS_INTERRUPTED where *stop turns nonzero. */
enum status measure_rounds(const struct runner *runners, size_t count, const size_t counts[RAY_KINDS], size_t rounds,
                           const atomic_int *stop, struct timing (*out)[RAY_KINDS]) STATUS_MUST_CHECK;

/* pscn as a runner: the scene with one solver for all patches. */
struct pscn_runner {
  struct scene scene; /* a copy that shares all but its solver */
  struct method options;
  struct intersector *intersector;
  struct tracer *tracer;
  const struct ray_list *rays; /* [RAY_KINDS] */
};

/* Borrows the scene and rays[RAY_KINDS]; *out must not move. pscn_runner_free in any case. */
enum status pscn_runner_create(const struct scene *scene, const struct method *options, const struct ray_list *rays,
                               struct pscn_runner *out) STATUS_MUST_CHECK;
void pscn_runner_free(struct pscn_runner *runner);
struct runner pscn_runner_face(struct pscn_runner *runner);

/* The answers to the camera rays as the renderer has them. */
void pscn_runner_hits(struct pscn_runner *runner, struct hit *hits);

#endif
