/* The root of a ray on a nearly bilinear leaf.
 *
 * Internal to src/intersect/lanes.
 */
#ifndef PSCN_INTERSECT_LANES_BILINEAR_H
#define PSCN_INTERSECT_LANES_BILINEAR_H

#include "intersect/lanes/newton.h"
#include "intersect/lanes/packet.h"

/* What is known of a root on a nearly bilinear leaf. Points and derivatives are in the frame of its patch. */
struct bilinear_root {
  struct newton_root at;
  lanes w, t;                   /* x_k, and how far along the ray */
  lanes point[3], su[3], sv[3]; /* derivatives by the leaf's parameters; none of these where any hit will do */
};

/* A root on a leaf that has parts, on the lanes of `active`: by Newton's process to the last places, and the test. It
 * starts from start[0], start[1], values of u - 1/2 and v - 1/2. */
void bilinear_root_solve(const struct packet *p, const struct leaf *leaf, int axis, const lanes start[2],
                         lane_mask active, struct bilinear_root *out);

#endif
