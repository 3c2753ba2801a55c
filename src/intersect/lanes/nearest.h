/* The nearest root of every lane, or all roots (gather.h): the one place where roots are taken or refused.
 *
 * Internal to src/intersect/lanes. A root is taken if double precision leaves no question. If it may lie on a border of
 * its patch, at an end of the ray, or where another root is, its leaf is left to the last resort.
 */
#ifndef PSCN_INTERSECT_LANES_NEAREST_H
#define PSCN_INTERSECT_LANES_NEAREST_H

#include "intersect/lanes/candidate.h"

/* Lanes where a root at t comes before the best: it is nearer, or at the same t to the last bit and of a lower patch or
 * leaf. This orders all roots, so the answer does not depend on the order in which they come. */
LANES_INLINE lane_mask best_after(const struct best *best, lanes t, lane_mask patch, lane_mask leaf)
{
  const lane_mask first = (patch < best->patch) | ((patch == best->patch) & (leaf < best->leaf));
  return (t < best->t) | ((t == best->t) & first);
}

/* Lanes of `where` on which a and b are two patches of the scene with one surface: the ray meets both at one t. */
LANES_INLINE lane_mask one_surface(const struct model *model, lane_mask a, lane_mask b, lane_mask where)
{
  lane_mask one = {0};
  if (!model->surface) return one;
  for (unsigned bits = lanes_bits(where & (a != b) & (a != NO_PATCH) & (b != NO_PATCH)); bits; bits &= bits - 1) {
    const int l = __builtin_ctz(bits);
    const uint32_t surface = model->surface[a[l]];
    if (surface != 0 && surface == model->surface[b[l]]) one |= lanes_mask(bits & -bits);
  }
  return one;
}

/* Makes a certain root the best on the lanes of `taken`. */
LANES_INLINE void best_take(struct best *best, lane_mask taken, const lanes at[2], const lanes radius[2], lanes t,
                            lane_mask patch, lane_mask leaf)
{
  best->u = lanes_select(taken, at[0], best->u), best->v = lanes_select(taken, at[1], best->v);
  best->radius_u = lanes_select(taken, radius[0], best->radius_u);
  best->radius_v = lanes_select(taken, radius[1], best->radius_v);
  best->t = lanes_select(taken, t, best->t);
  best->patch = (taken & patch) | (~taken & best->patch), best->leaf = (taken & leaf) | (~taken & best->leaf);
  best->certain |= taken, best->final &= ~taken;
}

/* Lanes whose root is proven, and is in the leaf or may be. */
LANES_INLINE lane_mask inside(const struct newton_root *r)
{
  return r->exists & (r->u >= -r->radius_u) & (r->u - 1 <= r->radius_u) & (r->v >= -r->radius_v) &
         (r->v - 1 <= r->radius_v);
}

/* The leaf's first border (geometry/edges.h) that is a pole, or -1. */
LANES_INLINE int leaf_pole(const struct model_patch *patch, const struct leaf *leaf)
{
  const uint16_t *split = patch->cut.split;
  const bool *pole = patch->pole;
  return pole[0] && leaf->column_u == 0              ? 0
         : pole[1] && leaf->column_u == split[0] - 1 ? 1
         : pole[2] && leaf->column_v == 0            ? 2
         : pole[3] && leaf->column_v == split[1] - 1 ? 3
                                                     : -1;
}

/* How far a point of the surface moves at most within the radii of a root. Along a pole's border, the derivative is no
 * more than the mixed one times the distance from the pole. */
LANES_INLINE lanes root_reach(const struct candidate *it, const struct newton_root *r)
{
  const struct leaf *leaf = it->leaf;
  const lanes radius[2] = {r->radius_u, r->radius_v};
  const int border = leaf_pole(it->patch, leaf), d = border / 2;
  if (border < 0) return leaf->first[0] * radius[0] + leaf->first[1] * radius[1];
  const lanes at = d ? r->v : r->u, away = lanes_abs(border & 1 ? 1 - at : at) + radius[d];
  return leaf->first[d] * radius[d] + lanes_min(lanes_all(leaf->first[1 - d]), leaf->second[1] * away) * radius[1 - d];
}

/* Postpones the leaf, or the same leaf of a copy, on the lanes of `open`: the last resort decides it (exact.h). */
void packet_postpone(struct packet *p, const struct candidate *it, lane_mask open);

/* Postpones the copy's patch that the best root of these lanes is in. */
void packet_postpone_best(struct packet *p, lane_mask open);

/* Offers proven roots of several lanes. */
void offer_root(struct packet *p, const struct candidate *it, const struct leaf_root *root, lane_mask hits);

/* Offers points in the leaf of which nothing is proven. */
void offer_unproven(struct packet *p, const struct candidate *it, lanes u, lanes v, lane_mask hits);

#endif
