/* Error bounds of a resultant's coefficients.
 *
 * Internal to src/intersect.
 */
#ifndef PSCN_INTERSECT_RESULTANT_ERROR_H
#define PSCN_INTERSECT_RESULTANT_ERROR_H

#include "intersect/model.h"

/* |Bernstein coefficient of r| <= RESULTANT_WEIGHT[n] (alpha beta)^n for nets with |a| <= alpha, |b| <= beta, their
 * errors included, and n eliminated. For a minor [kl] is at most 2 C(n,k) C(n,l) alpha beta (Vandermonde's convolution
 * sums the rest to 1), and the determinant is a sum of products of minors. A coefficient of r passes at most
 * RESULTANT_ROUNDINGS roundings: scaling 4, a minor 9 (8 products summed), cofactor 2 x 13 + 8, determinant 13 + 34 +
 * 9. So it is off by at most
 *
 *     RESULTANT_WEIGHT[n] (alpha beta)^n (RESULTANT_ROUNDINGS UNIT_ROUNDOFF + n error (1/alpha + 1/beta)). */
static const double RESULTANT_WEIGHT[4] = {0, 2, 20, 1376};
#define RESULTANT_ROUNDINGS 64

/* That bound, for power = (alpha beta)^n. Works on doubles and on lanes alike. */
#define RESULTANT_ERROR(n, power, alpha, beta, error) \
  (RESULTANT_WEIGHT[n] * (power) * (RESULTANT_ROUNDINGS * UNIT_ROUNDOFF + (n) * (error) * (1 / (alpha) + 1 / (beta))))

#endif
