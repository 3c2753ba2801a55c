/* A candidate: a leaf, and those rays of a packet that may pass its boxes and share a dominant axis.
 *
 * Internal to src/intersect/lanes. A candidate goes through a sequence of stages; candidate.c shows their order. All
 * stages have one shape: they take the lanes that are still open, may offer roots (nearest.c), and return the lanes
 * that are open after them. A stage closes a lane once the leaf is proven to be missed, or all of its roots have been
 * offered. The last resort (exact.h) decides what is open at the end. Parameters (u,v) are the leaf's own, [0,1] x
 * [0,1] over the leaf.
 */
#ifndef PSCN_INTERSECT_LANES_CANDIDATE_H
#define PSCN_INTERSECT_LANES_CANDIDATE_H

#include <string.h>

#include "geometry/patch.h"
#include "intersect/lanes/packet.h"
#include "intersect/prepare/leaf.h"

/* ---- roots ---- */

/* The result of Newton's method in two dimensions and its proof (certificate.h). The other members have a meaning only
 * on lanes where `exists` is set, which are among the active ones. */
struct newton_root {
  lanes u, v;
  lanes radius_u, radius_v; /* bounds on the distance of the exact root */
  lane_mask exists;         /* the exact polynomials have exactly one root within the radii */
  lane_mask alone;          /* and the leaf has no other */
};

/* Lanes on which two roots of a leaf may be one, because their enclosures meet. */
LANES_INLINE lane_mask roots_meet(const struct newton_root *a, const struct newton_root *b)
{
  return (lanes_abs(a->u - b->u) <= a->radius_u + b->radius_u + UNIT_ROUNDOFF) &
         (lanes_abs(a->v - b->v) <= a->radius_v + b->radius_v + UNIT_ROUNDOFF);
}

/* Lanes whose root is proven, and is in the leaf or may be. */
LANES_INLINE lane_mask inside(const struct newton_root *r)
{
  return r->exists & (r->u >= -r->radius_u) & (r->u - 1 <= r->radius_u) & (r->v >= -r->radius_v) &
         (r->v - 1 <= r->radius_v);
}

/* A root on a leaf. Points and derivatives are in the frame of its patch, and usable if the root is within the leaf's
 * margin. */
struct leaf_root {
  struct newton_root at;
  lanes w, t;                   /* x_k, and t along the ray */
  lanes left;                   /* bound on a plane's value after the last step */
  lanes point[3], su[3], sv[3]; /* derivatives by the leaf's parameters; none of these are set for any hit */
};

/* The most roots near [0,1] of a resultant that are tried on a lane: of 18 roots, more are hardly ever real and in
 * [0,1]; and the most further ones that pieces seek. Choices of speed. */
enum { TRIED_ROOTS = 8, MORE_ROOTS = 3 };

/* The roots of a leaf that are known: the k-th of every lane. */
struct leaf_roots {
  int count;
  struct leaf_root root[TRIED_ROOTS + MORE_ROOTS];
  lane_mask proven[TRIED_ROOTS + MORE_ROOTS]; /* a root, and none of those before it */
};

/* newton.c: iterates on the lanes of `active`, and tests the result. The start values start[0] and start[1] are those
 * of u - 1/2 and v - 1/2. The last step leaves the root right to the last places of its coordinates. */
void newton_solve(const struct packet *p, const struct leaf *leaf, int axis, const lanes start[2], lane_mask active,
                  struct leaf_root *out);

/* ---- the stages ---- */

/* What the stages pass on to later ones, in the order in which they set it. */
struct candidate {
  /* packet_leaf: */
  const struct leaf *leaf;
  const struct model_patch *patch; /* the leaf's */
  int64_t number;                  /* the leaf's, in its model */
  int axis;
  const struct line *line; /* the packet's, for that axis */
  /* stage_bilinear sets the first one, of which nothing has a meaning except where it exists; stage_resultant, all: */
  struct leaf_roots known;
};

/* candidate.c: tests the slab across the leaf to the last places. Closes lanes where it lies before the ray's start,
 * behind its end, or behind the nearest hit so far. */
lane_mask stage_slab(const struct packet *p, const struct candidate *it, lane_mask open);

/* newton.c: finds the root of the leaf's bilinear part by a resultant of degree 2, and refines it by Newton's method
 * on the leaf. A lane stays open if the ray is so slanted that the root is not proven to be the only one. */
lane_mask stage_bilinear(struct packet *p, struct candidate *it, lane_mask open);

/* newton.c: returns the lanes of `open` whose ray starts beyond the first root and does not come back to the leaf. */
lane_mask stage_leaves(const struct packet *p, const struct candidate *it, lane_mask open);

