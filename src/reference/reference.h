/* The reference: the closest hit of a ray with a list of bicubic Bezier patches, with a guarantee.
 *
 * For tests and the chart. It shares no code and no method with the renderer: no resultant, no roots of polynomials in
 * one variable. The ray is the intersection of two planes, so each patch becomes two bicubic functions a(u,v), b(u,v).
 * Boxes of the (u,v) square are halved. A box is
 * - dropped if the hull of the Bernstein coefficients of a linear combination of a and b excludes zero;
 * - settled if a preconditioned Jacobian stays within 1/2 of the identity (then the box has at most one root:
 *   injectivity by diagonal dominance) and Krawczyk's test in quadruple precision proves the root that Newton's method
 *   finds.
 * Boxes are dropped in double precision with running error bounds. Wherever the bound is no longer small beside the
 * variation in the box, the box is cut anew from the quadruple-precision net. Inputs are exact: the doubles as given.
 *
 * What is guaranteed (magnitudes of the data between 1e-60 and 1e60):
 * REFERENCE_HIT      there is a hit at t, to within t_radius, and no hit before it;
 * REFERENCE_MISS     there is no hit with t > 0;
 * REFERENCE_GRAZING  undecided, for one of three reasons:
 *                    (1) a box of REFERENCE_SMALLEST_BOX a side (or more boxes than a budget allows) cannot be settled:
 *                        a double root, a collapsed edge met exactly, a curve in common;
 *                    (2) the hit is within REFERENCE_BORDER of the border of its patch and no other patch shares it;
 *                    (3) the hit is at the ray's origin, within REFERENCE_ORIGIN times the size of the data.
 * Source: R. Moore, R. Kearfott, M. Cloud, Introduction to Interval Analysis, chapter 8 (preconditioning, Krawczyk's
 * operator).
 */
#ifndef PSCN_REFERENCE_REFERENCE_H
#define PSCN_REFERENCE_REFERENCE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "reference/quad.h"

#define REFERENCE_SMALLEST_BOX 0x1p-44 /* parameter, absolute: 5.7e-14 */
#define REFERENCE_BORDER 0x1p-46       /* parameter, absolute: 1.4e-14 */
#define REFERENCE_ORIGIN 0x1p-46       /* relative to the largest coordinate of patch and origin */
#define REFERENCE_SAME_POINT 0x1p-40   /* two border hits within this, relative in t, are one point of a shared edge */

enum reference_verdict { REFERENCE_MISS, REFERENCE_HIT, REFERENCE_GRAZING };

enum { REFERENCE_NONE = UINT32_MAX };

struct reference_answer {
  enum reference_verdict verdict;
  /* REFERENCE_GRAZING: nothing is hit before this t (in units of |direction|). Otherwise equal to t. */
  double t_first;
  /* The nearest proven hit: with REFERENCE_HIT the answer, with REFERENCE_GRAZING an upper bound of it. If there is
   * none, patch is REFERENCE_NONE, and the rest is not written. */
  uint32_t patch;
  quad t, u, v;    /* t in units of |direction|; u, v in [0,1] except for the radius */
  double radius;   /* bound on the error of u and v */
  double t_radius; /* bound on the error of t */
  bool shared;     /* on an edge shared with another patch: patch, u, v may be those of the neighbour */
};

struct reference;

/* Copies the `count` nets P[patch][i][j][xyz] (i = u across rows, j = v along a row), and borrows nothing. NULL if
 * memory is short. */
struct reference *reference_create(const double (*P)[4][4][3], size_t count);
void reference_destroy(struct reference *reference);

/* The closest hit, t > 0, of the ray origin + t direction. The direction may have any length > 0. Any number of threads
 * may call it. */
void reference_closest(const struct reference *reference, const double origin[3], const double direction[3],
                       struct reference_answer *out);

/* The net of a patch; it lives as long as the reference. */
const double (*reference_net(const struct reference *reference, uint32_t patch))[4][3];

/* ---- all common zeros of a(u,v) and b(u,v) on one patch (search.c) ---- */

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
