/* Times of several ways to answer the same rays, measured in turns on one thread.
 *
 * Others use the machine too. So every round asks each runner once, and what disturbs one disturbs all. The ratio to
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

/* Nanoseconds of CPU time for each ray, over the rounds: least, quartiles, most; and the median ratio to the yardstick.
 * All NAN if nothing was measured. */
struct timing {
  double least, lower, median, upper, most, ratio;
};

/* The two kinds of rays of a chart. */
enum ray_kind { RAYS_CAMERA, RAYS_SHADOW, RAY_KINDS };

/* Answers all rays of a kind into `answers`; for shadow rays, with any hit. If `answers` is NULL, only the time
 * counts. */
struct runner {
  void (*run)(void *context, enum ray_kind kind, struct answer *answers);
  void *context;
};

/* Runs each runner once unmeasured, then gives it `rounds` turns (at most MEASURE_MAX_ROUNDS). In a turn, a fast runner
 * repeats its run until 1 ms is full, with warm caches. counts[kind] is the number of rays; if it is 0, all is NAN.
 * out[runner][kind]. STATUS_INTERRUPTED if *stop becomes nonzero. */
enum status measure_rounds(const struct runner *runners, size_t count, const size_t counts[RAY_KINDS], size_t rounds,
                           const atomic_int *stop, struct timing (*out)[RAY_KINDS]) STATUS_MUST_CHECK;

/* pscn as a runner: the scene with one solver for all patches. */
struct pscn_runner {
  struct scene scene; /* a copy that shares everything but its solver */
  struct method options;
  struct intersector *intersector;
  struct tracer *tracer;
  const struct ray_list *rays; /* [RAY_KINDS] */
};

/* Borrows the scene and rays[RAY_KINDS]; *out must not move. Call pscn_runner_free in any case. */
enum status pscn_runner_create(const struct scene *scene, const struct method *options, const struct ray_list *rays,
                               struct pscn_runner *out) STATUS_MUST_CHECK;
void pscn_runner_free(struct pscn_runner *runner);
struct runner pscn_runner_face(struct pscn_runner *runner);

/* The renderer's answers to the camera rays. */
void pscn_runner_hits(struct pscn_runner *runner, struct hit *hits);

#endif
