/* Rays that an adversary would aim: rings of every radius from 1e-18 to 1 round all that is special about a surface,
 * starts next to it, nets that are degenerate but for some roundings, coordinates of every size. For the exact judge
 * (certificate.h); the classes of situations.h are the reference's as well.
 */
#ifndef TESTS_ACCURACY_HOSTILE_H
#define TESTS_ACCURACY_HOSTILE_H

#include "accuracy/situations.h"

/* Those of situations.h first. */
size_t every_class_count(void);
const struct situation_class *every_class_at(size_t index); /* index < the count */

/* Tangencies of the third order and higher, where what one ray may cost ends before the roots are told apart: what the exact
 * judge finds of grazing answers there is counted and printed, and proves no fault. */
bool class_told_only(const struct situation_class *class);

#endif
