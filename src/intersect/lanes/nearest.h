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

/* How far a point of the surface moves at most within the radii of a root. */
LANES_INLINE lanes root_reach(const struct candidate *it, const struct newton_root *r)
{
  return it->leaf->first[0] * r->radius_u + it->leaf->first[1] * r->radius_v;
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
