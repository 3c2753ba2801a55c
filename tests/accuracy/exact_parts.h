/* What the files of the exact judge (exact.h) share. Internal to it. */
#ifndef TESTS_ACCURACY_EXACT_PARTS_H
#define TESTS_ACCURACY_EXACT_PARTS_H

#include <stdbool.h>
#include <stdint.h>

#include <arb.h>
#include <flint/fmpz.h>

/* ---- exact_ball.c: ball arithmetic ---- */

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

/* ---- exact_quick.c: the first look, in doubles. It decides what rounding cannot change, and leaves the rest to the
 * integers.
 *
 * A net of doubles stands for the exact one, with a bound on the error of each coefficient. Every bound covers the
 * rounding of the arithmetic that made the coefficients, and its own. ---- */

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

/* ---- exact_net.c: nets of integers ---- */

/* The interval of t, in the unit of net T of the whole patch. */
struct interval {
  fmpz_t low, high;
  bool endless;
  arb_t unit; /* t = unit x (value of net T) */
};

/* Bits of `unit`. */
enum { UNIT_PRECISION = 192 };

void nets_init(fmpz *c, int count);
void nets_clear(fmpz *c, int count);
void box_init(struct box *box);
void box_clear(struct box *box);

/* The nets of a patch and a ray: A and B for the planes, T along the ray. All of `out` has been initialised. */
void box_of_patch(const double P[4][4][3], const double o[3], const double d[3], double t_min, double t_max,
                  struct box *out, struct interval *interval);

/* Splits the box into two that have been initialised. */
void box_split(const struct box *box, int across_v, struct box *low, struct box *high);

/* Whether the box's nets, each in units of its largest coefficient, change most along v. */
int box_changes_along_v(const struct box *box);

/* Cuts a place out of a box, into one that has been initialised. */
void box_of_place(const struct box *box, const struct place *place, struct box *out);

/* 1 or -1 if all coefficients have that sign, otherwise 0. */
int net_sign(const fmpz *c);

/* Combinations of A and B by the rows of the mean Jacobian's adjugate. They vary along u and along v alone; next to a
 * tangency both vary only quadratically. */
void box_combinations(const struct box *box, fmpz F[2][16]);

/* Whether |dF/d own| > |dF/d other| on the box and around it, up to NET_OVERHANG of its size: the derivatives there
 * change by less than 2^-MARGIN of their largest. */
#define NET_OVERHANG 0x1p-40
bool net_dominates(const fmpz *F, int own_is_v);

/* Whether A and B are multiples of one net. */
bool box_dependent(const struct box *box);

/* For A and B that are multiples of one net: if T plus a multiple of A or B has one value, puts that in the place of T,
 * in another unit. This is so where a patch is a line or a point: the ray meets all of it at one t. */
void box_straighten(struct box *box, struct interval *interval);

/* ---- exact_point.c: roots that are known exactly: those at points of rational parameters, and those along edges ---- */

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
