/* A generator of situations where everything that can coincide does: control points, origins and directions are small
 * whole numbers, so that rays meet corners and borders exactly, touch, and lie in surfaces, several at once. See
 * hostile.h.
 */
#ifndef TESTS_ACCURACY_LATTICE_H
#define TESTS_ACCURACY_LATTICE_H

#include "accuracy/situations.h"

void lattice(struct random *random, size_t index, struct situation *s);

#endif
