/* All complex roots of a polynomial with double coefficients, with proof, by FLINT's arb (peer; libflint-arb-dev).
 *
 * The coefficients are taken as the exact numbers they are: scaled to integers, split into squarefree factors, whose
 * roots arb isolates. Multiplicities are therefore exact too.
 */
#ifndef TESTS_CORPUS_EXACT_ROOTS_H
#define TESTS_CORPUS_EXACT_ROOTS_H

#include <stdbool.h>

#include "algebra/polynomial.h"

struct exact_roots;

/* The finite roots of p. Its coefficients must be finite and not all zero; p->error is ignored. NULL if memory is
 * short. */
struct exact_roots *exact_roots_find(const struct polynomial *p);
void exact_roots_destroy(struct exact_roots *roots);

/* Distinct roots, and one of them: rounded to double, its multiplicity, whether it is exactly real. */
struct exact_root {
  double re, im;
  int multiplicity;
  bool real;
};

int exact_roots_count(const struct exact_roots *roots);
struct exact_root exact_roots_at(const struct exact_roots *roots, int index);

/* A lower and an upper bound on the distance from (re,im) to root `index`, within 1e-15 relative of each other. */
double exact_roots_distance_below(const struct exact_roots *roots, int index, double re, double im);
double exact_roots_distance_above(const struct exact_roots *roots, int index, double re, double im);

/* The least exact_roots_distance_below over all roots; INFINITY if there are none. */
double exact_roots_nearest_below(const struct exact_roots *roots, double re, double im);

#endif
