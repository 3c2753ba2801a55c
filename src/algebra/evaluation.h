/* A polynomial prepared for evaluation at many points, with a bound on the error of every value. Internal to
 * src/algebra.
 *
 * Charts. In either basis the polynomial is a plain one, q, of one variable: q(u) itself in the power basis, and q(x)
 * with x = u/(1-u) in scaled Bernstein form, because p(u) = (1-u)^n q(x). Where the variable is larger than 1 in
 * modulus, the reversed polynomial in its reciprocal is used, so no power ever overflows. The chart variable z always
 * has |z| <= 1 (up to rounding).
 *
 * Bounds. A complex product has a relative error below sqrt(5) U, a sum below U (U = 2^-53). c[k] passes k products and
 * k + 1 sums, so it contributes at most (3.24 k + 1) U |c[k]| |z|^k of error. The weights (4 k + 2) U |c[k]| leave room
 * for the rounding of the bound itself, and for |z| exceeding its true value by a few U. The derivative is computed by
 * the same operations, so the derivative of the bound polynomial bounds its error.
 */
#ifndef PSCN_ALGEBRA_EVALUATION_H
#define PSCN_ALGEBRA_EVALUATION_H

#include <math.h>
#include <stdbool.h>
#include <stddef.h>

#include "algebra/complex_number.h"
#include "algebra/polynomial.h"
#include "base/real.h"

/* Room for rounding in sums of positive bounds (over 200 operations). */
#define BOUND_ROOM (1.0 + 0x1p-44)

/* All underflow in one evaluation of coefficients scaled to at most 1: fewer than 65 * 65 * 16 operations, 2^-1074
 * each. */
#define UNDERFLOW_ERROR 0x1p-1057

struct evaluation {
  int degree;
  enum basis basis;
  double forward[POLYNOMIAL_MAX_DEGREE + 1]; /* ascending powers of x */
  double reverse[POLYNOMIAL_MAX_DEGREE + 1]; /* ascending powers of 1/x */
  double forward_bound[POLYNOMIAL_MAX_DEGREE + 1];
  double reverse_bound[POLYNOMIAL_MAX_DEGREE + 1];
};

/* Room in a caller's bound for the rounding of the sums that use it: 2^-40 relative, over 4000 roundings. */
#define CALLER_BOUND_ROOM (1.0 + 0x1p-40)

/* `error` may be NULL. */
static inline void evaluation_prepare(int degree, enum basis basis, const double c[], const double error[],
                                      struct evaluation *out)
{
  out->degree = degree;
  out->basis = basis;
  for (int k = 0; k <= degree; k++) {
    const double given = error == NULL ? 0.0 : error[k] * CALLER_BOUND_ROOM;
    const double size = fabs(c[k]) * UNIT_ROUNDOFF;
    const int back = degree - k;
    out->forward[k] = out->reverse[back] = c[k];
    out->forward_bound[k] = (4 * k + 2) * size + given;
    out->reverse_bound[back] = (4 * back + 2) * size + given;
  }
}

/* q and q' of the chart polynomial at a real chart point z, and bounds on their errors. `reversed`: z is 1/x. */
struct evaluation_real {
  double value, slope, error, slope_error;
};

static inline struct evaluation_real evaluation_at_real(const struct evaluation *p, double z, bool reversed)
{
  const double *c = reversed ? p->reverse : p->forward;
  const double *bound = reversed ? p->reverse_bound : p->forward_bound;
  const double modulus = fabs(z);
  struct evaluation_real out = {.value = c[p->degree], .error = bound[p->degree]};
  for (int k = p->degree - 1; k >= 0; k--) {
    out.slope = out.slope * z + out.value;
    out.value = out.value * z + c[k];
    out.slope_error = out.slope_error * modulus + out.error;
    out.error = out.error * modulus + bound[k];
  }
  out.error += UNDERFLOW_ERROR;
  out.slope_error += UNDERFLOW_ERROR;
  return out;
}

/* q of the chart polynomial at the chart point z of x: x, or 1/x where |x|^2 > reversed_above, and a bound on the error
 * of q. The error of z is included: 8 U, which is 8 k U in the term of z^k, at most twice the term's weight in the
 * bound. */
struct evaluation_complex {
  struct complex_number z, value;
  double error;
  bool reversed;
};

static inline struct evaluation_complex evaluation_at_complex(const struct evaluation *p, struct complex_number x,
                                                              double reversed_above)
{
  const bool reversed = !(complex_norm(x) <= reversed_above);
  const struct complex_number z = reversed ? complex_divide((struct complex_number){1.0, 0.0}, x) : x;
  const double *c = reversed ? p->reverse : p->forward;
  const double *weight = reversed ? p->reverse_bound : p->forward_bound;
  const double modulus = hypot(z.re, z.im) * (1.0 + 4 * UNIT_ROUNDOFF);
  struct evaluation_complex out = {z, {c[p->degree], 0.0}, weight[p->degree], reversed};
  for (int k = p->degree - 1; k >= 0; k--) {
    out.value = complex_multiply(out.value, z);
    out.value.re += c[k];
    out.error = out.error * modulus + weight[k];
  }
  out.error = 3.0 * (out.error + UNDERFLOW_ERROR);
  return out;
}

#endif
