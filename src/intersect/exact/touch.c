/* Boxes that the ray touches, or nearly: the fold (fold.h) gives both roots, or proves that there is none, in double
 * precision, or if that is not enough in wide arithmetic. A possible double root is told as one place.
 */
#include "intersect/exact/fold.h"
#include "intersect/exact/window.h"

#include <math.h>

#include "base/real.h"
#include "geometry/patch.h"

/* Possible roots no farther from a fold than this part of the box are told as one place. */
#define FOLD_NEAR 0x1p-36

/* Finds the root on one side of the fold. Returns false if it is not proven. error: of the box's nets; NULL if the root
 * is to be found in wide arithmetic. */
static bool fold_root(const struct window *window, struct box *box, const struct fold *fold, const double *error,
                      double side, struct exact_root *out)
{
  double root[2], radius[2];
  for (int k = 0; k < 2; k++) root[k] = 0.5 + 0.5 * (fold->at[k] + side * fold->way[k]);
  if (error) {
    if (!box_solve(box, error, false, root, radius)) return false;
    *out = window_root(window, box, root, radius);
    return true;
  }
  *out = (struct exact_root){.u = window_place(window, box, 0, root[0]),
                             .v = window_place(window, box, 1, root[1]),
                             .radius_u = INFINITY,
                             .radius_v = INFINITY};
  judge_spend(window->judge, WORK_SHARPEN);
  if (!zoom_sharpen(judge_zoom(window->judge), out)) return false;
  for (int k = 0; k < 2; k++) {
    const wide at = k ? out->v : out->u;
    if (!(at >= window_place(window, box, k, -BOX_MARGIN) && at <= window_place(window, box, k, 1 + BOX_MARGIN)))
      return false;
  }
  return true;
}

/* Tells of the two roots on either side of a fold. If they are not both proven, tells nothing and returns false. */
static bool fold_roots(const struct window *window, struct box *box, const struct fold *fold, const double *error)
{
  struct exact_root root[2];
  for (int n = 0; n < 2; n++)
    if (!fold_root(window, box, fold, error, n ? fold->half : -fold->half, &root[n])) return false;
  if (exact_roots_meet(&root[0], &root[1])) return false;
  for (int n = 0; n < 2; n++) judge_root(window->judge, &root[n]);
  return true;
}

/* A double root, two or none: tells of the fold itself as a maybe, if it is in the box. */
static bool fold_maybe(const struct window *window, struct box *box, const struct fold *fold)
{
  double at[2];
  const double way = real_max(fabs(fold->way[0]), fabs(fold->way[1]));
  const double reach = 2 * (fold->half * way + fold->uncertain); /* the arc bends */
  if (!(reach <= FOLD_NEAR)) return false;
  for (int k = 0; k < 2; k++) {
    if (fabs(fold->at[k]) > 1 + reach) return true;
    at[k] = 0.5 + 0.5 * real_clamp(fold->at[k], -1, 1);
  }
  const struct patch_jet w = patch_evaluate(box->net[2], at[0], at[1]);
  const double t = t_of_depth(&window->depth, w.value), off = (fabs(w.du) + fabs(w.dv)) * reach;
  const double t_error = window_length(window, off + window->depth_error) +
                         8 * UNIT_ROUNDOFF * (fabs(t) + window_length(window, fabs(w.value)));
  judge_maybe(window->judge, (double)window_place(window, box, 0, at[0]), (double)window_place(window, box, 1, at[1]),
              t, t_error, t - t_error);
  return true;
}

/* Decides the box if it has a fold. */
static bool box_fold(const struct window *window, struct box *box, const struct fold_pair *pair, const double error[2])
{
  struct fold fold;
  judge_spend(window->judge, WORK_FOLD);
  if (!fold_find(pair, error, &fold)) return false;
  enum fold_verdict verdict = fold_weigh_box(&fold, box, error);
  if (verdict == FOLD_EMPTY || (verdict == FOLD_ROOTS && fold_roots(window, box, &fold, error))) return true;
  struct zoom *zoom = judge_zoom(window->judge);
  if (zoom->axis != window->judge->local.axis) return false; /* it is of other planes */
  double values[2][3];
  const double size[2] = {box->size_u * (double)window->size[0], box->size_v * (double)window->size[1]};
  const wide u = window_place(window, box, 0, 0.5 + 0.5 * fold.at[0]);
  const wide v = window_place(window, box, 1, 0.5 + 0.5 * fold.at[1]);
  const double off = zoom_combinations(zoom, u, v, size, fold.row, values);
  verdict = fold_weigh(&fold, values[0], values[1], off);
  if (verdict == FOLD_EMPTY || (verdict == FOLD_ROOTS && fold_roots(window, box, &fold, NULL))) return true;
  return fold_maybe(window, box, &fold);
}

bool window_touched(const struct window *window, struct box *box, const double error[2], bool folds, bool *flat)
{
  struct fold_pair pair;
  fold_combine(box, &pair);
  const enum fold_bent bent = fold_bent_test(&pair, box, error);
  *flat = bent == BENT_FLAT;
  return bent == BENT_APART || (folds && box_fold(window, box, &pair, error));
}
