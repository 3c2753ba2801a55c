/* The intersector's interface: the prepared scene, the tracers, and the choice of an instruction set. */
#include "intersect/intersect.h"

#include <stdlib.h>
#include <string.h>

#include "base/kernel.h"
#include "base/memory.h"
#include "base/real.h"
#include "geometry/vector.h"
#include "intersect/explain.h"
#include "intersect/tracer.h"

struct intersector {
  struct model *model;
  const struct kernel *kernel;
  bool warm; /* some method has `start previous` */
};

/* As many rays as an AVX2 register holds. A choice of speed. */
enum { FEW_RAYS = 4 };

/* Each is at the end of one compilation of lanes/walk.c (lanes/names.h). */
extern const struct kernel kernel_baseline, kernel_avx2, kernel_avx512;

size_t kernels_here(const struct kernel *out[KERNELS_MAX])
{
  size_t count = 0;
#if defined(PSCN_HAS_AVX512)
  if (KERNEL_RUNS_AVX512) out[count++] = &kernel_avx512;
#endif
#if defined(PSCN_HAS_AVX2)
  if (KERNEL_RUNS_AVX2) out[count++] = &kernel_avx2;
#endif
  out[count++] = &kernel_baseline;
  return count;
}

/* The best kernel, or the one that the environment names; NULL if that is not here. */
static const struct kernel *kernel_chosen(void)
{
  const struct kernel *kernels[KERNELS_MAX];
  const size_t count = kernels_here(kernels);
  const char *forced = getenv("PSCN_KERNEL");
  for (size_t k = 0; k < count; k++)
    if (!forced || !*forced || strcmp(forced, kernels[k]->name) == 0) return kernels[k];
  return NULL;
}

/* The kernel that answers that many rays. Wide registers work on empty lanes, too; and sets that round alike answer
 * alike, except with warm starts. */
static const struct kernel *kernel_for(const struct tracer *tracer, size_t count)
{
#if defined(PSCN_HAS_AVX512) /* then AVX2 is there too: base/kernel.h */
  if (tracer->kernel == &kernel_avx512 && count <= FEW_RAYS) return &kernel_avx2;
#endif
  (void)count;
  return tracer->kernel;
}

bool intersector_kernel_here(void) { return kernel_chosen() != NULL; }

/* The baseline fuses products and sums if the user's flags are for a processor that can. */
#ifdef __FMA__
enum { BASELINE_FUSES = 1 };
#else
enum { BASELINE_FUSES = 0 };
#endif

/* ARITHMETIC_BUILT: the processor and the compiler, which also choose what the baseline fuses (CMakeLists.txt). */
const char *intersector_arithmetic(void)
{
  const bool fused = BASELINE_FUSES || kernel_chosen() != &kernel_baseline;
  return fused ? "fused, " ARITHMETIC_BUILT : "baseline, " ARITHMETIC_BUILT;
}

enum status intersector_create(const struct scene *scene, struct intersector **out)
{
  return intersector_create_by(scene, NULL, out);
}

enum status intersector_create_by(const struct scene *scene, const struct team *team, struct intersector **out)
{
  *out = NULL;
  const struct kernel *kernel = kernel_chosen();
  if (!kernel) return STATUS_USAGE;
  struct intersector *intersector = memory_alloc(1, sizeof *intersector);
  if (!intersector) return STATUS_LIMIT;
  const enum status status = model_create(scene, team, &intersector->model);
  if (status != STATUS_OK) {
    memory_free(intersector);
    return status;
  }
  intersector->kernel = kernel;
  intersector->warm = scene_starts_warm(scene);
  *out = intersector;
  return STATUS_OK;
}

void intersector_destroy(struct intersector *intersector)
{
  if (!intersector) return;
  model_destroy(intersector->model);
  memory_free(intersector);
}

bool intersector_cut_less(const struct intersector *intersector) { return model_cut_less(intersector->model); }

void tracer_begin(const struct intersector *intersector, struct tracer *out)
{
  *out = (struct tracer){.model = intersector->model, .kernel = intersector->kernel, .epoch = 1, .budget = RAY_BUDGET};
}

enum status tracer_create(const struct intersector *intersector, struct tracer **out)
{
  *out = NULL;
  struct tracer *tracer = memory_alloc(1, sizeof *tracer);
  if (!tracer) return STATUS_LIMIT;
  tracer_begin(intersector, tracer);
  const struct model *model = tracer->model;
  const bool warm = intersector->warm && model->leaf_count > 0, made = !model->leaves;
  if (warm) tracer->warm = memory_alloc(model->leaf_count, sizeof *tracer->warm);
  if (made) tracer->made = memory_alloc((size_t)1 << MADE_BITS, sizeof *tracer->made);
  if ((warm && !tracer->warm) || (made && !tracer->made)) {
    tracer_destroy(tracer);
    return STATUS_LIMIT;
  }
  *out = tracer;
  return STATUS_OK;
}

void tracer_end(struct tracer *tracer)
{
  for (int h = 0; h < PACKETS_MAX; h++) {
    struct gather *gather = &tracer->gather[h];
    memory_free(gather->hits.at);
    for (int l = 0; l < LANES_MAX; l++) memory_free(gather->lane[l].found.at), memory_free(gather->lane[l].regions.at);
  }
  memory_free(tracer->hits.at);
}

