/* Closed surfaces of patches that nobody would draw: every border is met an even number of times, so that a line meets the
 * whole an even number of times, whatever the patches do between their borders.
 */
#ifndef TESTS_ACCURACY_CYCLE_NETS_H
#define TESTS_ACCURACY_CYCLE_NETS_H

#include <stdbool.h>
#include <stddef.h>

#include "random.h"

enum { CYCLE_MOST = 12 };

struct cycle {
  size_t count;
  double P[CYCLE_MOST][4][4][3];
};

/* What the patches are glued to, how wild they are between their borders, and how they lie in space. */
size_t cycle_shape_count(void);
const char *cycle_shape_name(size_t shape);

/* Whether control points may be moved by rounding, equal ones alike, and it is closed still: not where a corner lies within
 * a border of another patch. */
bool cycle_shape_moves(size_t shape);

/* Coordinates are some units, or 10^-15 to 10^6 of that along an axis, and shifted. Which way u and v run on a patch is
 * random. */
void cycle_make(size_t shape, struct random *random, struct cycle *out);

#endif
