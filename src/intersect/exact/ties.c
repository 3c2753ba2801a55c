/* Neighbouring roots: whether they can be told apart along the ray, and which comes first. See judge.h. */
#include <math.h>

#include "base/real.h"
#include "intersect/exact/judge.h"

bool judge_sharpen(struct judge *j, struct exact_root *root)
{
  if (root->sharp) return true;
  judge_turn(j, root->patch);
  judge_spend(j, WORK_SHARPEN);
  return zoom_sharpen(judge_zoom(j), root);
}

void judge_improve(struct judge *j, struct exact_root *root)
{
  struct exact_root sharp = *root;
  if (judge_sharpen(j, &sharp)) *root = sharp;
}

bool judge_tie(const struct exact_root *a, const struct exact_root *b)
{
  return wide_abs(a->t - b->t) <= a->t_error + b->t_error;
}

/* If the ray starts next to the surface, the errors of both may exceed a rounding of t: then they are different
 * hits. */
bool judge_tie_fine(const struct exact_root *a, const struct exact_root *b)
{
  return a->well_known && b->well_known && a->t_error + b->t_error <= UNIT_ROUNDOFF * fabs((double)a->t);
}

bool judge_stands_before(const struct exact_root *a, const struct exact_root *b)
{
  if (a->patch != b->patch) return a->patch < b->patch;
  const bool beside = fabs((double)(a->u - b->u)) > a->radius_u + b->radius_u;
  return beside ? a->u < b->u : a->v < b->v;
}
