/* The subdivision inside the reference: all common zeros of a(u,v) and b(u,v) on one patch. See reference.h for the
 * method. */
#ifndef PSCN_REFERENCE_SEARCH_H
#define PSCN_REFERENCE_SEARCH_H

#include <stdbool.h>

#include "reference/quad.h"

struct search_root {
  quad u, v, t;
  double radius, t_radius; /* the only zero within `radius` of (u,v) is at most so far off; the same for t */
};

/* Room for roots, of which there are 18 at most where a and b have no curve in common; and how many boxes are halved before
 * the rest is given up. */
enum { SEARCH_MAX_ROOTS = 32, SEARCH_BUDGET = 800 };

struct search_result {
  int count;
  struct search_root root[SEARCH_MAX_ROOTS];
  bool undecided; /* some boxes could not be settled: zeros there, if any, have t >= t_undecided */
  double t_undecided;
};

/* Zeros with t in (-inf, t_max]: those beyond may be left out. Roots up to REFERENCE_BORDER outside [0,1]^2 are
 * listed too. P is the patch; the direction is not zero. */
void search_patch(const double P[4][4][3], const double origin[3], const double direction[3], double t_max,
                  struct search_result *out);

#endif
