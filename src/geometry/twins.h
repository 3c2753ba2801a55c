/* Which patches lie exactly on an earlier one: the same control points, to the last bit (0 is -0), in the same order
 * or in one of the seven others that give the same surface.
 */
#ifndef PSCN_GEOMETRY_TWINS_H
#define PSCN_GEOMETRY_TWINS_H

#include <stdbool.h>
#include <stddef.h>

#include "base/status.h"

/* Whether all control points are equal, P[i][j] to Q[i][j]. */
bool net_equal(double P[4][4][3], double Q[4][4][3]);

/* The same in any of the eight orders. */
bool net_twins(double P[4][4][3], double Q[4][4][3]);

/* Sets out[p] where net p of `count`, at nets + p * stride bytes, is an earlier one's twin. One may be passed over
 * where a scene is made to have it so. STATUS_LIMIT where memory is short. */
enum status twins_find(const void *nets, size_t stride, size_t count, bool out[]) STATUS_MUST_CHECK;

#endif
