/* Which patches lie in planes across an axis: floors, and what is laid on them. A ray meets all patches of one plane at
 * one t, at 0 if it starts in the plane. */
#ifndef PSCN_GEOMETRY_FLATS_H
#define PSCN_GEOMETRY_FLATS_H

#include <stddef.h>
#include <stdint.h>

#include "base/status.h"

/* The plane of all points whose coordinate `axis` is `value`. */
struct flat_plane {
  double value;
  int axis;
};

/* Sets out[p] to the number of the plane that net p of `count`, at nets + p * stride bytes, lies in, or to 0: one
 * coordinate of all its control points is equal, to the last bit (0 is -0). *out_planes: the planes from number 1 on,
 * owned by the caller; NULL if there are none. STATUS_LIMIT if memory is short. */
enum status flats_find(const void *nets, size_t stride, size_t count, uint32_t out[],
                       struct flat_plane **out_planes) STATUS_MUST_CHECK;

#endif
