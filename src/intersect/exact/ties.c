/* Roots beside each other: whether they can be told apart along the ray, and which of them comes first. See judge.h. */
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

/* Two roots whose t is known to so many errors of wide arithmetic are not ill-conditioned: the ray meets the surface at
 * a slant no worse than about that. A choice of words: what is worse is called grazing, and what is no farther apart is at one
 * place. */
#define TIE_ERRORS 256

bool judge_tie(const struct exact_root *a, const struct exact_root *b)
{
  return wide_abs(a->t - b->t) <= a->t_error + b->t_error;
}

/* Where the ray starts next to the surface that would be more than a rounding of t, and so another hit. */
bool judge_tie_fine(struct judge *j, const struct exact_root *a, const struct exact_root *b)
{
  judge_turn(j, a->patch);
  const double t = fabs((double)a->t);
  const double well = zoom_error(judge_zoom(j)) * fabs((double)j->zoom.to_t) + (double)WIDE_ROUNDOFF * t;
  return a->t_error + b->t_error <= real_min(TIE_ERRORS * well, UNIT_ROUNDOFF * t);
}

bool judge_stands_before(const struct exact_root *a, const struct exact_root *b)
{
  if (a->patch != b->patch) return a->patch < b->patch;
  const bool beside = fabs((double)(a->u - b->u)) > a->radius_u + b->radius_u;
  return beside ? a->u < b->u : a->v < b->v;
}
