/* Which patches a ray meets at one t: those that lie in one plane across an axis, such as a floor and what is laid on
 * it, and those with the same control points, in any of the eight orders that give the same surface. Numbers are equal
 * to the last bit, and 0 is -0. */
#ifndef PSCN_GEOMETRY_SURFACES_H
#define PSCN_GEOMETRY_SURFACES_H

#include <stddef.h>
#include <stdint.h>

#include "base/status.h"

/* Added to the surface of a net whose control points an earlier one has, too. */
#define SURFACE_AGAIN UINT32_C(0x80000000)

/* The axis across which all of that surface lies in a plane; -1 for none. */
#define SURFACE_AXIS(surface) ((int)((surface) >> 29 & 3) - 1)

/* Sets out[p] for net p of `count`, at nets + p * stride bytes: equal numbers for nets of one surface, but for
 * SURFACE_AGAIN; 0 for a net that lies in no plane across an axis and whose surface no other net has. May miss some in a
 * scene that is made for this. STATUS_LIMIT if memory is short. */
enum status surfaces_find(const void *nets, size_t stride, size_t count, uint32_t out[]) STATUS_MUST_CHECK;

#endif
