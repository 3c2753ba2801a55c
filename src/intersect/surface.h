/* Normals and error bounds of points on a patch, several at once.
 *
 * Internal to src/intersect; included by the sources that are compiled once per instruction set.
 */
#ifndef PSCN_INTERSECT_SURFACE_H
#define PSCN_INTERSECT_SURFACE_H

#include "base/lanes.h"
#include "intersect/tracer.h"

/* |Su x Sv| relative to the squared derivatives down to which it is the normal without further thought. */
#define SURFACE_PLAIN 0x1p-20

/* The point: its value (ten roundings on coefficients below one), the last places of u and v, one rounding of the
 * sum; in each coordinate, so up to sqrt(3) of it in distance. `tangent` bounds the derivatives' coordinates. */
#define POINT_ERROR(scale, tangent, magnitude) \
  (2 * ((12 + 2 * (tangent)) * UNIT_ROUNDOFF * (scale) + UNIT_ROUNDOFF * (magnitude)))

/* A ray that starts nearer to the surface than this and the point's own error cannot be told from one that starts on
 * it: the rounding of the new origin, and the distance within which subdivision cannot exclude a root:
 * UNDECIDED_ERRORS error bounds of either plane, with moments of at most 2 as for all rays that start in the patch's
 * box, and what a copy is loose by; doubled for the planes' being oblique. */
#define CLEARANCE(scale, loose, magnitude) \
  (4 * UNIT_ROUNDOFF * (magnitude) + 2 * UNDECIDED_ERRORS * (PLANE_ERROR(2, 2) * (scale) + 2 * (loose)))

LANES_INLINE lanes surface_clamp(lanes t) { return lanes_min(lanes_max(t, lanes_all(0)), lanes_all(1)); }

/* Bound on the derivatives' coordinates. */
LANES_INLINE lanes surface_tangent(const lanes su[3], const lanes sv[3])
{
  lanes tangent = lanes_all(0);
  for (int c = 0; c < 3; c++) tangent = lanes_max(lanes_abs(su[c]) + lanes_abs(sv[c]), tangent);
  return tangent;
}

LANES_INLINE void surface_cross(const lanes su[3], const lanes sv[3], lanes out[3])
{
  for (int c = 0; c < 3; c++) {
    const int i = (c + 1) % 3, j = (c + 2) % 3;
    out[c] = su[i] * sv[j] - su[j] * sv[i];
  }
}

/* A point in the scene, its error and clearance as of struct hit. */
struct surface_point {
  lanes at[3], error, clearance;
};

/* From a point in the frame of the patch; `tangent` as of POINT_ERROR. */
LANES_INLINE struct surface_point surface_point(const struct model_patch *patch, const lanes local[3], lanes tangent)
{
  struct surface_point point;
  lanes magnitude = lanes_all(0);
  for (int c = 0; c < 3; c++) {
    point.at[c] = patch->center[c] + patch->scale * local[c];
    magnitude = lanes_max(lanes_abs(point.at[c]), magnitude);
  }
  point.error = POINT_ERROR(patch->scale, tangent, magnitude);
  point.clearance = point.error + CLEARANCE(patch->scale, patch->loose, magnitude);
  return point;
}

/* The unit normal from the cross product of derivatives; lanes where it is sure. */
LANES_INLINE lane_mask surface_normal(const lanes cross[3], lanes tangent, lanes out[3])
{
  const lanes length = lanes_sqrt(cross[0] * cross[0] + cross[1] * cross[1] + cross[2] * cross[2]);
  const lanes inverse = 1 / length;
  for (int c = 0; c < 3; c++) out[c] = cross[c] * inverse;
  return length > SURFACE_PLAIN * tangent * tangent;
}

#endif
