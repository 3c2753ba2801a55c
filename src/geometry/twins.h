/* Which patches lie exactly on an earlier one: the same control points, to the last bit (0 is -0), in the same order or
 * in one of the seven others that give the same surface. */
#ifndef PSCN_GEOMETRY_TWINS_H
#define PSCN_GEOMETRY_TWINS_H

#include <stdbool.h>
#include <stddef.h>

#include "base/status.h"

/* Whether all control points are equal, P[i][j] to Q[i][j]. */
bool net_equal(double P[4][4][3], double Q[4][4][3]);

/* Whether they are equal in any of the eight orders. */
bool net_twins(double P[4][4][3], double Q[4][4][3]);

/* Sets out[p] if net p of `count`, at nets + p * stride bytes, is a twin of an earlier one. May miss a twin in a scene
 * that is made for this. STATUS_LIMIT if memory is short. */
enum status twins_find(const void *nets, size_t stride, size_t count, bool out[]) STATUS_MUST_CHECK;

#endif
