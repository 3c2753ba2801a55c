/* Error bounds of points on a patch, as answers state them.
 *
 * Internal to src/intersect.
 */
#ifndef PSCN_INTERSECT_POINT_H
#define PSCN_INTERSECT_POINT_H

#include "intersect/local_ray.h"
#include "intersect/model.h"

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
