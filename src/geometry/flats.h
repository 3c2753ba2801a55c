/* Which patches lie in one and the same plane across an axis: floors, and what is laid on them. A ray meets all of one plane
 * at one t.
 */
#ifndef PSCN_GEOMETRY_FLATS_H
#define PSCN_GEOMETRY_FLATS_H

#include <stddef.h>
#include <stdint.h>

#include "base/status.h"

/* Sets out[p] to the number of the plane, from 1 on, that net p of `count`, at nets + p * stride bytes, shares with others: one
 * coordinate of all its control points is the same, to the last bit (0 is -0). 0 where it lies in no such plane, or alone.
 * *out_count: how many planes there are. STATUS_LIMIT where memory is short. */
enum status flats_find(const void *nets, size_t stride, size_t count, uint32_t out[],
                       size_t *out_count) STATUS_MUST_CHECK;

#endif
