/* The exact judge's first look, in doubles. It decides what rounding cannot change, and leaves the rest to the
 * integers. Internal to the exact judge.
 *
 * A net of doubles stands for the exact one, with a bound on the error of each coefficient. Every bound covers the
 * rounding of the arithmetic that made the coefficients, and its own. */
#ifndef TESTS_ACCURACY_EXACT_QUICK_H
#define TESTS_ACCURACY_EXACT_QUICK_H

#include <stdbool.h>
#include <stdint.h>

#include "accuracy/exact_ball.h"

/* Where a part of a box lies: its corner, in units of 2^-halved. */
struct place {
  uint64_t corner[2];
  int halved[2]; /* each at most QUICK_HALVINGS */
};
enum { QUICK_HALVINGS = 50 };

/* Nets over a part of a box, not multiplied as a box's are: |c[f][n] - exact| <= error[f]. */
struct quick {
  double c[NETS][16], error[NETS];
  struct place place;
  double begin; /* the least coefficient of net T, as stored there */
};

/* Starts with a whole box. F: its nets A and B or two combinations of them; t: its net T. Each gets a unit of its own
 * in which no coefficient is larger than one; returns that of T, as the power of two. The ends of the interval, in the
 * unit of the box's net T, become doubles beyond them, in the unit of `out`. */
slong quick_start(const fmpz (*F)[16], const fmpz *t, const fmpz_t low, const fmpz *high, struct quick *out,
                  double ends[2]);

/* Whether certainly no root is there, or none in the interval. */
bool quick_empty(const struct quick *quick, const double ends[2]);

enum quick_verdict {
  QUICK_OPEN,  /* halve it */
  QUICK_EMPTY, /* no root is there */
  QUICK_ONE,   /* at most one, there or next to it, perhaps at `at`, in the part's own coordinates */
  QUICK_SPENT  /* rounding hides the answer */
};
enum quick_verdict quick_look(const struct quick *quick, double at[2]);

/* QUICK_OPEN, or QUICK_SPENT if the part is too small to be halved. */
enum quick_verdict quick_depth(const struct quick *quick);

/* Halves the part along u or v, whichever its nets change most along. */
void quick_halve(const struct quick *quick, struct quick halves[2]);

/* Newton's method for two bicubics over [0,1]^2, from the middle. Returns whether it ends near by. Proves nothing. */
bool quick_newton(const double F[2][16], double at[2]);

#endif
