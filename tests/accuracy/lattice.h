/* A generator of situations where everything that can coincide does. Control points, origins and directions are small
 * whole numbers, so rays meet corners and borders exactly, touch surfaces, and lie in them, several at once. See
 * hostile.h. */
#ifndef TESTS_ACCURACY_LATTICE_H
#define TESTS_ACCURACY_LATTICE_H

#include "accuracy/situations.h"

void lattice(struct random *random, size_t index, struct situation *s);

#endif
