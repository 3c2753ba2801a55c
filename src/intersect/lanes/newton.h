/* One ray a lane against one leaf: Newton's method in two dimensions, and the test that proves what it ended at.
 *
 * Internal to src/intersect/lanes.
 * Parameters (u,v) are the leaf's own, [0,1] x [0,1] over the leaf. Norms of parameter vectors are maximum norms.
 */
#ifndef PSCN_INTERSECT_LANES_NEWTON_H
#define PSCN_INTERSECT_LANES_NEWTON_H

#include "intersect/lanes/packet.h"

/* What is known after Newton's method, M being the inverse Jacobian where it ended (certificate.h). The fields mean
 * something only where `exists`, which is on no lane that was not asked for. */
struct newton_root {
  lanes u, v;
  lanes radius_u, radius_v; /* the exact root is within */
  lane_mask exists;         /* exactly one root of the exact polynomials within the radii */
  lane_mask alone;          /* and no other in the leaf */
};

/* Lanes on which two roots of a leaf may be one: their enclosures meet. */
LANES_INLINE lane_mask roots_meet(const struct newton_root *a, const struct newton_root *b)
{
  return (lanes_abs(a->u - b->u) <= a->radius_u + b->radius_u + UNIT_ROUNDOFF) &
         (lanes_abs(a->v - b->v) <= a->radius_v + b->radius_v + UNIT_ROUNDOFF);
}

/* How far the root is from the leaf's pole, in the parameter across it. */
LANES_INLINE lanes pole_distance(const struct leaf *leaf, const struct newton_root *r)
{
  const int border = leaf->pole - 1;
  const lanes at = border < 2 ? r->u : r->v;
  return border & 1 ? 1 - at : at;
}

/* A root on a leaf. Points and derivatives are in the frame of its patch, and of any use where the root is within the
 * leaf's margin. */
struct leaf_root {
  struct newton_root at;
  lanes w, t;                   /* x_k, and how far along the ray */
  lanes left;                   /* bound on what the last step leaves of a plane's value */
  lanes point[3], su[3], sv[3]; /* derivatives by the leaf's parameters; none of these where any hit will do */
};

/* newton.c: the steps on the lanes of `active`, and the test. It starts from start[0], start[1], values of u - 1/2 and
 * v - 1/2, and ends with a step that leaves the root right to the last places of its coordinates. */
void newton_solve(const struct packet *p, const struct leaf *leaf, int axis, const lanes start[2], lane_mask active,
                  struct leaf_root *out);

#endif
