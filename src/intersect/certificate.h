/* The certificate: the Newton-Kantorovich test, on which every answer that is called certain stands.
 *
 * Theorem. Let f be a pair of polynomials, known up to `error` in each value (which beside [0,1]^2 is more than in each
 * coefficient), J its Jacobian as computed, z the last point but one of Newton's method, M the computed inverse of J(z),
 * step = |M f(z)| the length of the last step, and size_k what rounding adds to the k-th parameter's step: `error` times the
 * sum of the sizes in that row of M, or, what may be less by a factor of sqrt 2, times the row's Euclidean length. Let
 * bend_k be a Lipschitz bound of that row of M J on a convex region that holds the ball of radius 2 (step + size) about z,
 * and so all within CERTIFICATE_REACH of where the step went. Norms of parameter vectors are maximum norms; what has no
 * index is the larger one of both rows. Where
 *
 *     bend (step + size) <= CERTIFICATE_BEND,   step <= CERTIFICATE_STEP   and   size <= CERTIFICATE_SIZE
 *
 * there is exactly one root of the exact f in that ball, and each of its parameters lies within
 *
 *     2 bend_k reach^2 + 2 size_k,   reach = step + size,
 *
 * of where the step went. Where bend_k and size_k are the length of the row times what all rows share, reach = step will
 * do; seen edge-on, a row with little error but much bend stands beside one with little bend but much error.
 *
 * Proof. What rounding adds is sqrt 2 size_k at most. The map w -> w - M f(w) moves z by at most beta = step +
 * sqrt 2 size and has a derivative of at most kappa + bend |w - z|, where kappa is what rounding leaves of M J(z) - 1:
 * derivatives of Bernstein forms are differences of coefficients times 3, so they and their sums are off by no more than
 * 16 times the error of a value, and kappa <= 16 sqrt 2 size <= 1/45. bend beta is at most sqrt 2/8 <= 0.177. So the map
 * takes the ball of radius 1.4 beta, which is within the other, into itself (1 + 1.4/45 + 0.177 1.4^2/2 < 1.4), and in
 * the other, which is within that of radius 2 beta, it contracts (1/45 + 2 0.177 < 1): one root, by Banach. That one, at
 * distance r <= beta + kappa r + bend r^2/2, is within 1.15 beta of z, less than 2^-9; and where the step went it is, in
 * row k, off by 1.42 size_k for the values, by kappa_k r <= 0.05 size_k, and by bend_k r^2/2 <= 0.67 bend_k beta^2 <=
 * 1.34 bend_k reach^2: less than the bound. Where rows share what they are multiplied by, bend_k size = bend size_k, and
 * the last is no more than 0.67 bend_k step^2 + 1.9 bend (step + size) size_k, with 1.9/8 = 0.24. Compare Ortega and
 * Rheinboldt, Iterative Solution of Nonlinear Equations, 12.6.
 *
 * That no second root exists in a region is a matter of its own: M J, averaged on the way from the root to any point
 * of it, is not singular. It is 1 + E, where |E_kl| is at most what the length of row k of M is times what column l of J
 * is off by, and then its determinant is no less than 1 - |E_11| - |E_22|, for the products of these with each other and
 * of |E_12| with |E_21| are one; or E is less than 1 in the maximum norm. Let q bound twice what second derivatives make of
 * that sum, or norm, from where the step went, and be no more than CERTIFICATE_ALONE with CERTIFICATE_SECOND size. Half of
 * that is 0.95. What is not in it, and is no more in the sum than in the norm:
 * second derivatives are differences of coefficients times 24, 36 and 24, each off by the error of a value, twice over
 * for the mixed one, 170 size for 144 of which the half is 13 size; M J at the root, off from M J(z) by bend r <= 6.2 size +
 * 2^-13, where as much of bend as is in that sum, or norm, is at most 2 q <= 3.8; and kappa. Together that is less than 0.05:
 * less than 1.
 *
 * Nor is it where a border is one point, a pole, though J is singular along it. Let d be the distance from that border, e
 * the other parameter. As f is constant along the border, f(d,e) - f(d',e') is the mean of f_d from (d',e') to (d,e') times
 * d - d', and d times the mean of g from (d,e') to (d,e) times e - e', where g = f_e / d is the mean of f_de from the border
 * to there. Where the matrix of these two means, times M, is not singular, for the root (d',e') and all points with d >= 0,
 * there is no other root, nor one on the border. Its rows times M are those of M, that of e times d', and second derivatives
 * make of it twice what they make of f_d, and f_dde and f_dee of g:
 *
 *     q = size_d f_dd reach_d + d' size_e (f_dde reach_d + f_dee reach_e)
 *
 * with bounds of these derivatives and `size` for the lengths of M's rows. Nor does the root lie where the step went: on that
 * way, of less than 1.7 (step + size) with the errors' size, f_d turns by f_dd and f_de, and g by f_dde and f_dee; both count
 * twice against q, and once for the reaches. Rounding: third derivatives are differences of coefficients times 144, together
 * with second ones (24 and 144 + 144) sqrt 2 size for q; f_d and f_e are off by 16, twice, and d g is f_e at the root, so that
 * the row of e, times d', has back what d has divided it by: 93 size; outside the leaf that is up to 2.3 times
 * as much, for which CERTIFICATE_POLE has room. And d' is d of the last point but one but for the step and the radius: twice
 * these, `far`, over the least of both, `left`.
 *
 * Works on doubles and on lanes alike.
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

/* How far it may be from where the last step went, in the parameter of the row. */
#define certificate_radius(row_bend, reach, row_size) (2 * (row_bend) * (reach) * (reach) + 2 * (row_size))

/* Whether it is the only one. */
#define certificate_alone(q, size) ((q) + CERTIFICATE_SECOND * (size) < CERTIFICATE_ALONE)

/* Whether it is, near a pole. `turn`: what f_d and g turn by on a way of length 1, times the rows' lengths. */
#define CERTIFICATE_POLE 1280
#define certificate_alone_at_pole(q, turn, step, size, far, left) \
  ((q) + 6 * (turn) * ((step) + (size)) + 2 * (far) / (left) + CERTIFICATE_POLE * (size) < CERTIFICATE_ALONE)

#endif
