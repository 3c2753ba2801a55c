/* A box of parameters, with the ray's polynomials over it: tests of it, and its halves.
 *
 * Internal to src/intersect/exact. Pure; safe on any thread.
 */
#ifndef PSCN_INTERSECT_EXACT_BOX_H
#define PSCN_INTERSECT_EXACT_BOX_H

#include <stdbool.h>

#include "intersect/point.h"

/* A root may lie this far outside a box, in the box's parameters, and still be proven from it: then the neighbour has
 * it. Bounds used that far outside grow: second derivatives, quartic in the extent, by (1 + 2/16)^4 = 1.602;
 * errors of values by (1 + 2/16)^6 = 2.027. */
#define BOX_MARGIN 0.0625
#define BOX_MARGIN_GROWTH 1.61
#define BOX_MARGIN_OFF 2.03

/* A combination whose computed values stay within this many of its error bounds all over a box tells nothing about
 * it. */
#define FLAT_ERRORS (UNDECIDED_ERRORS - 1)

/* The most steps that move a point of a box onto the ray (they converge quadratically, or halve the rest at a double
 * root), and how far off it may then be, in error bounds. A choice of words: such a point is told as grazing. */
enum { ONTO_STEPS = 8, ONTO_ERRORS = 16 };

enum verdict {
  VERDICT_EMPTY, /* no root in the box */
  VERDICT_FLAT,  /* some combination is indistinguishable from zero on it, but not all are */
  VERDICT_POINT, /* all are: as far as can be told, the box is one point, on the ray */
  VERDICT_OPEN
};

struct box {
  double net[3][4][4];   /* a, b, w */
  double u, v;           /* low corner, in the search's window */
  double size_u, size_v; /* as parts of it, each at least LEAST_SIZE: so all four are exact */
  double near, far;      /* hull of t */
  int halvings;
};

/* Tests whether the box can be dropped, by the hulls of a, b and the two combinations of them that aim along the
 * parameters. `error` bounds the errors of the coefficients of a and b. */
enum verdict box_test(struct box *box, const double error[2]);

/* Finds a root by Newton's method from `root`, and sets root and radius in box parameters. Returns whether the root is
 * proven and, if `alone`, alone. */
bool box_solve(struct box *box, const double error[2], bool alone, double root[2], double radius[2]);

/* Moves (u,v), box parameters, towards the ray without leaving the box, by shortest Gauss-Newton steps, because the two
 * polynomials may be nearly dependent. Returns whether the point is on the ray as far as can be told. */
bool box_onto_ray(struct box *box, const double error[2], double *u, double *v);

/* The largest change from one coefficient to the next in the nets first..last, along u and along v. */
void box_variation(const struct box *box, int first, int last, double *along_u, double *along_v);

/* The two halves, without their hulls of t. */
void box_cut(struct box *box, bool across_u, struct box out[2]);

#endif
