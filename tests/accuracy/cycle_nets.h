/* Closed surfaces of patches that nobody would draw. Every border is met an even number of times, so a line meets the
 * whole an even number of times, whatever the patches do between their borders. */
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

/* How the patches are glued together, how wild they are between their borders, and how they lie in space. */
size_t cycle_shape_count(void);
const char *cycle_shape_name(size_t shape);

/* Whether the surface stays closed when rounding moves control points, equal ones alike. It does not where a corner
 * lies within a border of another patch. */
bool cycle_shape_moves(size_t shape);

/* Coordinates are of some units, or 10^-15 to 10^6 of that along an axis, and shifted. The directions of u and v on a
 * patch are random. */
void cycle_make(size_t shape, struct random *random, struct cycle *out);

#endif
