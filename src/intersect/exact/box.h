/* A box of parameters, with the ray's polynomials over it: what can be told of it, and its halves.
 *
 * Internal to src/intersect/exact. Pure; safe on any thread.
 */
#ifndef PSCN_INTERSECT_EXACT_BOX_H
#define PSCN_INTERSECT_EXACT_BOX_H

#include <stdbool.h>

#include "intersect/point.h"

/* How far outside a box, in its own parameters, its root may lie and still be told from having none (then the
 * neighbour has it); the growth of second-derivative bounds, quartic in the extent, when they are used that far
 * outside: (1 + 2/16)^4 = 1.602; and that of what values are off by: (1 + 2/16)^6 = 2.027. */
#define BOX_MARGIN 0.0625
#define BOX_MARGIN_GROWTH 1.61
#define BOX_MARGIN_OFF 2.03

/* A combination whose computed values are within this many of its error bounds all over a box says nothing about it. */
#define FLAT_ERRORS (UNDECIDED_ERRORS - 1)

/* How many steps take a point of a box onto the ray, where they can: it converges quadratically, or halves what is left
 * where there is a double root; and how far off it may be then, in error bounds. A choice of words: what is told is
 * grazing. */
enum { ONTO_STEPS = 8, ONTO_ERRORS = 16 };

enum verdict {
  VERDICT_EMPTY, /* no root in the box */
  VERDICT_FLAT,  /* some combination, but not all, is indistinguishable from zero on it */
  VERDICT_POINT, /* all are: the box is a point on the ray as far as can be told */
  VERDICT_OPEN
};

struct box {
  double net[3][4][4];   /* a, b, w */
  double u, v;           /* low corner, of the search's window */
  double size_u, size_v; /* as parts of it, no smaller than LEAST_SIZE: so all four are exact */
  double near, far;      /* hull of t */
  int halvings;
};

/* Whether the box can be dropped, by the hulls of a, b and the two combinations of them that aim along the parameters.
 * `error` bounds the errors of the coefficients of a and of b. */
enum verdict box_test(struct box *box, const double error[2]);

/* The root that Newton's method finds from `root`, in box parameters with its radii; returns whether it is proven and,
 * where that is asked, alone. */
bool box_solve(struct box *box, const double error[2], bool alone, double root[2], double radius[2]);

/* Moves (u,v), box parameters, onto the ray, as far as that can be done within the box: by Gauss and Newton's shortest
 * steps, for the two polynomials may be nearly dependent. Returns whether the point is on it as far as can be told. */
bool box_onto_ray(struct box *box, const double error[2], double *u, double *v);

/* The largest change of the nets first..last from one coefficient to the next, along u and along v. */
void box_variation(const struct box *box, int first, int last, double *along_u, double *along_v);

/* The two halves, but for their hulls of t. */
void box_cut(struct box *box, bool across_u, struct box out[2]);

#endif
