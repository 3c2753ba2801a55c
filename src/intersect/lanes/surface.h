/* Normals and error bounds of points on a patch, several at once.
 *
 * Internal to src/intersect; included by the sources that are compiled once per instruction set.
 */
#ifndef PSCN_INTERSECT_LANES_SURFACE_H
#define PSCN_INTERSECT_LANES_SURFACE_H

#include "base/lanes.h"
#include "intersect/point.h"

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

/* A point in the scene, with its error and clearance as in struct hit. */
struct surface_point {
  lanes at[3], error, clearance;
};

/* Converts a point in the patch's frame; `tangent` is that of POINT_ERROR. */
LANES_INLINE struct surface_point surface_point(const struct model_patch *patch, const lanes local[3], lanes tangent)
{
  struct surface_point point;
  lanes magnitude = lanes_all(0);
  for (int c = 0; c < 3; c++) {
    point.at[c] = patch->center[c] + patch->scale * local[c];
    magnitude = lanes_max(lanes_abs(point.at[c]), magnitude);
  }
  point.error = POINT_ERROR(patch->scale, tangent, magnitude);
  point.clearance = point.error + CLEARANCE(patch->scale, patch->cut.loose, magnitude);
  return point;
}

/* Computes the unit normal from the derivatives' cross product. Returns the lanes where it is sure. */
LANES_INLINE lane_mask surface_normal(const lanes cross[3], lanes tangent, lanes out[3])
{
  const lanes length = lanes_sqrt(cross[0] * cross[0] + cross[1] * cross[1] + cross[2] * cross[2]);
  const lanes inverse = 1 / length;
  for (int c = 0; c < 3; c++) out[c] = cross[c] * inverse;
  return length > SURFACE_SURE * tangent * lanes_max(tangent, lanes_all(SURFACE_LEAST));
}

#endif
