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

/* What is asked of rays. Of each, the answer is a struct hit, a bool, or a struct list_place. */
enum wanted { WANTED_CLOSEST, WANTED_ANY, WANTED_ALL };

/* All hits of a ray: hits[first] to hits[first + count - 1] of the tracer's. */
struct list_place {
  enum certainty certainty;
  size_t first, count;
};

/* The place of answer k. */
static inline void *wanted_at(enum wanted wanted, void *answers, size_t k)
{
  static const size_t sizes[] = {sizeof(struct hit), sizeof(bool), sizeof(struct list_place)};
  return (char *)answers + k * sizes[wanted];
}

/* Where rays that leave hits go: to a point or along a direction, for t up to `end`. They start `longer` times as far
 * back as the hit's clearance asks. */
struct leaving {
  const double *to;
  bool is_point;
  double longer, end;
};

/* As bits, the hits on whose normals' side they go, and those before which another surface may lie: beside a border. */
struct left {
  unsigned facing, beside;
};

/* The entry points of one instruction set: lanes/walk.c and lanes/leave.c. */
struct kernel {
  const char *name;
  /* returns, as bits, the rays that are to be traced again alone */
  unsigned (*trace)(struct tracer *tracer, enum wanted wanted, size_t count, const struct ray rays[], void *answers);
  /* makes rays that leave hits: tracer_leave says where they start, and why there */
  struct left (*leave)(size_t count, const struct ray rays[], const struct hit hits[], const struct leaving *to,
                       struct ray out[]);
};

enum { KERNELS_MAX = 3 };

/* intersect.c: the kernels that this processor can run, best first; returns how many. */
size_t kernels_here(const struct kernel *out[KERNELS_MAX]);

/* The warm start of one leaf, valid if `epoch` is the tracer's. */
struct warm_leaf {
  uint64_t epoch;
  struct solver_warm warm;
};

/* At most this many packets are side by side (base/float_lanes.h). */
enum { PACKETS_MAX = 2 };

/* Leaves that the model does not keep, made recently. */
enum { MADE_BITS = 9 };
struct made_leaf {
  bool made;
  uint32_t number;
  struct leaf_room is;
};

/* All that is found on the rays of a packet, if all hits are wanted (lanes/gather.c). */
enum { LANES_MAX = 8 };
struct gather {
  struct growing hits; /* struct hit: the answers of the roots that the lanes took */
  struct gathered {
    struct exact_list found; /* those of one lane, `taken` their places in `hits`; then what exact_all makes of them */
    struct growing regions;  /* struct exact_region: what it left open */
  } lane[LANES_MAX];
};

/* The budget of a ray, in units of one box of the hierarchy tested, some 25 ns. All work is charged to it, by the
 * costs below. A ray that has exhausted it goes no further: its answer is what is known by then, and grazing. The last
 * resort gets what the lanes leave of it, at least a sixteenth (packet_case). A choice: some 7 ms. */
enum { RAY_BUDGET = 1 << 18 };

/* In a packet, the leaves that reach a ray, and their order, depend on its neighbours; so would the point where its
 * budget ends. It gets an eighth there, and is traced again alone if that is not enough (intersect.c). */
enum { BUDGET_IN_COMPANY = 3 };

/* Making a leaf that is not kept; being tried on a leaf, once the slab test in doubles passes; the planes' polynomials;
 * a piece of a leaf; the resultant and one of its roots; a piece that the last resort examines. Sweeps over all roots
 * of r cost a unit for so many products of roots. */
enum { COST_MADE = 32, COST_TRIED = 16, COST_PLANES = 24, COST_BOX = 4, COST_RESULTANT = 64, COST_EXACT = 32 };
enum { PRODUCTS_A_UNIT = 8 };

struct tracer {
  const struct model *model;
  const struct kernel *kernel;
  struct intersect_counts counts;
  uint64_t epoch;
  struct warm_leaf *warm;            /* one for each leaf; NULL if no method uses them */
  struct made_leaf *made;            /* 2^MADE_BITS; NULL if leaves are kept, or made anew for each request */
  struct gather gather[PACKETS_MAX]; /* of packets side by side */
  struct growing hits;               /* struct hit: all lists of the last call of tracer_all */
  bool failed;                       /* memory was short for that call */
  int budget;                        /* RAY_BUDGET; less in tests */
  struct explainer *explainer;       /* explain.h; NULL for none */
  const atomic_int *stop;            /* tracer_stop_at; or NULL */
};

static inline bool tracer_stopped(const struct tracer *tracer)
{
  return tracer->stop && atomic_load_explicit(tracer->stop, memory_order_relaxed) != 0;
}

/* intersect.c: a tracer in the caller's memory, without warm starts, whatever the scene says. */
void tracer_begin(const struct intersector *intersector, struct tracer *out);

/* Whether, of `count` rays together, those are traced again alone whose answers are not certain or would take much
 * work. What the last resort finds out about a ray, and where its budget ends, depends on the leaves that came to it;
 * these depend on how soon the rays beside it made the walk find something nearer. Not with warm starts, which go from
 * ray to ray in any case, nor if nothing is proven, when all would be traced twice. */
static inline bool tracer_repeats(const struct tracer *tracer, size_t count)
{
  return count > 1 && !tracer->warm && !tracer->model->unproven;
}

/* intersect.c: a leaf of the tracer's model that is not kept, perhaps in `room`; valid until the next call. */
struct leaf_room *tracer_leaf(struct tracer *tracer, uint32_t number, struct leaf_room *room);

/* intersect.c: frees what tracer_all has allocated, by memory_free, so on a thread with the same hooks. A tracer that
 * has never found all hits has nothing to free. */
void tracer_end(struct tracer *tracer);

/* The warm start of the leaf with this number in the model; NULL if the method uses none, or if it is an object's. */
static inline struct solver_warm *tracer_warm(struct tracer *tracer, const struct model *model,
                                              const struct method *method, int64_t leaf)
{
  if (method->roots.start != START_PREVIOUS || !tracer->warm || model != tracer->model) return NULL;
  struct warm_leaf *warm = &tracer->warm[leaf];
  if (warm->epoch != tracer->epoch) warm->warm.count = 0, warm->epoch = tracer->epoch;
  return &warm->warm;
}

#endif
