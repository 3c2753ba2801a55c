/* Reports what becomes of a ray. See explain.h. */
#include "intersect/explain.h"

#include <limits.h>
#include <math.h>
#include <string.h>

#include "geometry/patch.h"
#include "intersect/method.h"

/* The listener, and the candidate under way. */
struct explainer {
  explain_listener *listener;
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
static void place_points(const struct explained_ray *ray, struct explained_candidate *story)
{
  double depths[4][4];
  memcpy(depths, ray->leaf->x[ray->axis], sizeof depths);
  for (int k = 0; k < story->found.roots.count; k++) {
    if (story->found.fate[k] != ROOT_OFFERED) continue;
    const double kept = story->found.roots.root[k].re, other = story->found.other[k];
    const double u = story->v_kept ? other : kept, v = story->v_kept ? kept : other;
    const double depth = patch_evaluate(depths, u, v).value;
    story->t[k] = ray->shift + ((depth + ray->start[1]) + ray->start[0]) * ray->to_t;
  }
}

/* The plane polynomials' nets for a net x. */
static void plane_nets(const struct explained_ray *ray, const double x[3][16], double a[16], double b[16])
{
  const double *xk = x[ray->axis], *xi = x[(ray->axis + 1) % 3], *xj = x[(ray->axis + 2) % 3];
  for (int c = 0; c < 16; c++) {
    a[c] = (xi[c] - ray->moment[0]) - ray->slope[0] * xk[c];
    b[c] = (xj[c] - ray->moment[1]) - ray->slope[1] * xk[c];
  }
}

/* The leaf, its a and b, and what the solver makes of them if it has not run already. */
static void report_algebra(struct explainer *explainer, const struct explained_ray *ray)
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
  struct method_planes planes = {.form = &form};
  plane_nets(ray, form.own ? leaf->x : form.x, planes.a, planes.b);
  memcpy(story->a, planes.a, sizeof story->a), memcpy(story->b, planes.b, sizeof story->b);
  if (!story->solved) return;
  struct method_roots points;
  if (!story->by_solver)
    method_find(patch->method, &planes, INT_MAX, explainer->warmed ? &explainer->warm : NULL, &points, &story->found);
  place_points(ray, story);
}

void explain_after(struct tracer *tracer, const struct explained_ray *ray)
{
  struct explainer *explainer = tracer->explainer;
  const struct intersect_counts *before = &explainer->before, *after = &tracer->counts;
  struct explained_candidate *story = &explainer->story;
  story->blind = ray->blind;
  /* Not tried: closed by its slab, or left open at once. */
  if (!story->blind && after->patches_tested == before->patches_tested) return;
  for (int k = 0; k < STAGE_COUNT; k++)
    if (after->stages[k] > before->stages[k]) story->reached = (enum stage)k;
  story->solved = !story->blind && (story->reached == STAGE_BILINEAR || story->reached == STAGE_ROOTS);
  report_algebra(explainer, ray);
  story->left_open = story->blind || after->escalated > before->escalated;
  story->taken = ray->t != explainer->t_before;
  story->proven = ray->proven;
  story->hit_t = ray->shift + ray->t, story->hit_u = ray->u, story->hit_v = ray->v;
  story->radius_u = ray->radius_u, story->radius_v = ray->radius_v;
  explainer->listener(explainer->context, story);
}

void tracer_explain(struct tracer *tracer, const struct ray *ray, explain_listener *listener, void *context,
                    struct hit *out_hit)
{
  struct explainer explainer = {.listener = listener, .context = context};
  tracer->explainer = &explainer;
  tracer_closest(tracer, 1, ray, out_hit);
  tracer->explainer = NULL;
}
