/* How much of a heavy test is done.
 *
 * The environment variable PSCN_EFFORT holds the fraction of the full work, a decimal number in (0,1], or `full` (1).
 * Without it a small fraction is done, so that the whole suite takes minutes; run.sh sets a smaller one still.
 */
#ifndef TESTS_EFFORT_H
#define TESTS_EFFORT_H

#include <stddef.h>
#include <stdint.h>

/* PSCN_EFFORT as a number in (0,1]; EFFORT_DEFAULT where it is unset or no such number. */
#define EFFORT_DEFAULT 0.002
double effort_fraction(void);

/* The seed a heavy test starts from: `seed` itself, or another one for every whole number in PSCN_SEED, so that runs
 * add up. */
uint64_t effort_seed(uint64_t seed);

/* `full` times the fraction, at least `least` and at most `full`. */
size_t effort_count(size_t full, size_t least);

#endif
