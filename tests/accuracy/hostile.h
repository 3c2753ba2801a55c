/* Rays that an adversary would aim: rings of every radius from 1e-18 to 1 round every special feature of a surface,
 * starts next to it, nets that are degenerate up to some roundings, coordinates of every size. They are for the exact
 * judge (certificate.h); the classes of situations.h are also for the reference. */
#ifndef TESTS_ACCURACY_HOSTILE_H
#define TESTS_ACCURACY_HOSTILE_H

#include "accuracy/situations.h"

/* The classes of situations.h come first. */
size_t every_class_count(void);
const struct situation_class *every_class_at(size_t index); /* index < the count */

/* Whether a ray's limit of work ends the search before the roots are told apart: tangencies of the third order and
 * higher, rays past met poles. Findings on grazing answers are counted and printed, and prove no fault. */
bool class_told_only(const struct situation_class *class);

#endif
