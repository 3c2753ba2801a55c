/* The exact judge's nets of integers. Internal to it.
 */
#ifndef TESTS_ACCURACY_EXACT_NET_H
#define TESTS_ACCURACY_EXACT_NET_H

#include <stdbool.h>

#include "accuracy/exact_ball.h"
#include "accuracy/exact_quick.h"

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

/* The nets of a patch and a ray, A and B the planes, T along the ray. All of `out` has been initialised. */
void box_of_patch(const double P[4][4][3], const double o[3], const double d[3], double t_min, double t_max,
                  struct box *out, struct interval *interval);

/* Halves it into two that have been initialised. */
void box_split(const struct box *box, int across_v, struct box *low, struct box *high);

/* Whether that is where its nets, each in units of its largest coefficient, change most. */
int box_changes_along_v(const struct box *box);

/* A place of a box, into one that has been initialised. */
void box_of_place(const struct box *box, const struct place *place, struct box *out);

/* 1 or -1 where all coefficients have that sign, else 0. */
int net_sign(const fmpz *c);

/* Combinations of A and B, the rows of the mean Jacobian's adjugate: they vary along u and along v alone, and next to a
 * tangency both only quadratically. */
void box_combinations(const struct box *box, fmpz F[2][16]);

/* Whether |dF/d own| > |dF/d other| on the box and on what is next to it, within NET_OVERHANG of its size: the derivatives
 * there change by less than 2^-MARGIN of their largest. */
#define NET_OVERHANG 0x1p-40
bool net_dominates(const fmpz *F, int own_is_v);

/* Whether A and B are multiples of one net. */
bool box_dependent(const struct box *box);

/* Where T plus a multiple of A or B, A and B themselves being multiples of one net, has one value: puts it in the place of T,
 * in another unit. So it is where a patch is a line or a point: the ray meets all of it at one t. */
void box_straighten(struct box *box, struct interval *interval);

#endif
