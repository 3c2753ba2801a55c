/* What the files of src/intersect share: the tracer, and the kernels that do its work.
 *
 * Internal to src/intersect.
 */
#ifndef PSCN_INTERSECT_TRACER_H
#define PSCN_INTERSECT_TRACER_H

#include "algebra/solver.h"
#include "intersect/intersect.h"
#include "intersect/local_ray.h"
#include "intersect/model.h"

/* The entry points of one instruction set. */
struct kernel {
  const char *name;
  void (*closest)(struct tracer *tracer, size_t count, const struct ray rays[], struct hit out_hits[]);
  void (*occluded)(struct tracer *tracer, size_t count, const struct ray rays[], bool out_occluded[]);
};

enum { KERNELS_MAX = 3 };

/* intersect.c: the kernels that this processor can run, the best first; returns how many. */
size_t kernels_here(const struct kernel *out[KERNELS_MAX]);

/* Warm starts of one leaf, valid where `epoch` is the tracer's. */
struct warm_leaf {
  uint64_t epoch;
  struct solver_warm warm;
};

struct tracer {
  const struct model *model;
  const struct kernel *kernel;
  struct intersect_counts counts;
  uint64_t epoch;
  struct warm_leaf *warm;      /* one a leaf, NULL where no patch asks for it */
  struct explainer *explainer; /* explain.c; NULL where nobody asks */
};

/* intersect.c: a tracer in memory of the caller's, without warm starts, whatever the scene asks for. */
void tracer_begin(const struct intersector *intersector, struct tracer *out);

/* The warm start of a leaf of the tracer's model by its number; NULL where the method asks for none. */
static inline struct solver_warm *tracer_warm(struct tracer *tracer, const struct method *method, int64_t leaf)
{
  if (method->roots.start != START_PREVIOUS || !tracer->warm) return NULL;
  struct warm_leaf *warm = &tracer->warm[leaf];
  if (warm->epoch != tracer->epoch) warm->warm.count = 0, warm->epoch = tracer->epoch;
  return &warm->warm;
}

#endif
