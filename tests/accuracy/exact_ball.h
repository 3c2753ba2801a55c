/* The ball arithmetic of exact.c. Internal to the exact judge. */
#ifndef TESTS_ACCURACY_EXACT_BALL_H
#define TESTS_ACCURACY_EXACT_BALL_H

#include <stdbool.h>

#include <arb.h>
#include <flint/fmpz.h>

/* The plane polynomials, and t in a unit of its own. */
enum { A, B, T, NETS };

/* Bits at which the judge gives up. */
enum { EXACT_PRECISION = 6144 };

/* Nets over a part of the patch, multiplied by 8 for every halving. */
struct box {
  fmpz c[NETS][16]; /* c[f][4 * i + j] */
  fmpz u, v;        /* the lower corner, in units of 2^-halved */
  int halved[2];
};

struct ball_jet {
  arb_t value, ds, dt;
};

void ball_jet_init(struct ball_jet *jet);
void ball_jet_clear(struct ball_jet *jet);

/* The net c at the ball (s,t). */
void ball_evaluate(const fmpz *c, const arb_t s, const arb_t t, struct ball_jet *out, long bits);

/* Where Newton's method starts: its end in doubles, from the middle of the box, or the middle. Proves nothing. */
void ball_start(const fmpz (*F)[16], arb_t s, arb_t t);

/* Newton's method from the point (s,t), radii 0. On success (s,t) is a ball that holds exactly one root. */
bool ball_prove(const fmpz (*F)[16], arb_t s, arb_t t, long bits);

/* On which side of the patch's border the only root in the box or next to it lies. That a root is exactly on the border
 * is known if both nets are multiples of one cubic there, or vanish at a corner. */
enum side { SIDE_IN, SIDE_OUT, SIDE_UNKNOWN };
enum side ball_side(const struct box *box, const arb_t s, const arb_t t);

#endif
