/* All points where a ray meets a patch, proven: the judge of the judges.
 *
 * Shares nothing with the renderer and nothing with src/reference. The two plane polynomials are bicubic nets of exact
 * integers (FLINT's fmpz): the doubles of patch and ray are dyadic numbers, and halving a net keeps it so. Boxes of the
 * (u,v) square are halved, first as nets of doubles with bounds on each coefficient's error (exact_quick.c), then as
 * integers where rounding hides the answer. A box
 * - holds no root if a combination of the two nets has coefficients of one sign;
 * - holds at most one if the combinations that aim along u and v have derivatives that dominate (exactly compared).
 *   Newton's and Krawczyk's method in ball arithmetic (arb) find and prove that root. The precision is raised until it
 *   is known on which side of the patch's border the root lies, or it is proven to lie on the border.
 * A root where boxes meet is found in both, and listed once.
 * Edges on which both polynomials vanish (a collapsed edge met exactly) are roots and are divided out.
 * Whatever cannot be decided that way (a double root met exactly, a curve in common) is listed as undecided. */
#ifndef TESTS_ACCURACY_EXACT_H
#define TESTS_ACCURACY_EXACT_H

#include <stdbool.h>
#include <stddef.h>

/* EXACT_BOXES: the budget of a whole patch, in boxes examined. */
enum { EXACT_MOST_ROOTS = 64, EXACT_BOXES = 2000 };

struct exact_root {
  double u, v;   /* nearest doubles */
  double t;      /* the nearest double */
  double t_rest; /* t + t_rest is the root's t to twice the digits */
  bool proven;   /* false: perhaps outside the patch or the interval; or any point of [t, t_end] */
  double t_end;  /* = t if proven */
};

struct exact_roots {
  size_t count;
  struct exact_root root[EXACT_MOST_ROOTS];
  size_t boxes; /* examined */
};

/* The common points with t_min < t < t_max (INFINITY: no end) of the closed patch and the line. All arguments except
 * t_max are finite; the direction is not zero. */
void exact_patch_roots(const double P[4][4][3], const double origin[3], const double direction[3], double t_min,
                       double t_max, struct exact_roots *out);

/* Frees what FLINT keeps. */
void exact_cleanup(void);

#endif
