/* Generators of situations at the limits of double: sizes of one patch many decades apart, starts so far away that a
 * rounding moves the ray by many patches. See hostile.h. */
#ifndef TESTS_ACCURACY_EXTREMES_H
#define TESTS_ACCURACY_EXTREMES_H

#include "accuracy/situations.h"

void extreme_uneven_sizes(struct random *random, size_t index, struct situation *s);
void extreme_wild_sizes(struct random *random, size_t index, struct situation *s); /* beyond wide arithmetic's digits */
void extreme_met_poles(struct random *random, size_t index, struct situation *s);
void extreme_far_origins(struct random *random, size_t index, struct situation *s);
void extreme_far_diagonal(struct random *random, size_t index, struct situation *s);
void extreme_far_oblique(struct random *random, size_t index, struct situation *s);

#endif
