/* Which patches lie in planes across an axis: floors, and what is laid on them. A ray meets all of one plane at one t, and one
 * that starts in it at 0.
 */
#ifndef PSCN_GEOMETRY_FLATS_H
#define PSCN_GEOMETRY_FLATS_H

#include <stddef.h>
#include <stdint.h>

#include "base/status.h"

/* Sets out[p] to the number of the plane that net p of `count`, at nets + p * stride bytes, lies in: one coordinate of all its
 * control points is the same, to the last bit (0 is -0). 0 where it lies in none. *out_count: how many planes there are.
 * STATUS_LIMIT where memory is short. */
enum status flats_find(const void *nets, size_t stride, size_t count, uint32_t out[],
                       size_t *out_count) STATUS_MUST_CHECK;

/* The axis that a plane of that number is across. */
static inline int flat_axis(uint32_t plane) { return (int)(plane % 3); }

#endif
