/* Polynomials that solvers find hard, by family, as many of each as wanted. */
#ifndef TESTS_CORPUS_FAMILIES_H
#define TESTS_CORPUS_FAMILIES_H

#include "algebra/polynomial.h"
#include "random.h"

enum family {
  FAMILY_DECADES_0,  /* random coefficients of one size */
  FAMILY_DECADES_10, /* of sizes that differ by up to so many decades */
  FAMILY_DECADES_20,
  FAMILY_DECADES_60,
  FAMILY_CLUSTERS,  /* groups of near roots, real and complex, coefficients rounded */
  FAMILY_MULTIPLE,  /* few small rational roots, often multiple; exact */
  FAMILY_CHEBYSHEV, /* T_n of a x + b */
  FAMILY_MIGNOTTE,  /* x^n - 2 (a x - 1)^2: two roots very near to each other */
  FAMILY_WILKINSON, /* equally spaced real roots */
  FAMILY_SPARSE,    /* few coefficients that are not zero, perhaps none at the ends */
  FAMILIES
};

/* "corpus" for FAMILIES. */
const char *family_name(enum family family);

/* Writes the coefficients of a polynomial of the family, c[k] of x^k, finite and not all zero. Returns its degree,
 * which is at least 1; c[degree] may be 0. */
int family_draw(enum family family, struct random *random, double c[POLYNOMIAL_MAX_DEGREE + 1]);

#endif
