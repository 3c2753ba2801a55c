/* What tests ask of a hit besides the reference's answer: its normal, how far rounding can move it, how far an answer
 * is from ray and surface. In quadruple precision, with nothing of the renderer's. Any thread.
 */
#ifndef PSCN_REFERENCE_FACTS_H
#define PSCN_REFERENCE_FACTS_H

#include "reference/reference.h"

/* How far rounding alone can move a hit: a first-order bound.
 *
 * S(u,v) - o - t d = 0 is solved in double with residuals known only to `terms` units of rounding, so (u,v,t) moves
 * by at most |[S_u S_v -d]^-1| (2^-53 terms), entry by entry, and each result is rounded once. Two choices of terms:
 * data:  sum B_i B_j |P_ij| + |o| + |t d|   every input coordinate changed by one rounding;
 * whole: max |P_ij - S|                     the origin moved to the hit first, exactly: roundings of the patch's extent. */
struct facts_floor {
  double t, u, v;
};

/* Of a hit, or of what lies next to one. */
struct facts {
  bool has_normal;  /* false if S_u x S_v vanishes (a collapsed pole) */
  double normal[3]; /* unit, facing the origin */
  double incidence; /* |normal . direction| / |direction|: 0 is tangent */
  struct facts_floor data, whole;
};
void facts_find(const double P[4][4][3], const double origin[3], const double direction[3], quad t, quad u, quad v,
                struct facts *out);

/* |S(u,v) - (origin + t direction)|, each difference in quadruple precision: how far an answer of any program is from
 * being a common point of ray and patch. */
double facts_residual(const double P[4][4][3], const double origin[3], const double direction[3], double t, double u,
                      double v);

/* Of a vector, from one end of the doubles to the other: no square is formed. */
double facts_length(const double a[3]);

#endif
