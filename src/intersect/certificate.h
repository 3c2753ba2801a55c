/* The certificate: the Newton-Kantorovich test, by which the lanes prove each root that they take.
 *
 * Theorem. Let f be a pair of polynomials whose values are known up to `error` (beside [0,1]^2 this is more than the
 * error of the coefficients), J its Jacobian as computed, z the last point but one of Newton's method, M the computed
 * inverse of J(z), and step = |M f(z)| the length of the last step. Let size_k be what rounding adds to the step in the
 * k-th parameter: `error` times the sum of the sizes in that row of M, or times the row's Euclidean length, which may
 * be less by a factor of sqrt 2. Let bend_k be a Lipschitz bound of that row of M J on a convex region that holds the
 * ball of radius 2 (step + size) about z; the ball lies within CERTIFICATE_REACH of where the step went. Norms of
 * parameter vectors are maximum norms. A symbol without an index is the larger one of both rows. If
 *
 *     bend (step + size) <= CERTIFICATE_BEND,   step <= CERTIFICATE_STEP   and   size <= CERTIFICATE_SIZE
 *
 * there is exactly one root of the exact f in that ball, and each of its parameters lies within
 *
 *     2 bend_k reach^2 + 2 size_k,   reach = step + size,
 *
 * of where the step went. If bend_k and size_k are the length of the row times a factor that all rows share, reach =
 * step is enough. In general it is not: seen edge-on, a row with little error and much bend stands beside one with
 * little bend and much error.
 *
 * Proof. Rounding adds at most sqrt 2 size_k. The map w -> w - M f(w) moves z by at most beta = step + sqrt 2 size and
 * has a derivative of at most kappa + bend |w - z|, where kappa is what rounding leaves of M J(z) - 1. Derivatives of
 * Bernstein forms are differences of coefficients times 3; so they and their sums are off by at most 16 times the error
 * of a value, and kappa <= 16 sqrt 2 size <= 1/45. bend beta is at most sqrt 2/8 <= 0.177. So the map takes the ball of
 * radius 1.4 beta, which lies within the other one, into itself (1 + 1.4/45 + 0.177 1.4^2/2 < 1.4). In the other ball,
 * which lies within that of radius 2 beta, it contracts (1/45 + 2 0.177 < 1): one root, by Banach. The root is at a
 * distance r <= beta + kappa r + bend r^2/2, so within 1.15 beta of z, which is less than 2^-9. From where the step
 * went it is off, in row k, by 1.42 size_k for the values, by kappa_k r <= 0.05 size_k, and by bend_k r^2/2 <= 0.67
 * bend_k beta^2 <= 1.34 bend_k reach^2: less than the bound. If rows share their factors, bend_k size = bend size_k,
 * and the last term is at most 0.67 bend_k step^2 + 1.9 bend (step + size) size_k, with 1.9/8 = 0.24. Compare Ortega
 * and Rheinboldt, Iterative Solution of Nonlinear Equations, 12.6.
 *
 * Alone. A region has no second root if M J, averaged on the way from the root to any point of the region, is not
 * singular. That average is 1 + E, where |E_kl| is at most the length of row k of M times what column l of J is off by.
 * Its determinant is then at least 1 - |E_11| - |E_22|, because the bounds' products for E_11 E_22 and for E_12 E_21
 * are equal; or E is less than 1 in the maximum norm. Let q bound twice what second derivatives, from where the step
 * went, contribute to that sum or norm, and let q + CERTIFICATE_SECOND size be at most CERTIFICATE_ALONE. Half of that
 * is 0.95. The rest is not in q, and is no more in the sum than in the norm:
 * - Second derivatives are differences of coefficients times 24, 36 and 24, each off by the error of a value, the mixed
 *   one counted twice: 170 size where 144 are counted; half of the difference is 13 size.
 * - M J at the root is off from M J(z) by bend r <= 6.2 size + 2^-13, since the part of bend in that sum or norm is at
 *   most 2 q <= 3.8.
 * - kappa.
 * Together that is less than 0.05, so all is less than 1.
 *
 * All macros work on doubles and on lanes.
 */
#ifndef PSCN_INTERSECT_CERTIFICATE_H
#define PSCN_INTERSECT_CERTIFICATE_H

#define CERTIFICATE_BEND 0.125
#define CERTIFICATE_STEP 0x1p-16
#define CERTIFICATE_SIZE 0x1p-10
#define CERTIFICATE_REACH (3 * CERTIFICATE_STEP + 2 * CERTIFICATE_SIZE)
#define CERTIFICATE_ALONE 1.9
#define CERTIFICATE_SECOND 144

/* Whether the root exists. */
#define certificate_holds(bend, step, size) \
  (((bend) * ((step) + (size)) <= CERTIFICATE_BEND) & ((step) <= CERTIFICATE_STEP) & ((size) <= CERTIFICATE_SIZE))

/* How far the root may be from where the last step went, in the parameter of the row. */
#define certificate_radius(row_bend, reach, row_size) (2 * (row_bend) * (reach) * (reach) + 2 * (row_size))

/* Whether the root is alone. */
#define certificate_alone(q, size) ((q) + CERTIFICATE_SECOND * (size) < CERTIFICATE_ALONE)

#endif
