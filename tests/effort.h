/* How much work a heavy test does.
 *
 * PSCN_EFFORT in the environment holds the fraction of the full work: a decimal number in (0,1], or `full` (1).
 * Without it, a small fraction is done, so that the whole suite takes minutes; run.sh sets an even smaller one. */
#ifndef TESTS_EFFORT_H
#define TESTS_EFFORT_H

#include <stddef.h>
#include <stdint.h>

/* PSCN_EFFORT as a number in (0,1]; EFFORT_DEFAULT if it is unset or no such number. */
#define EFFORT_DEFAULT 0.002
double effort_fraction(void);

/* The seed of a heavy test: `seed` itself, or a different one for every whole number in PSCN_SEED, so that runs add
 * up. */
uint64_t effort_seed(uint64_t seed);

/* `full` times the fraction, but at least `least` and at most `full`. */
size_t effort_count(size_t full, size_t least);

#endif
