/* What the solver did for a ray. See measure.h. */
#include "render/measure.h"

#include <math.h>

#include "intersect/explain.h"

/* A root that may be the hit. */
struct measured_root {
  uint32_t patch;
  int split[2], column_u, column_v;
  bool v_kept;
  double re, im, residual;
};

enum { MEASURED_ROOTS = 256 }; /* of one ray; those beyond are ignored */

/* Roots farther than this outside the kept parameter's range are not the hit. */
#define MEASURED_MARGIN 0.125

struct measured {
  struct solver_numbers *numbers;
  int count;
  struct measured_root root[MEASURED_ROOTS];
};

static void measure_candidate(void *context, const struct explained_candidate *candidate)
{
  struct measured *all = context;
  const struct explained_roots *found = &candidate->found;
  const struct polynomial r = {found->degree, found->basis, found->c, NULL};
  for (int k = 0; candidate->solved && k < found->roots.count; k++) {
    const struct root *root = &found->roots.root[k];
    all->numbers->iterations += root->iterations;
    all->numbers->roots += 1;
    const bool near = fabs(root->re - 0.5) <= 0.5 + MEASURED_MARGIN && fabs(root->im) <= MEASURED_MARGIN;
    if (!near || all->count == MEASURED_ROOTS) continue;
    all->root[all->count++] = (struct measured_root){candidate->patch,
                                                     {candidate->split[0], candidate->split[1]},
                                                     candidate->column_u,
                                                     candidate->column_v,
                                                     candidate->v_kept,
                                                     root->re,
                                                     root->im,
                                                     polynomial_eq11(&r, root->re, root->im)};
  }
}

/* How far the root is from the hit's kept parameter, if its leaf holds the hit; else infinite. */
static double distance_to(const struct measured_root *root, const struct hit *hit)
{
  const double u = hit->u * root->split[0] - root->column_u, v = hit->v * root->split[1] - root->column_v;
  const bool holds = fabs(u - 0.5) <= 0.5 + MEASURED_MARGIN && fabs(v - 0.5) <= 0.5 + MEASURED_MARGIN;
  return root->patch == hit->patch && holds ? hypot(root->re - (root->v_kept ? v : u), root->im) : INFINITY;
}

void measure_ray(struct tracer *tracer, const struct ray *ray, struct hit *out_hit, struct solver_numbers *out_numbers)
{
  struct measured all;
  all.count = 0, all.numbers = out_numbers;
  *out_numbers = (struct solver_numbers){0, 0, 0};
  tracer_explain(tracer, ray, measure_candidate, &all, out_hit);
  if (out_hit->patch == HIT_NONE) return;
  double nearest = INFINITY;
  out_numbers->residual = INFINITY;
  for (int k = 0; k < all.count; k++) {
    const double distance = distance_to(&all.root[k], out_hit);
    if (distance < nearest) nearest = distance, out_numbers->residual = all.root[k].residual;
  }
}
