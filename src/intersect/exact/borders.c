/* Roots on borders of patches: even wide arithmetic cannot tell whether they are inside.
 *
 * Such a root is a hit if the border is shared, the neighbour's polynomials have a root there too, and the two patches
 * lie on either side of the border as the ray sees them. Wherever the ray passes, it then meets one of them.
 */
#include <math.h>

#include "base/real.h"
#include "geometry/patch.h"
#include "geometry/vector.h"
#include "intersect/exact/judge.h"

/* The sum of these four or three vectors of the net, each from one point to another and with its weight, in the patch's
 * frame. Returns the sum of the weights of those that are not exactly 0. */
static double weighted_sum(const struct model_patch *patch, double (*P)[4][3], int count, const double weight[],
                           const int from[], const int to[], double out[3])
{
  double size = 0;
  out[0] = out[1] = out[2] = 0;
  for (int n = 0; n < count; n++) {
    const double *p = P[from[n] / 4][from[n] % 4], *q = P[to[n] / 4][to[n] % 4];
    if (p[0] == q[0] && p[1] == q[1] && p[2] == q[2]) continue;
    size += weight[n];
    for (int c = 0; c < 3; c++)
      out[c] += 3 * weight[n] * (patch->x[c][to[n] / 4][to[n] % 4] - patch->x[c][from[n] / 4][from[n] % 4]);
  }
  return size;
}

static wide along_border(const struct exact_root *root, int border) { return border < 2 ? root->v : root->u; }

/* The side of the border's curve, as seen along d, on which the patch lies at the root: the sign of det(d, tangent,
 * inward), or 0 if that is too small a part of its largest possible value to be sure. The tangent runs along the
 * border's parameter. Next to a pole, or where a handle has no length, derivatives are small, but so are their errors,
 * for what is exactly 0 has none. `apart`: how far from the root, along the border, the other patch has it. A border
 * may return to a point of its own, where other parts of the patches meet; but if it does so within that, its tangent
 * is no longer than second derivatives times that, and no side is sure. */
static int inner_side(const struct judge *j, const struct exact_root *root, int border, double apart, const double d[3])
{
  /* Derivatives are right to some units in the last place of the patch's size, 1; this is well above that. */
  static const double sure = 0x1p-40;
  /* How fast the determinant turns along the border, for |d| = 1: 3 times 2 products of a first derivative, at most 6,
   * and a second one, at most 24 or 36. */
  static const double turn = 6 * (6 * 24 + 6 * 36);
  struct patch_room room;
  const struct model_patch *patch = model_patch_at(j->asked->model, root->patch, &room);
  double(*P)[4][3] = j->asked->model->scene->patches[root->patch].P;
  const wide at = along_border(root, border);
  const double t = (double)at, s = (double)(1 - at), radius = border < 2 ? root->radius_v : root->radius_u;
  const double across[4] = {s * s * s, 3 * s * s * t, 3 * s * t * t, t * t * t}, along[3] = {s * s, 2 * s * t, t * t};
  double tangent[3], in[3], normal[3];
  int on[4], inside[4];
  for (int n = 0; n < 4; n++) on[n] = edge_at(border, n), inside[n] = on[n] + edge_inward(border);
  const double size = weighted_sum(patch, P, 3, along, on, on + 1, tangent) *
                      weighted_sum(patch, P, 4, across, on, inside, in);
  vector_cross(tangent, in, normal);
  const double side = vector_dot(normal, d),
               least = (sure * size + turn * (radius + apart)) * fabs(d[dominant_axis(d)]);
  return side > least ? 1 : side < -least ? -1 : 0;
}

/* Roots that may be one hit must have one t: next to the ray's start, wide arithmetic may leave more of t open than its
 * last places. */
#define ONE_T (4 * UNIT_ROUNDOFF)

static bool one_t(const struct exact_root *a, const struct exact_root *b)
{
  return judge_tie(a, b) && wide_abs(a->t - b->t) <= ONE_T * wide_abs(a->t);
}

