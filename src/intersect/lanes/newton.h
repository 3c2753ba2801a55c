/* One leaf and a ray in each lane: Newton's method in two dimensions, and the test that proves its result.
 *
 * Internal to src/intersect/lanes. Parameters (u,v) are the leaf's own, [0,1] x [0,1] over the leaf. Norms of parameter
 * vectors are maximum norms.
 */
#ifndef PSCN_INTERSECT_LANES_NEWTON_H
#define PSCN_INTERSECT_LANES_NEWTON_H

#include "intersect/lanes/packet.h"

/* The result of Newton's method and its proof (certificate.h). The other members have a meaning only on lanes where
 * `exists` is set, which are among the active ones. */
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

/* A root on a leaf. Points and derivatives are in the frame of its patch, and usable if the root is within the leaf's
 * margin. */
struct leaf_root {
  struct newton_root at;
  lanes w, t;                   /* x_k, and t along the ray */
  lanes left;                   /* bound on a plane's value after the last step */
  lanes point[3], su[3], sv[3]; /* derivatives by the leaf's parameters; none of these are set for any hit */
};

/* newton.c: iterates on the lanes of `active`, and tests the result. The start values start[0] and start[1] are those
 * of u - 1/2 and v - 1/2. The last step leaves the root right to the last places of its coordinates. */
void newton_solve(const struct packet *p, const struct leaf *leaf, int axis, const lanes start[2], lane_mask active,
                  struct leaf_root *out);

#endif
