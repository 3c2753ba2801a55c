/* One root at a time: an iteration finds it, division takes it out, the rest has the next. Internal to src/algebra. */
#ifndef PSCN_ALGEBRA_DEFLATION_H
#define PSCN_ALGEBRA_DEFLATION_H

#include "algebra/root_problem.h"

/* What an iteration is told of a polynomial of degree n at the point x. */
struct local_view {
  int degree;
  struct complex_number slope;     /* p'/p */
  struct complex_number curvature; /* (p'/p)^2 - p''/p; 0 where the method does not ask for it */
};

/* An iteration: its step, to be added to x (it need not be finite), and whether it looks at the curvature. */
struct deflation_method {
  struct complex_number (*step)(const struct local_view *view);
  bool curved;
};

/* Eq 7 and eq 8 of the paper. */
extern const struct deflation_method newton_method, laguerre_method;

/* Finds roots of the problem by `method`, with deflation after each: a real root by its linear factor, a complex one
 * with its conjugate by their real quadratic (section 3.1 of the paper). Ends when there are `wanted` of them (a
 * conjugate may be one more). They are in the order in which they were found. */
void deflation_find(const struct root_problem *problem, const struct solver_options *options,
                    const struct solver_warm *warm, const struct deflation_method *method, int wanted,
                    struct root_estimates *out);

/* c divided by x - a; c has degree n, the quotient n - 1. The remainder is dropped. */
void deflation_divide_linear(enum deflation how, int n, double c[], double a);

/* c divided by x^2 - sum x + product; c has degree n >= 2, the quotient n - 2. */
void deflation_divide_quadratic(enum deflation how, int n, double c[], double sum, double product);

#endif
