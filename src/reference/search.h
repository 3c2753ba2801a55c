/* The subdivision inside the reference: all common zeros of a(u,v) and b(u,v) on one patch. reference.h has the
 * method. */
#ifndef PSCN_REFERENCE_SEARCH_H
#define PSCN_REFERENCE_SEARCH_H

#include <stdbool.h>

#include "reference/quad.h"

struct search_root {
  quad u, v, t;
  double radius, t_radius; /* bounds on the errors of (u,v), within which it is the only zero, and of t */
};

/* Room for roots, of which there are at most 18 unless a and b have a curve in common; and the number of boxes that are
 * halved before the rest is given up. */
enum { SEARCH_MAX_ROOTS = 32, SEARCH_BUDGET = 800 };

struct search_result {
  int count;
  struct search_root root[SEARCH_MAX_ROOTS];
  bool undecided; /* some boxes could not be settled; their zeros, if any, have t >= t_undecided */
  double t_undecided;
};

/* Finds zeros with t in (-inf, t_max]; those beyond may be left out. Roots up to REFERENCE_BORDER outside [0,1]^2 are
 * listed too. P is the patch; the direction is not zero. */
void search_patch(const double P[4][4][3], const double origin[3], const double direction[3], double t_max,
                  struct search_result *out);

#endif
