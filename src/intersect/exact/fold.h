/* A box on which a ray touches the surface, or nearly: both of its two roots, or that it has none, at one go.
 *
 * Internal to src/intersect/exact. Pure; safe on any thread.
 *
 * Theorem. Let F and G be two combinations of a and b, and D = F_x G_y - F_y G_x, on the box |x|, |y| <= 1. Where the
 * inverse Jacobian of the map (G, D) in the middle, times that map's Jacobian, has a Lipschitz constant L <= FOLD_BEND on
 * the box of twice the size, the points with G = 0 as far as BOX_MARGIN outside the box lie on one arc in the larger one,
 * and along it F is monotone on either side of the one point where D = 0, the fold.
 *
 * Proof. With h = M (G, D), |h(w) - h(0) - w| <= L |w|^2/2: so h maps the ball of radius 2 one to one (2 L < 1) onto a
 * set that has all points within 2 (1 - L) of h(0), and those within 9/8 (the box and BOX_MARGIN) to no farther than 9/8
 * (1 + 9/16 L), which is less. Of the line G = 0 the ball of that radius has a segment; its preimage is the arc. Along it
 * G's gradient does not vanish, F's derivative is D times a number that is not 0, and D is monotone.
 *
 * So what F is at the fold, against the sign of its second derivative along the arc, says whether there are roots; and
 * where there are two that are proven by the certificate they are all.
 */
#ifndef PSCN_INTERSECT_EXACT_FOLD_H
#define PSCN_INTERSECT_EXACT_FOLD_H

#include "intersect/exact/box.h"

#define FOLD_BEND 0.3125

enum fold_verdict {
  FOLD_EMPTY, /* no root in the box */
  FOLD_ROOTS, /* two on the arc */
  FOLD_OPEN   /* none, two, or one double root, as far as can be told */
};

/* A polynomial as powers of x and y in [-1,1], the box. */
struct fold_powers {
  double c[4][4];
};

/* Two combinations of a and b, of length 1: F, whose first derivatives vanish in the middle of the box as nearly as they
 * can, and G across it. */
struct fold_pair {
  bool any; /* false where those of a and b all vanish there: then nothing else is set */
  double row[2][2];
  struct fold_powers f, g;
};

/* A fold, in parameters of the box from -1 to 1. */
struct fold {
  double row[2][2]; /* combinations of a and b: H, whose gradient vanishes at the fold as nearly as can be, and G */
  double at[2];     /* the fold, as nearly as double has it */
  double way[2];    /* along the arc, there */
  double second;    /* H's second derivative that way */
  double m[2][2];   /* the inverse Jacobian M */
  double first;     /* bounds on the first derivatives of a and b on the larger box, and ... */
  double bend;      /* ... on how H turns */
  double half;      /* how far the roots are from the fold, of `way`, or may be at most */
  double uncertain; /* how far the fold may be from `at` */
};

/* Those two of the box. */
void fold_combine(struct box *box, struct fold_pair *out);

enum fold_bent {
  BENT_APART, /* no root in the box */
  BENT_FLAT,  /* it is indistinguishable from 0 all over the box: of parts on G = 0 it tells no more */
  BENT_OPEN
};

/* What a combination tells of the box whose factor is not a number but a polynomial of degree 1: where the ray touches the
 * surface along a direction in which that does not bend, no other one is far enough from 0. error: see box_test. */
enum fold_bent fold_bent_test(const struct fold_pair *pair, struct box *box, const double error[2]);

/* The fold of that box; false where the theorem does not hold, or none is in the box. error: see box_test. */
bool fold_find(const struct fold_pair *pair, const double error[2], struct fold *out);

/* What values and derivatives of H and G at fold->at say, by the fold's parameters; each value is off by at most `error`.
 * Sets fold->half and fold->uncertain. */
enum fold_verdict fold_weigh(struct fold *fold, const double h[3], const double g[3], double error);

/* The same with the box's own. */
enum fold_verdict fold_weigh_box(struct fold *fold, struct box *box, const double error[2]);

#endif
