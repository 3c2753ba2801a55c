/* A ray in the frame of one patch, and the errors of its planes.
 *
 * Internal to src/intersect. Let k be the axis along which the direction d is longest, i and j the two others. The ray
 * is the line where two planes meet (paper eq 2), chosen so that their normals are exactly perpendicular to d:
 *
 *     x_i - (d_i/d_k) x_k = m[0],   x_j - (d_j/d_k) x_k = m[1].
 *
 * The moments m are formed in double-double from the unrounded origin (lanes/packet.c). Their size is about 1 for a ray
 * that passes the patch, and they are right to a few units in the last place of that if the ray starts at most some 2^50
 * patches away; beyond that their error grows, and the bound includes it. The position along the ray is read off x_k.
 */
#ifndef PSCN_INTERSECT_LOCAL_RAY_H
#define PSCN_INTERSECT_LOCAL_RAY_H

#include "intersect/intersect.h"
#include "intersect/model.h"

/* Rounding errors, in units of UNIT_ROUNDOFF, of a = (x_i - m) - slope x_k and of its value in Bernstein form, for
 * |x| <= 1: net 8 (two for leaves that are cut exactly; others add the rounding of the cut, prepare/leaf.c), slope 2
 * (packet.c multiplies by the reciprocal), moment 4|m|, the two operations 2 + |m|, and for the value ten products
 * and sums on coefficients of at most 2 + |m|. A value from weights, as in geometry/patch.h, has eighteen: still
 * less than sqrt 2 times this, and the certificate has that to spare for sums of a row. */
#define PLANE_ERROR(m0, m1) (UNIT_ROUNDOFF * (36 + 16 * ((m0) + (m1))))

/* What double-double leaves unknown of a moment m_i. Of q_i d_k and q_k d_i, exact products of the leading parts of the
 * origin's coordinates q in the frame of the patch, the sum of the rests takes roundings of at most 8 UNIT_ROUNDOFF^2
 * of the two. qi = |q_i|, qk = |q_k d_i/d_k|. */
#define MOMENT_ERROR(qi, qk) (8 * UNIT_ROUNDOFF * UNIT_ROUNDOFF * ((qi) + (qk)))

/* The axis along which d is longest. */
static inline int dominant_axis(const double d[3])
{
  const double x = d[0] < 0 ? -d[0] : d[0], y = d[1] < 0 ? -d[1] : d[1], z = d[2] < 0 ? -d[2] : d[2];
  return x >= y && x >= z ? 0 : y >= z ? 1 : 2;
}

#endif