/* cover.c: closes lanes where pieces that cover the leaf show that it has no root, by the default method also none
 * besides that of stage_bilinear and those that are found in the pieces. */
lane_mask stage_cover(struct packet *p, struct candidate *it, lane_mask open);

/* resultant.c: finds the roots of Bezout's resultant of a and b by the scene's method. Closes lanes where it has no sign
 * variation, where the roots are proven to be all, and all lanes without polish. */
lane_mask stage_resultant(struct packet *p, struct candidate *it, lane_mask open);

/* explain.c: called before and after a candidate, if the tracer is to explain (explain.h); `blind`: it was postponed at
 * once. */
void explain_before(const struct packet *p, const struct candidate *it);
void explain_after(const struct packet *p, const struct candidate *it, bool blind);

/* ---- what they call ---- */

/* nearest.c: postpones the leaf, or the same leaf of a copy, on the lanes of `open`: the last resort decides it
 * (exact.h). */
void packet_postpone(struct packet *p, const struct candidate *it, lane_mask open);

/* nearest.c: offers proven roots of several lanes. */
void offer_root(struct packet *p, const struct candidate *it, const struct leaf_root *root, lane_mask hits);

/* Offers the known roots on the lanes of `where`. */
LANES_INLINE void offer_known(struct packet *p, const struct candidate *it, lane_mask where)
{
  const struct leaf_roots *known = &it->known;
  for (int k = 0; k < known->count; k++)
    offer_root(p, it, &known->root[k], where & known->proven[k] & inside(&known->root[k].at));
}

/* nearest.c: offers a point in the leaf of which nothing is proven. */
void offer_unproven(struct packet *p, const struct candidate *it, double u, double v, unsigned lane);

/* x_k at a point of the leaf. */
static inline double leaf_depth(const struct candidate *it, double u, double v)
{
  double x[4][4];
  memcpy(x, it->leaf->x[it->axis], sizeof x);
  return patch_evaluate(x, u, v).value;
}

/* resultant.c: returns the real root of r0 + r1 s + r2 s^2 nearest to 0, or the real part of a complex pair, by the
 * scene's method. Removes lanes from *open where it finds none. */
lanes method_quadratic_root(struct packet *p, const struct candidate *it, const lanes r[3], lane_mask *open);

/* The most halvings of a leaf. A choice of speed. */
enum { COVER_HALVINGS = 24 };

/* cover.c: the lanes of `open` on which all of the leaf's roots are known: they are among it->known, or are found and
 * offered. For any hit, those found on other lanes are offered, too. */
lane_mask cover_proves(struct packet *p, struct candidate *it, int halvings, lane_mask open);

/* A patch lies within |w| < 1 in its frame; a ray is not examined beyond this. */
#define FRAME_END 2.0

/* The ray seeks a root up to t = far between these values of w = x_k, each off by `off` at most. */
LANES_INLINE void ray_ends(const struct packet *p, const struct candidate *it, lanes far, lanes *from, lanes *to,
                           lanes *off)
{
  const lanes along = p->direction[it->axis] * (1 / it->patch->scale), start = it->line->start[0];
  const lanes at_min = p->t_min * along - start, at_far = far * along - start;
  *from = lanes_clamp(lanes_min(at_min, at_far), -FRAME_END, FRAME_END);
  *to = lanes_clamp(lanes_max(at_min, at_far), -FRAME_END, FRAME_END);
  *off = 2 * (p->t_error * lanes_abs(along) + 16 * UNIT_ROUNDOFF * lanes_abs(start));
}

/* On the ray x_i = m0 + s0 w, x_j = m1 + s1 w, x_k = w, the slab's form g x - offset is a + b w. */
LANES_INLINE void slab_values(const struct line *line, int k, const struct leaf_slab *slab, lanes *a, lanes *b)
{
  const int i = (k + 1) % 3, j = (k + 2) % 3;
  *a = slab->g[i] * line->moment[0] + (slab->g[j] * line->moment[1] - slab->offset);
  *b = slab->g[i] * line->slope[0] + (slab->g[j] * line->slope[1] + slab->g[k]);
}

LANES_INLINE void plane_values(const struct line *line, int axis, const double x[3][16], int at, lanes *a, lanes *b)
{
  const double k = x[axis][at], i = x[(axis + 1) % 3][at], j = x[(axis + 2) % 3][at];
  *a = (i - line->moment[0]) - line->slope[0] * k;
  *b = (j - line->moment[1]) - line->slope[1] * k;
}

#endif
