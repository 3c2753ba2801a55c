/* One root at a time: an iteration finds it, and division takes it out of the polynomial. Internal to src/algebra. */
#ifndef PSCN_ALGEBRA_DEFLATION_H
#define PSCN_ALGEBRA_DEFLATION_H

#include "algebra/root_problem.h"

/* The values at the point x, of a polynomial p of degree n, that an iteration may use. */
struct local_view {
  int degree;
  struct complex_number slope;     /* p'/p */
  struct complex_number curvature; /* (p'/p)^2 - p''/p; 0 for a method that does not ask for it */
};

/* An iteration: its step, to be added to x (it need not be finite), and whether it uses the curvature. */
struct deflation_method {
  struct complex_number (*step)(const struct local_view *view);
  bool curved;
};

/* Eq 7 and eq 8 of the paper. */
extern const struct deflation_method newton_method, laguerre_method;

/* Finds roots of the problem by `method`, with deflation after each: a real root by its linear factor, a complex one
 * and its conjugate by their real quadratic (section 3.1 of the paper). Ends when it has `wanted` roots; a conjugate
 * may be one more. The roots are in the order in which they were found. */
void deflation_find(const struct root_problem *problem, const struct solver_options *options,
                    const struct solver_warm *warm, const struct deflation_method *method, int wanted,
                    struct root_estimates *out);

/* Divides c, of degree n, by x - a. The quotient has degree n - 1; the remainder is dropped. */
void deflation_divide_linear(enum deflation how, int n, double c[], double a);

/* Divides c, of degree n >= 2, by x^2 - sum x + product. The quotient has degree n - 2. */
void deflation_divide_quadratic(enum deflation how, int n, double c[], double sum, double product);

#endif
