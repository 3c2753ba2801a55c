/* What the paper's experiments share: random numbers and eq 11. */
#ifndef PSCN_EXAMPLES_MEASURE_H
#define PSCN_EXAMPLES_MEASURE_H

#include <stddef.h>
#include <stdint.h>

#include "algebra/root_problem.h"

/* Uniform in [0,1); SplitMix64. */
double measure_random(uint64_t *state);

/* Coefficients c[0..degree], uniform in [-1,1]. */
void measure_random_polynomial(uint64_t *state, int degree, double c[]);

/* The middle one of `count` numbers, which it sorts. */
double measure_median(size_t count, double x[]);

/* polynomial_eq11 of a value that need not be finite; below 1 the root is accurate. */
double measure_eq11(const struct root_problem *problem, double re, double im);

#endif
