/* The certificate: the Newton-Kantorovich test, on which every answer that is called certain stands.
 *
 * Theorem. Let f be a pair of polynomials on a convex region, known up to `error` in each value, J its Jacobian as
 * computed, z the last point but one of Newton's process, M the computed inverse of J(z), step = |M f(z)| the length
 * of the last step, at most 1/32 (all who ask end far below), size = |M| error what rounding adds to it, and bend a
 * Lipschitz bound of M J on the region. Norms of parameter vectors are maximum norms; what has an index k is of the
 * k-th parameter's row of M alone. Where
 *
 *     bend (step + size) <= CERTIFICATE_BEND   and   size <= CERTIFICATE_SIZE
 *
 * there is exactly one root of the exact f within 2 (step + size) of z, and each of its parameters lies within
 *
 *     2 bend_k reach^2 + 2 size_k,   reach = step + size,
 *
 * of where the step went. Where bend_k and size_k are the length of the row times what all rows share, reach = step will
 * do; seen edge-on, a row with little error but much bend stands beside one with little bend but much error.
 *
 * Proof. The map w -> w - M f(w) moves z by at most beta = step + size and has a derivative of at most
 * kappa + bend |w - z|, where kappa is what rounding leaves of M J(z) - 1: derivatives of Bernstein forms are
 * differences of coefficients times 3, so they and their sums are off by no more than 16 times the error of a value,
 * and kappa <= 16 size <= 1/64. So it maps the ball of radius 2 beta into itself (beta (1 + 1/32 + 1/4) < 2 beta) and
 * contracts there (1/64 + 1/4 < 1): one root, by Banach. That one, at distance r <= beta (1 + kappa r/beta + bend
 * r^2/(2 beta)), is within 1.2 beta of z; and where the step went it is, in row k, off by size_k for the values,
 * kappa_k r <= 0.62 size_k and bend_k r^2/2 <= 0.72 bend_k beta^2, that is by less than the bound. Where rows share what
 * they are multiplied by, bend_k size^2 = bend size size_k <= size_k/8, and the last is no more than 1.44 bend_k step^2 +
 * 0.18 size_k. Compare Ortega and Rheinboldt, Iterative Solution of Nonlinear Equations, 12.6.
 *
 * That no second root exists in a region is a matter of its own: M J, averaged on the way from the root to any point
 * of it, differs from 1 by less than 1. Where q bounds twice what second derivatives make of that difference, and is no
 * more than CERTIFICATE_ALONE with what rounding makes of it (second derivatives are differences of coefficients times
 * 24, 36 and 24, each off by the error of a value, twice over for the mixed one), half of that is 0.95, kappa is 1/64,
 * and M J is within 2^-14 of what it is at the root where the last step was no longer than NEWTON_LAST_STEP: less than
 * 1.
 *
 * Works on doubles and on lanes alike.
 */
#ifndef PSCN_INTERSECT_CERTIFICATE_H
#define PSCN_INTERSECT_CERTIFICATE_H

#define CERTIFICATE_BEND 0.125
#define CERTIFICATE_SIZE 0x1p-10
#define CERTIFICATE_ALONE 1.9
#define CERTIFICATE_SECOND 144

/* Whether the root exists. */
#define certificate_holds(bend, step, size) \
  (((bend) * ((step) + (size)) <= CERTIFICATE_BEND) & ((size) <= CERTIFICATE_SIZE))

/* How far it may be from where the last step went, in the parameter of the row. */
#define certificate_radius(row_bend, reach, row_size) (2 * (row_bend) * (reach) * (reach) + 2 * (row_size))

/* Whether it is the only one. */
#define certificate_alone(q, size) ((q) + CERTIFICATE_SECOND * (size) < CERTIFICATE_ALONE)

#endif
