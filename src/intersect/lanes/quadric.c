/* The test of quadric.h, and the roots that it decides.
 *
 * Compiled once per instruction set. The error bounds hold with and without fused multiply-add.
 */
#include "intersect/lanes/quadric.h"

#include "intersect/lanes/nearest.h"
#include "intersect/prepare/leaf.h"

/* Stands in for a slope of 0. For |w| <= FRAME_END it moves nothing by more than a plane's error. */
#define LEAST_SLOPE 0x1p-60

/* Narrows the range to where |a + b w| <= half. */
LANES_INLINE void within_slab(lanes a, lanes b, lanes half, struct quadric_along *out)
{
  const lanes least = lanes_all(LEAST_SLOPE), inverse = 1 / lanes_select(lanes_abs(b) < least, least, b);
  const lanes middle = -a * inverse, reach = half * lanes_abs(inverse);
  out->from = lanes_max(middle - reach, out->from), out->to = lanes_min(middle + reach, out->to);
}

lane_mask quadric_along(const struct packet *p, const struct candidate *it, lane_mask open, struct quadric_along *out)
{
  const struct leaf *leaf = it->leaf;
  const struct leaf_quadric *quadric = &leaf->quadric;
  const double *c = quadric->c;
  lanes z, dz, y1, dy1, y2, dy2;
  slab_values(it->line, it->axis, &leaf->slab[0], &z, &dz);
  slab_values(it->line, it->axis, &leaf->slab[1], &y1, &dy1);
  slab_values(it->line, it->axis, &leaf->slab[2], &y2, &dy2);
  const lanes by_1 = c[1] + c[3] * y1 + c[4] * y2, by_2 = c[2] + c[5] * y2;
  const lanes turn_1 = c[3] * dy1 + c[4] * dy2, turn_2 = c[5] * dy2;
  out->f[0] = z - (c[0] + y1 * by_1 + y2 * by_2);
  out->f[1] = dz - (dy1 * by_1 + y1 * turn_1 + dy2 * by_2 + y2 * turn_2);
  out->f[2] = -(dy1 * turn_1 + dy2 * turn_2);
  const double rounded = 8 * UNIT_ROUNDOFF; /* bound on the errors of dy1 and dy2 */
  const lanes way_1 = lanes_abs(dy1) + rounded, way_2 = lanes_abs(dy2) + rounded;
  out->turn = quadric->turn[0] * way_1 + (quadric->turn[1] * way_2 + quadric->slack);
  out->turn_wide = quadric->turn_wide[0] * way_1 + (quadric->turn_wide[1] * way_2 + quadric->slack);
  lanes off;
  /* up to t_max and not the nearest hit so far: else earlier hits would show in the last places of later ones */
  ray_ends(p, it, p->t_max, &out->from, &out->to, &off);
  out->from -= off, out->to += off, off = 10 * it->line->error;
  within_slab(y1, dy1, leaf->slab[1].half + off, out);
  within_slab(y2, dy2, leaf->slab[2].half + off, out);
  return open & (it->line->error <= QUADRIC_ERROR);
}

LANES_INLINE lanes value_at(const struct quadric_along *a, lanes w) { return a->f[0] + w * (a->f[1] + w * a->f[2]); }

/* Lanes where f is nowhere within `off` of 0. */
LANES_INLINE lane_mask passes_by(const struct quadric_along *a, double off)
{
  const lanes first = value_at(a, a->from), last = value_at(a, a->to);
  /* where f is extremal, or the end next to that */
  const lanes turns = lanes_min(lanes_max(-0.5 * a->f[1] / a->f[2], a->from), a->to), extreme = value_at(a, turns);
  const lanes low = lanes_min(lanes_min(first, last), extreme), high = lanes_max(lanes_max(first, last), extreme);
  return (low > off) | (high < -off);
}

/* A proven root, as the tests of the quadric use it. */
struct known_place {
  lane_mask near; /* it exists, on the widened leaf */
  lanes w, reach; /* where it is, and a bound on that one's error */
  lanes turn;     /* as in struct quadric_along, for that root and any other one on the leaf */
};

LANES_INLINE struct known_place place_of(const struct quadric_along *a, const struct candidate *it,
                                         const struct leaf_root *root)
{
  const struct newton_root *r = &root->at;
  const lanes far_u = lanes_abs(r->u - 0.5) + r->radius_u, far_v = lanes_abs(r->v - 0.5) + r->radius_v;
  return (struct known_place){r->exists & (far_u <= 0.5 + LEAF_MARGIN) & (far_v <= 0.5 + LEAF_MARGIN), root->w,
                              it->leaf->first[0] * r->radius_u + it->leaf->first[1] * r->radius_v + 2 * it->line->error,
                              lanes_select((far_u <= 0.5) & (far_v <= 0.5), a->turn, a->turn_wide)};
}

lane_mask quadric_closes(const struct quadric_along *a, const struct candidate *it, const struct leaf_root *root,
                         lane_mask open)
{
  const struct known_place at = place_of(a, it, root);
  const lanes first = a->f[1] + a->f[2] * ((at.w - at.reach) + a->from);
  const lanes last = a->f[1] + a->f[2] * ((at.w + at.reach) + a->to);
  const lane_mask alone = at.near & ((lanes_min(first, last) > at.turn) | (lanes_max(first, last) < -at.turn));
  return open & ((a->from > a->to) | passes_by(a, it->leaf->quadric.off) | alone);
}

lane_mask stage_quadric(struct packet *p, const struct candidate *it, lane_mask open)
{
  struct quadric_along along;
  if (!it->leaf->has_quadric) leaf_quadrics(1, it->leaf);
  const lane_mask closed = quadric_closes(&along, it, &it->first, quadric_along(p, it, open, &along));
  offer_root(p, it, &it->first, closed & inside(&it->first.at));
  open &= ~closed & p->live;
  if (it->patch->lanes == SOLVER_LANES_SIGNS)
    p->tracer->counts.roots_found += lanes_count(closed & it->first.at.exists);
  return open;
}