void tracer_destroy(struct tracer *tracer)
{
  if (!tracer) return;
  tracer_end(tracer);
  memory_free(tracer->warm);
  memory_free(tracer->made);
  memory_free(tracer);
}

struct leaf_room *tracer_leaf(struct tracer *tracer, uint32_t number, struct leaf_room *room)
{
  if (tracer->made) {
    struct made_leaf *slot = &tracer->made[number * UINT32_C(0x9e3779b1) >> (32 - MADE_BITS)]; /* Knuth 6.4 */
    room = &slot->is;
    if (slot->made && slot->number == number) return room;
    slot->made = true, slot->number = number;
  }
  model_make_leaf(tracer->model, number, room);
  return room;
}

void tracer_forget(struct tracer *tracer) { tracer->epoch++; }

void tracer_stop_at(struct tracer *tracer, const atomic_int *stop) { tracer->stop = stop; }

/* The work on rays that are traced again alone is not counted, only their new answers. */
static void trace(struct tracer *tracer, enum wanted wanted, size_t count, const struct ray rays[], void *answers)
{
  unsigned again = kernel_for(tracer, count)->trace(tracer, wanted, count, rays, answers);
  if (!again) return;
  const struct intersect_counts before = tracer->counts;
  const struct kernel *kernel = kernel_for(tracer, 1);
  for (; again && !tracer_stopped(tracer); again &= again - 1) {
    const int k = __builtin_ctz(again);
    (void)kernel->trace(tracer, wanted, 1, &rays[k], wanted_at(wanted, answers, (size_t)k));
  }
  const uint64_t certain_now = tracer->counts.certain - before.certain;
  tracer->counts = before;
  tracer->counts.certain += certain_now, tracer->counts.grazing -= certain_now;
}

void tracer_closest(struct tracer *tracer, size_t count, const struct ray rays[], struct hit out_hits[])
{
  trace(tracer, WANTED_CLOSEST, count, rays, out_hits);
}

void tracer_occluded(struct tracer *tracer, size_t count, const struct ray rays[], bool out_occluded[])
{
  trace(tracer, WANTED_ANY, count, rays, out_occluded);
}

void tracer_explain(struct tracer *tracer, const struct ray *ray, explain_listener *listener, void *context,
                    struct hit *out_hit)
{
  struct explainer explainer = {.listener = listener, .context = context};
  tracer->explainer = &explainer;
  tracer_closest(tracer, 1, ray, out_hit);
  tracer->explainer = NULL;
}

enum status tracer_all(struct tracer *tracer, size_t count, const struct ray rays[], struct hit_list out[])
{
  struct list_place lists[PACKET_SIZE];
  tracer->hits.count = 0, tracer->failed = false;
  trace(tracer, WANTED_ALL, count, rays, lists);
  if (tracer->failed) return STATUS_LIMIT;
  for (size_t k = 0; k < count; k++)
    out[k] = (struct hit_list){lists[k].certainty, lists[k].count,
                               (const struct hit *)tracer->hits.at + lists[k].first};
  return STATUS_OK;
}

/* ---- rays that leave a hit ---- */

/* Starts are tried up to LEAVE_LONGER^LEAVE_TRIES times as far back. A choice: 2^20 times a clearance of some 2^-43. */
enum { LEAVE_TRIES = 5, LEAVE_LONGER = 16 };

/* Whether nothing is between the ray's start and the point. */
static bool start_sees(struct tracer *tracer, const struct ray *ray, const double point[3])
{
  struct ray back = {.t_max = 1};
  bool occluded = false;
  const uint64_t before = tracer->counts.rays[1];
  for (int k = 0; k < 3; k++) {
    back.origin[k] = point[k];
    back.direction[k] = fma(ray->t_min, ray->direction[k], ray->origin[k]) - point[k];
  }
  if (vector_length(back.direction) > 0) tracer_occluded(tracer, 1, &back, &occluded);
  tracer->counts.rays[1] = before;
  return !occluded;
}

/* Where another surface is before a start, one farther back is taken. */
static unsigned leave(struct tracer *tracer, size_t count, const struct ray rays[], const struct hit hits[],
                      struct leaving to, struct ray out[])
{
  const struct left left = tracer->kernel->leave(count, rays, hits, &to, out);
  for (unsigned bits = left.beside; bits; bits &= bits - 1) {
    const int k = __builtin_ctz(bits);
    to.longer = 1;
    for (int n = 0; n < LEAVE_TRIES && !start_sees(tracer, &rays[k], out[k].origin); n++) {
      to.longer *= LEAVE_LONGER;
      (void)tracer->kernel->leave(1, &rays[k], &hits[k], &to, &out[k]);
    }
  }
  return left.facing;
}

void tracer_leave(struct tracer *tracer, const struct ray *ray, const struct hit *hit, const double direction[3],
                  double out_origin[3])
{
  struct ray out;
  (void)leave(tracer, 1, ray, hit, (struct leaving){.to = direction, .longer = 1}, &out);
  memcpy(out_origin, out.origin, sizeof out.origin);
}

unsigned tracer_leave_for(struct tracer *tracer, size_t count, const struct ray rays[], const struct hit hits[],
                          const double point[3], double end, struct ray out[])
{
  return leave(tracer, count, rays, hits, (struct leaving){point, true, 1, end}, out);
}

const struct intersect_counts *tracer_counts(const struct tracer *tracer) { return &tracer->counts; }
