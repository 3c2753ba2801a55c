/* A box on which a ray touches the surface, or nearly: finds both of its two roots, or that it has none, in one step.
 *
 * Internal to src/intersect/exact. Pure; safe on any thread.
 *
 * Theorem. Let F and G be two combinations of a and b, and D = F_x G_y - F_y G_x, on the box |x|, |y| <= 1. Multiply
 * the Jacobian of the map (G, D) by its inverse in the middle. If this product has a Lipschitz constant L <= FOLD_BEND
 * on the box of twice the size, then the points with G = 0 in the box, and as far as BOX_MARGIN outside it, lie on one
 * arc in the larger box. On either side of the one point of the arc where D = 0, the fold, F is monotone along it.
 *
 * Proof. Let M be that inverse and h = M (G, D). Then |h(w) - h(0) - w| <= L |w|^2/2. So h is one-to-one on the ball of
 * radius 2 (2 L < 1), and its image there contains all points within 2 (1 - L) of h(0). Points of the ball of radius
 * 9/8 (the box and BOX_MARGIN) go no farther from h(0) than 9/8 (1 + 9/16 L), which is less. The line G = 0 meets the
 * ball of radius 2 (1 - L) about h(0) in a segment, whose preimage is the arc. Along the arc G's gradient does not
 * vanish, D is monotone, and F's derivative is D times a number that is not 0.
 *
 * So the value of F at the fold, compared with the sign of its second derivative along the arc, tells whether there are
 * roots. If there are two that the certificate proves, they are all.
 */
#ifndef PSCN_INTERSECT_EXACT_FOLD_H
#define PSCN_INTERSECT_EXACT_FOLD_H

#include "intersect/exact/box.h"

#define FOLD_BEND 0.3125

enum fold_verdict {
  FOLD_EMPTY, /* no root in the box */
  FOLD_ROOTS, /* two, on the arc */
  FOLD_OPEN   /* none, two, or one double root, as far as can be told */
};

/* A polynomial in powers of x and y; the box is [-1,1]^2. */
struct fold_powers {
  double c[4][4];
};

/* Two combinations of a and b, rows of length 1: F, whose first derivatives in the middle of the box are as near to 0
 * as possible, and G across it. */
struct fold_pair {
  bool any; /* false if all of those of a and b vanish there; then nothing else is set */
  double row[2][2];
  struct fold_powers f, g;
};

/* A fold, in parameters of the box from -1 to 1. */
struct fold {
  double row[2][2]; /* combinations of a and b: H, whose gradient at the fold is as near to 0 as possible, and G */
  double at[2];     /* the fold, to double precision */
  double way[2];    /* direction of the arc there */
  double second;    /* H's second derivative in that direction */
  double m[2][2];   /* the inverse Jacobian M */
  double first;     /* bounds, on the larger box: the first derivatives of a and b, ... */
  double bend;      /* ... how fast H's gradient turns */
  double half;      /* distance of the roots from the fold, in units of `way`, or a bound on it */
  double uncertain; /* bound on the fold's distance from `at` */
};

/* Finds those two of the box. */
void fold_combine(struct box *box, struct fold_pair *out);

enum fold_bent {
  BENT_APART, /* no root in the box */
  BENT_FLAT,  /* indistinguishable from 0 all over the box: of parts on G = 0 it tells no more */
  BENT_OPEN
};

/* Tests the box by a combination whose factor is not a number but a polynomial of degree 1. Where the ray touches the
 * surface along a direction in which that does not bend, no other combination is far enough from 0. error: see
 * box_test. */
enum fold_bent fold_bent_test(const struct fold_pair *pair, struct box *box, const double error[2]);

/* Finds the fold of the pair's box. Returns false if the theorem does not hold or the box has no fold. error: see
 * box_test. */
bool fold_find(const struct fold_pair *pair, const double error[2], struct fold *out);

/* Decides by values and derivatives of H and G at fold->at, by the fold's parameters. Each value is off by at most
 * `error`. Sets fold->half and fold->uncertain. */
enum fold_verdict fold_weigh(struct fold *fold, const double h[3], const double g[3], double error);

/* The same with values from the box. */
enum fold_verdict fold_weigh_box(struct fold *fold, struct box *box, const double error[2]);

#endif