bool judge_across(const struct judge *j, const struct exact_found *a, const struct exact_found *b)
{
  const struct model *model = j->asked->model;
  const struct exact_root *one = &a->root, *two = &b->root;
  if (a->borders & (a->borders - 1) || b->borders & (b->borders - 1)) return false; /* a corner */
  const int here = __builtin_ctz(a->borders), there = __builtin_ctz(b->borders);
  const struct edge_neighbour *other = model_neighbour(model, one->patch, here);
  if (other->patch != two->patch || other->border != there || !one_t(one, two)) return false;
  const wide along = along_border(one, here), along_two = along_border(two, there);
  const double apart = fabs((double)(along - (other->reversed ? 1 - along_two : along_two)));
  const double *d = j->asked->ray->direction;
  const int inner = inner_side(j, one, here, apart, d), inner_two = inner_side(j, two, there, apart, d);
  return inner * inner_two * (other->reversed ? -1 : 1) == -1;
}

static wide within(wide t) { return t < 0 ? 0 : t > 1 ? 1 : t; }

void judge_to_border(struct judge *j, struct exact_found *found)
{
  struct exact_root *root = &found->root;
  judge_turn(j, root->patch);
  if (judge_corner(j, found->borders, root, root)) return;
  root->u = within(root->u), root->v = within(root->v);
}

/* Sorts the roots, of which there are few, by patch. */
static void sort_by_patch(struct exact_list *list)
{
  for (size_t k = 1; k < list->count; k++) {
    const struct exact_found here = list->at[k];
    size_t n = k;
    for (; n > 0 && list->at[n - 1].root.patch > here.root.patch; n--) list->at[n] = list->at[n - 1];
    list->at[n] = here;
  }
}

/* Whether the border's root is at one t with the nearest hit, which is certain. */
static bool at_nearest(struct judge *j, const struct exact_root *root)
{
  if (j->rivals == 0 || !judge_tie(root, &j->nearest)) return false;
  return judge_sharpen(j, &j->nearest) ? one_t(root, &j->nearest) : judge_tie(root, &j->nearest);
}

/* Whether the ray crosses the surface at the border's root, the nearest hit being the other patch's root there. */
static bool crosses_at_nearest(const struct judge *j, const struct exact_found *found)
{
  const int here = __builtin_ctz(found->borders);
  const struct edge_neighbour *other = model_neighbour(j->asked->model, found->root.patch, here);
  const struct exact_found nearest = {.root = j->nearest, .borders = 1u << other->border};
  return judge_across(j, found, &nearest);
}

/* For a root tied with the nearest hit: whether the order of the two does not matter; they may be one place of the
 * surface. */
static bool fine_at_nearest(struct judge *j, const struct exact_found *found)
{
  struct exact_root root = found->root;
  if (crosses_at_nearest(j, found)) return true;
  judge_turn(j, root.patch);
  (void)judge_corner(j, found->borders, &root, &root); /* or the root is unchanged */
  return judge_weigh_tie(j, &root, &j->nearest);
}

/* Whether the ray crosses the surface at the border's root j->list[at]. If so, the hit belongs to the patch that stands
 * first in the scene of those that meet there. */
static bool keep_border(struct judge *j, size_t at)
{
  struct exact_found *found = &j->list->at[at];
  struct exact_root *root = &found->root;
  for (size_t b = 0; b < j->list->count; b++) {
    if (b == at || !judge_across(j, found, &j->list->at[b])) continue;
    if (root->patch > j->list->at[b].root.patch) return true;
    root->u = within(root->u), root->v = within(root->v);
    judge_keep(j, root);
    return true;
  }
  judge_turn(j, root->patch);
  return judge_tell_corner(j, found);
}

void judge_settle_borders(struct judge *j)
{
  sort_by_patch(j->list);
  for (size_t a = 0; a < j->list->count; a++) {
    struct exact_root *root = &j->list->at[a].root;
    const bool beside = at_nearest(j, root);
    const bool fine = !beside || fine_at_nearest(j, &j->list->at[a]);
    if (beside && !(fine && judge_stands_before(root, &j->nearest))) continue;
    if (!keep_border(j, a) && !beside) judge_open(j, &j->list->at[a]);
  }
}
