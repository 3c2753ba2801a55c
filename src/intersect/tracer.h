/* What the files of src/intersect share: the tracer, and the kernels that do its work.
 *
 * Internal to src/intersect.
 */
#ifndef PSCN_INTERSECT_TRACER_H
#define PSCN_INTERSECT_TRACER_H

#include "algebra/solver.h"
#include "base/memory.h"
#include "intersect/exact/exact.h"
#include "intersect/intersect.h"
#include "intersect/local_ray.h"
#include "intersect/model.h"

/* The entry points of one instruction set: closest, occluded and all of lanes/walk.c, which tracer_closest and its like call
 * (intersect.c). */
struct kernel {
  const char *name;
  /* the rays, as bits, whose answers are not certain and might be others in other company */
  unsigned (*closest)(struct tracer *tracer, size_t count, const struct ray rays[], struct hit out_hits[]);
  /* whether some rays were let go */
  bool (*occluded)(struct tracer *tracer, size_t count, const struct ray rays[], bool out_occluded[]);
  /* whether there was memory for it */
  bool (*all)(struct tracer *tracer, size_t count, const struct ray rays[], struct hit_list out[]);
};

enum { KERNELS_MAX = 4 };

/* intersect.c: the kernels that this processor can run, the best first; returns how many. */
size_t kernels_here(const struct kernel *out[KERNELS_MAX]);

/* Warm starts of one leaf, valid where `epoch` is the tracer's. */
struct warm_leaf {
  uint64_t epoch;
  struct solver_warm warm;
};

/* As many packets are side by side (base/float_lanes.h). */
enum { PACKETS_MAX = 4 };

/* Leaves that the model does not keep, made lately. */
enum { MADE_BITS = 9 };
struct made_leaf {
  bool made;
  uint32_t number;
  struct leaf_room is;
};

/* All that is found on the rays of a packet, where all hits are asked for (lanes/gather.h). */
struct gather {
  struct growing roots;   /* struct gathered, as the lanes took them */
  struct growing open;    /* struct gathered_region: what they left open */
  struct growing order;   /* const struct gathered *: the roots, lane by lane, in their order */
  struct growing regions; /* struct exact_region, one lane's */
  struct exact_list list; /* what the last resort makes of one lane's */
  bool failed;            /* memory was short */
};

/* How often a ray may look at a box, of the hierarchy or along a leaf, before it is told as it is known then, grazing:
 * 15 to 60 ns each, by where they are in memory. Leaves count as more than one (packet.h). A tenth of a second at most. */
enum { MOST_LOOKS = 1 << 21 };

struct tracer {
  const struct model *model;
  const struct kernel *kernel;
  struct intersect_counts counts;
  uint64_t epoch;
  struct warm_leaf *warm;            /* one a leaf, NULL where no patch asks for it */
  struct made_leaf *made;            /* 2^MADE_BITS; NULL where leaves are kept, or each is made whenever asked for */
  struct gather gather[PACKETS_MAX]; /* of packets side by side */
  struct growing hits;               /* struct hit: of all lists of the last call of tracer_all */
  int most_looks;                    /* MOST_LOOKS; tests make it less */
  struct explainer *explainer;       /* explain.c; NULL where nobody asks */
};

/* intersect.c: a tracer in memory of the caller's, without warm starts, whatever the scene asks for. */
void tracer_begin(const struct intersector *intersector, struct tracer *out);

/* Whether of so many rays together those are asked once more, alone, whose answers are not certain or would take much: what
 * the last resort tells of a ray, and where its share of work ends, depends on the leaves that came to it, and those on how
 * soon the rays beside had the walk find something nearer. Warm starts go from ray to ray in any case, and where nothing is
 * proven all would be asked twice. */
static inline bool tracer_asks_again(const struct tracer *tracer, size_t count)
{
  return count > 1 && !tracer->warm && !tracer->model->unproven;
}

/* intersect.c: a leaf of the tracer's model that is not kept, perhaps in `room`; valid until the next call. */
struct leaf_room *tracer_leaf(struct tracer *tracer, uint32_t number, struct leaf_room *room);

/* intersect.c: gives back what tracer_all has taken for it, by memory_free, so on a thread with the same hooks. Not
 * asked for all hits, a tracer has nothing. */
void tracer_end(struct tracer *tracer);

/* The warm start of a leaf of the tracer's model by its number; NULL where the method asks for none. */
static inline struct solver_warm *tracer_warm(struct tracer *tracer, const struct method *method, int64_t leaf)
{
  if (method->roots.start != START_PREVIOUS || !tracer->warm) return NULL;
  struct warm_leaf *warm = &tracer->warm[leaf];
  if (warm->epoch != tracer->epoch) warm->warm.count = 0, warm->epoch = tracer->epoch;
  return &warm->warm;
}

#endif
