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

#endif
