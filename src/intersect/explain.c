/* Tells what becomes of a ray. See explain.h. */
#include "intersect/explain.h"

#include <limits.h>
#include <math.h>
#include <string.h>

#include "geometry/patch.h"
#include "intersect/local_ray.h"
#include "intersect/method.h"

/* The listener, and the candidate under way. */
struct explainer {
  explain_listener *tell;
  void *context;
  struct intersect_counts before; /* at the start of the candidate */
  double t_before;
  bool warmed; /* `warm` holds the warm start of the candidate's solver */
  struct solver_warm warm;
  struct explained_candidate story;
};

struct explained_roots *explain_roots(struct tracer *tracer)
{
  if (tracer->explainer == NULL) return NULL;
  tracer->explainer->story.by_solver = true;
  return &tracer->explainer->story.found;
}

void explain_before(struct tracer *tracer, const struct model *model, const struct model_patch *patch, int64_t leaf,
                    double t)
{
  struct explainer *explainer = tracer->explainer;
  explainer->before = tracer->counts;
  explainer->t_before = t;
  explainer->warmed = explainer->story.by_solver = false;
  if (model != tracer->model) return;
  const struct solver_warm *warm = tracer_warm(tracer, patch->method, leaf);
  explainer->warmed = warm != NULL;
  if (warm != NULL) explainer->warm = *warm;
}

/* The positions along the ray of the points that are offered. */
static void place_points(const struct local_ray *local, const double w[16], const struct explained_ray *ray,
                         struct explained_candidate *story)
{
  double depths[4][4];
  memcpy(depths, w, sizeof depths);
  for (int k = 0; k < story->found.roots.count; k++) {
    if (story->found.fate[k] != ROOT_OFFERED) continue;
    const double kept = story->found.roots.root[k].re, other = story->found.other[k];
    const double u = story->v_kept ? other : kept, v = story->v_kept ? kept : other;
    story->t[k] = ray->shift + t_of_depth(&local->depth, patch_evaluate(depths, u, v).value);
  }
}

/* The leaf, its a and b, and what the solver makes of them if it has not been told already. */
static void tell_algebra(struct explainer *explainer, const struct explained_ray *ray)
{
  struct explained_candidate *story = &explainer->story;
  const struct leaf *leaf = ray->leaf;
  const struct model_patch *patch = ray->patch;
  story->patch = ray->first_patch + leaf->patch;
  for (int k = 0; k < 2; k++) story->split[k] = patch->cut.split[k];
  story->column_u = leaf->column_u, story->column_v = leaf->column_v;
  struct leaf_form form;
  leaf_form_make(patch, leaf, &form);
  story->v_kept = form.v_kept;
  story->kept_degree = form.kept_degree, story->other_degree = form.eliminated_degree;
  struct local_ray local;
  struct method_planes planes = {.form = &form};
  double w[16], unused[16];
  local_ray_make(patch, &ray->ray, &local);
  local_ray_nets(&local, leaf->x, planes.a, planes.b, w);
  if (!form.own) local_ray_nets(&local, form.x, planes.a, planes.b, unused);
  memcpy(story->a, planes.a, sizeof story->a), memcpy(story->b, planes.b, sizeof story->b);
  if (!story->solved) return;
  struct method_roots points;
  if (!story->by_solver)
    method_find(patch->method, &planes, INT_MAX, explainer->warmed ? &explainer->warm : NULL, &points, &story->found);
  place_points(&local, w, ray, story);
}

void explain_after(struct tracer *tracer, const struct explained_ray *ray)
{
  struct explainer *explainer = tracer->explainer;
  const struct intersect_counts *before = &explainer->before, *after = &tracer->counts;
  struct explained_candidate *story = &explainer->story;
  story->blind = ray->blind;
  /* Not tried: closed by its slab or pole, or left open at once. */
  if (!story->blind && after->patches_tested == before->patches_tested) return;
  for (int k = 0; k < STAGE_COUNT; k++)
    if (after->stages[k] > before->stages[k]) story->reached = (enum stage)k;
  story->solved = !story->blind && (story->reached == STAGE_BILINEAR || story->reached == STAGE_ROOTS);
  tell_algebra(explainer, ray);
  story->left_open = story->blind || after->escalated > before->escalated;
  story->taken = ray->t != explainer->t_before;
  story->proven = ray->proven;
  story->hit_t = ray->shift + ray->t, story->hit_u = ray->u, story->hit_v = ray->v;
  story->radius_u = ray->radius_u, story->radius_v = ray->radius_v;
  explainer->tell(explainer->context, story);
}

void tracer_explain(struct tracer *tracer, const struct ray *ray, explain_listener *tell, void *context,
                    struct hit *out_hit)
{
  struct explainer explainer = {.tell = tell, .context = context};
  tracer->explainer = &explainer;
  tracer_closest(tracer, 1, ray, out_hit);
  tracer->explainer = NULL;
}

/* ---- numbers ---- */

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
  struct explained_numbers *numbers;
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

void tracer_measure(struct tracer *tracer, const struct ray *ray, struct hit *out_hit,
                    struct explained_numbers *out_numbers)
{
  struct measured all;
  all.count = 0, all.numbers = out_numbers;
  *out_numbers = (struct explained_numbers){0, 0, 0};
  tracer_explain(tracer, ray, measure_candidate, &all, out_hit);
  if (out_hit->patch == HIT_NONE) return;
  double nearest = INFINITY;
  out_numbers->residual = INFINITY;
  for (int k = 0; k < all.count; k++) {
    const double distance = distance_to(&all.root[k], out_hit);
    if (distance < nearest) nearest = distance, out_numbers->residual = all.root[k].residual;
  }
}
