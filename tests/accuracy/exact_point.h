/* Roots of the exact judge that are known exactly: those at points of rational parameters, and those along edges.
 * Internal to it. */
#ifndef TESTS_ACCURACY_EXACT_POINT_H
#define TESTS_ACCURACY_EXACT_POINT_H

#include "accuracy/exact_ball.h"
#include "accuracy/exact_quick.h"

/* The box's one root is in the balls s and t. If their simplest fractions are this root exactly: whether it lies in the
 * patch and strictly between the ends low and high (NULL: none) of the interval, in the unit of net T of the whole
 * patch. Otherwise unknown. */
enum side point_side(const struct box *box, const arb_t s, const arb_t t, const fmpz_t low, const fmpz *high);

/* Whether halving a place of the patch can never decide it, even without rounding. The simplest fractions in it are
 * then a root where both gradients are parallel (so that no part that holds it has one sign, or derivatives that
 * dominate), or a line of one parameter on which both nets vanish. */
enum hopeless { HOPELESS_NOT, HOPELESS_POINT, HOPELESS_CURVE };
enum hopeless point_hopeless(const struct box *whole, const struct place *place);

/* Whether the net vanishes on a border: 0 for u = 0, 1 for u = 1, 2 for v = 0, 3 for v = 1. */
bool point_edge_vanishes(const fmpz *c, int border);

/* 6 c / x as a cubic, x being the parameter that is 0 at c[0] = 0. */
void point_divide_out(fmpz *c, int stride);

#endif
