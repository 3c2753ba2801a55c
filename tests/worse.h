/* The worst of errors that a bound is asserted of. */
#ifndef TESTS_WORSE_H
#define TESTS_WORSE_H

/* The larger of the two; not a number if either is none. fmax would drop that one, and a bound on what is left would
 * hold. */
static inline double worse(double a, double b) { return a > b || a != a ? a : b; }

#endif
