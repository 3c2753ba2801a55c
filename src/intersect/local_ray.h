/* A ray in the frame of one patch, the errors of its planes, and those of points on the patch, as answers state them.
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

/* The axis along which d is longest. */
static inline int dominant_axis(const double d[3])
{
  const double x = d[0] < 0 ? -d[0] : d[0], y = d[1] < 0 ? -d[1] : d[1], z = d[2] < 0 ? -d[2] : d[2];
  return x >= y && x >= z ? 0 : y >= z ? 1 : 2;
}

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

/* ---- points on the patch ---- */

/* Su x Sv is the normal without further thought if it is longer than SURFACE_SURE times the squared derivatives and
 * SURFACE_SURE times SURFACE_LEAST times the derivatives: rounding takes some 2^-47 of derivatives in the patch's
 * frame, whatever their size. */
#define SURFACE_SURE 0x1p-20
#define SURFACE_LEAST 0x1p-8

/* The error of a point: of its value (ten roundings on coefficients below one), the last places of u and v, one
 * rounding of the sum. Each is in every coordinate, so up to sqrt(3) of it in distance. `tangent` bounds the
 * derivatives' coordinates. */
#define POINT_ERROR(scale, tangent, magnitude) \
  (2 * ((12 + 2 * (tangent)) * UNIT_ROUNDOFF * (scale) + UNIT_ROUNDOFF * (magnitude)))

/* A ray that starts nearer to the surface than this plus the point's own error is as good as one that starts on it: 128
 * times the rounding of the new origin (tracer_leave), and five error bounds of either plane, with moments of at most 2 as
 * for all rays that start in the patch's box, and what a copy is loose by; doubled because the planes are oblique. */
#define CLEARANCE(scale, loose, magnitude) \
  (512 * UNIT_ROUNDOFF * (magnitude) + 10 * (PLANE_ERROR(2, 2) * (scale) + 2 * (loose)))

#endif
