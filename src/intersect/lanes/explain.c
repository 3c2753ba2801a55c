/* Reports what becomes of a ray, the only one of its packet: it is in lane 0, and the other lanes are the same. See
 * explain.h.
 *
 * Compiled once per instruction set and without contraction.
 */
#include "intersect/explain.h"

#include <limits.h>
#include <math.h>

#include "intersect/lanes/candidate.h"
#include "intersect/method.h"

void explain_before(const struct packet *p, const struct candidate *it)
{
  struct explainer *explainer = p->tracer->explainer;
  const struct solver_warm *warm = tracer_warm(p->tracer, p->model, it->patch->method, it->number);
  explainer->before = p->tracer->counts;
  explainer->t_before = p->best.t[0];
  explainer->story.by_solver = false;
  explainer->warmed = warm != NULL;
  if (warm != NULL) explainer->warm = *warm;
}

/* The positions along the ray of the points that are offered. */
static void place_points(const struct candidate *it, double shift, struct explained_candidate *story)
{
  const struct line *line = it->line;
  for (int k = 0; k < story->found.roots.count; k++) {
    if (story->found.fate[k] != ROOT_OFFERED) continue;
    const double kept = story->found.roots.root[k].re, other = story->found.other[k];
    const double u = story->v_kept ? other : kept, v = story->v_kept ? kept : other;
    story->t[k] = shift + ((leaf_depth(it, u, v) + line->start[1][0]) + line->start[0][0]) * line->to_t[0];
  }
}

/* The leaf, its a and b, and what the solver makes of them if it has not run already. */
static void report_algebra(struct explainer *explainer, const struct candidate *it, double shift)
{
  struct explained_candidate *story = &explainer->story;
  const struct leaf *leaf = it->leaf;
  for (int k = 0; k < 2; k++) story->split[k] = it->patch->cut.split[k];
  story->column_u = leaf->column_u, story->column_v = leaf->column_v;
  struct leaf_form form;
  leaf_form_make(it->patch, leaf, &form);
  story->v_kept = form.v_kept;
  story->kept_degree = form.kept_degree, story->other_degree = form.eliminated_degree;
  struct method_planes planes = {.form = &form};
  for (int n = 0; n < 16; n++) {
    lanes a, b;
    plane_values(it->line, it->axis, form.own ? leaf->x : form.x, n, &a, &b);
    story->a[n] = planes.a[n] = a[0], story->b[n] = planes.b[n] = b[0];
  }
  if (!story->solved) return;
  struct method_roots points;
  if (!story->by_solver)
    method_find(it->patch->method, &planes, INT_MAX, explainer->warmed ? &explainer->warm : NULL, &points,
                &story->found);
  place_points(it, shift, story);
}

void explain_after(const struct packet *p, const struct candidate *it, bool blind)
{
  struct explainer *explainer = p->tracer->explainer;
  const struct intersect_counts *before = &explainer->before, *after = &p->tracer->counts;
  const struct best *best = &p->best;
  struct explained_candidate *story = &explainer->story;
  const double shift = p->outer ? p->shift[0] : 0;
  story->blind = blind;
  /* Not tried: closed by its slab, or left open at once. */
  if (!blind && after->patches_tested == before->patches_tested) return;
  for (int k = 0; k < STAGE_COUNT; k++)
    if (after->stages[k] > before->stages[k]) story->reached = (enum stage)k;
  story->solved = !blind && (story->reached == STAGE_BILINEAR || story->reached == STAGE_ROOTS);
  story->patch = packet_patch(p, it->leaf);
  report_algebra(explainer, it, shift);
  story->left_open = blind || after->escalated > before->escalated;
  story->taken = best->t[0] != explainer->t_before;
  story->proven = best->certain[0] != 0;
  story->hit_t = shift + best->t[0], story->hit_u = best->u[0], story->hit_v = best->v[0];
  story->radius_u = best->radius_u[0], story->radius_v = best->radius_v[0];
  explainer->listener(explainer->context, story);
}
