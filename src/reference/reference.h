/* The reference: the closest hit of a ray and a list of bicubic Bezier patches, with a guarantee.
 *
 * For tests and the chart. Shares no code and no method with the renderer: no resultant, no roots of polynomials in one
 * variable. The ray is the line common to two planes, so each patch becomes two bicubic functions a(u,v), b(u,v). Boxes
 * of the (u,v) square are halved; a box is
 * - dropped when the hull of its Bernstein coefficients (of a linear combination of a and b) excludes zero,
 * - settled when a preconditioned Jacobian stays within 1/2 of the identity (at most one root in the box: injectivity
 *   by diagonal dominance) and the root Newton's method finds is proven by Krawczyk's test in quadruple precision.
 * Double precision with running error bounds does the dropping; wherever the bound is no longer small beside the
 * variation in the box, the box is cut anew out of the quadruple-precision net. Inputs are exact: the doubles as they
 * stand.
 *
 * What is guaranteed (magnitudes of the data between 1e-60 and 1e60):
 * REFERENCE_HIT      there is a hit at t, to within t_radius, and no hit before it;
 * REFERENCE_MISS     there is no hit with t > 0;
 * REFERENCE_GRAZING  undecided, for one of three reasons:
 *                    (1) a box of REFERENCE_SMALLEST_BOX a side (or more boxes than a budget allows) cannot be settled:
 *                        a double root, a collapsed edge met exactly, a curve in common;
 *                    (2) the hit lies within REFERENCE_BORDER of the border of its patch and no other patch shares it;
 *                    (3) the hit lies at the ray's origin, within REFERENCE_ORIGIN times the size of the data.
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
  /* REFERENCE_GRAZING: nothing is hit before this t (units of |direction|). Otherwise equal to t. */
  double t_first;
  /* The nearest proven hit: with REFERENCE_HIT the answer, with REFERENCE_GRAZING an upper bound of it. patch is
   * REFERENCE_NONE where there is none, and then the rest is not written. */
  uint32_t patch;
  quad t, u, v;    /* t in units of |direction|; u, v in [0,1] but for the radius */
  double radius;   /* bound on the error of u and v */
  double t_radius; /* bound on the error of t */
  bool shared;     /* at an edge that another patch has too: patch, u, v may be the neighbour's */
};

struct reference;

/* Borrows nothing: the `count` nets P[patch][i][j][xyz] (i = u across rows, j = v along a row) are copied.
 * NULL where memory is short. */
struct reference *reference_create(const double (*P)[4][4][3], size_t count);
void reference_destroy(struct reference *reference);

/* The closest hit of the ray origin + t direction, t > 0. The direction may have any length > 0. Any number of
 * threads. */
void reference_closest(const struct reference *reference, const double origin[3], const double direction[3],
                       struct reference_answer *out);

/* The net of a patch, as long as the reference lives. */
const double (*reference_net(const struct reference *reference, uint32_t patch))[4][3];

#endif
