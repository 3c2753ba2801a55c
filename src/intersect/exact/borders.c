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

/* The side of the border's curve, as seen along d, on which the patch lies at `along`: the sign of det(d, tangent,
 * inward), or 0 if that is too small a part of its largest possible value to be sure. The tangent runs along the
 * border's parameter. */
static int inner_side(struct model_patch *patch, int border, double along, const double d[3])
{
  /* Derivatives are right to some units in the last place of the patch's size, 1; this is well above that. */
  static const double sure = 0x1p-40;
  const double inward = border & 1 ? -1 : 1;
  double at[2], tangent[3], in[3], normal[3];
  edge_place(border, along, at);
  for (int c = 0; c < 3; c++) {
    const struct patch_jet jet = patch_evaluate(patch->x[c], at[0], at[1]);
    tangent[c] = border < 2 ? jet.dv : jet.du;
    in[c] = inward * (border < 2 ? jet.du : jet.dv);
  }
  vector_cross(tangent, in, normal);
  const double side = vector_dot(normal, d), least = sure * fabs(d[dominant_axis(d)]);
  return side > least ? 1 : side < -least ? -1 : 0;
}

static double along_border(const struct exact_root *root, int border)
{
  return (double)(border < 2 ? root->v : root->u);
}

/* Places on a border that are no farther apart than this are one. A border may return to a point of its own, where
 * other parts of the patches meet. But if it does so within 2^-50, its tangent there is no longer than second
 * derivatives, 24 a coordinate, times that; with |inward| at most 6 a coordinate, no side of it is sure. */
#define ONE_PLACE 0x1p-50

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
  const double along = along_border(one, here), along_two = along_border(two, there);
  if (!(fabs(along - (other->reversed ? 1 - along_two : along_two)) <= ONE_PLACE)) return false;
  const double *d = j->asked->ray->direction;
  struct patch_room room[2];
  const int inner = inner_side(model_patch_at(model, one->patch, &room[0]), here, along, d);
  const int inner_two = inner_side(model_patch_at(model, two->patch, &room[1]), there, along_two, d);
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
