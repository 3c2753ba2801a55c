/* The input of the table's solvers, and their output. Internal to src/algebra.
 *
 * solver_solve scales the polynomial (largest coefficient in [1/2, 1)), takes out the roots that zero coefficients at
 * its ends show, and leaves the rest: a polynomial q in x of degree 1 or more, with c[0] and c[degree] not zero. In the
 * power basis x = u, in a unit that solver_solve has chosen. In scaled Bernstein form x = u/(1-u), and the same numbers
 * c are the scaled Bernstein coefficients in u.
 *
 * A solver estimates roots in u. validation.c judges the estimates afterwards, from the polynomial.
 */
#ifndef PSCN_ALGEBRA_ROOT_PROBLEM_H
#define PSCN_ALGEBRA_ROOT_PROBLEM_H

#include "algebra/evaluation.h"
#include "algebra/solver.h"

struct root_problem {
  int degree;
  enum basis basis;
  double c[POLYNOMIAL_MAX_DEGREE + 1];     /* ascending powers of x */
  double error[POLYNOMIAL_MAX_DEGREE + 1]; /* absolute bounds on the coefficients, all 0 where exact */
};

struct root_estimates {
  int count;
  double re[POLYNOMIAL_MAX_DEGREE], im[POLYNOMIAL_MAX_DEGREE]; /* in u; not finite means infinity */
  int iterations[POLYNOMIAL_MAX_DEGREE];
  bool converged[POLYNOMIAL_MAX_DEGREE]; /* the stopping rule was met, not the iteration limit */
  bool cluster[POLYNOMIAL_MAX_DEGREE];   /* of unknown multiplicity, or a pair that may not be real */
  double reach[POLYNOMIAL_MAX_DEGREE];   /* how far away, in u, the roots that it stands for may be */
};

/* `stop rounding`: the rounding bound of |p| is never sharp, so below it steps go on while they shrink. A step not
 * shorter than the last is noise. After a step that has shrunk by this much (its square against the last one's), the
 * next would be noise. */
#define STEEP_FALL 1e-4

/* |x|^2 above which values are computed in powers of 1/x: 1, or with plain Horner as far as |x|^n does not overflow. */
static inline double root_problem_reversed_above(const struct solver_options *options, int degree)
{
  return options->horner == HORNER_CHARTS ? 1.0 : exp2(fmin(1600.0 / degree, 900.0));
}

/* Convert x to u, and u to x. The point at infinity of either comes out infinite or NaN. */
static inline void root_problem_u_from_x(enum basis basis, double *re, double *im)
{
  if (basis == BASIS_POWER) return;
  const double x = *re, y = *im;
  if (fabs(x) + fabs(y) < 1.0) { /* x / (1 + x) */
    const double d = (1.0 + x) * (1.0 + x) + y * y;
    *re = (x * (1.0 + x) + y * y) / d;
    *im = y / d;
  } else { /* 1 - 1/(1 + x), which keeps 1 - u accurate */
    const double scale = fabs(1.0 + x) + fabs(y);
    const double a = (1.0 + x) / scale, b = y / scale;
    const double d = (a * a + b * b) * scale;
    *re = 1.0 - a / d;
    *im = b / d;
  }
}

static inline void root_problem_x_from_u(enum basis basis, double *re, double *im)
{
  if (basis == BASIS_POWER) return;
  const double a = 1.0 - *re, b = -*im; /* 1 - u */
  const double d = a * a + b * b;
  const double x = (*re * a + *im * b) / d;
  *im = *im / d;
  *re = x;
}

/* |u|^2 at x, and |step|^2 in u of a step from x: du = dx / ((1 + x) (1 + x + dx)) in Bernstein form. */
static inline double root_problem_square_in_u(enum basis basis, struct complex_number x)
{
  const double square = complex_norm(x);
  if (basis == BASIS_POWER) return square;
  x.re += 1.0;
  return square / complex_norm(x);
}

static inline double root_problem_step_in_u(enum basis basis, struct complex_number x, struct complex_number step)
{
  if (basis == BASIS_POWER) return complex_norm(step);
  x.re += 1.0;
  return complex_norm(step) / (complex_norm(x) * complex_norm(complex_add(x, step)));
}

/* Tells the watcher, if there is one, that a root is now at x. */
static inline void root_problem_tell(const struct solver_options *options, enum basis basis, int root, int step,
                                     double re, double im)
{
  if (options->watch == NULL) return;
  root_problem_u_from_x(basis, &re, &im);
  options->watch->tell(options->watch->context, root, step, re, im);
}

/* The table of solvers. A row is: name (NAME_find is the method), summary, real roots in [0,1] only, form on lanes,
 * steps allowed per root. The first is the default. */
#define SOLVERS(ROW)                                                                                                   \
  ROW(bernstein, "real roots in [0,1] by sign variations in Bernstein form and bracketed Newton", true, SIGNS, 64)     \
  ROW(newton, "one root after the other by Newton-Raphson, with deflation (eq 7 of the paper)", false, NEWTON, 200)    \
  ROW(laguerre, "one root after the other by Laguerre's method, with deflation (eq 8 of the paper)", false, LAGUERRE,  \
      100)                                                                                                             \
  ROW(aberth, "all roots at once by Aberth's method (eq 9 of the paper)", false, ABERTH, 100)                          \
  ROW(durand_kerner, "all roots at once by Weierstrass's method: Aberth's without a derivative", false, DURAND_KERNER, \
      200)

#define SOLVER_FIND(name, summary, real_only, lanes, steps)                                  \
  void name##_find(const struct root_problem *problem, const struct solver_options *options, \
                   const struct solver_warm *warm, struct root_estimates *out);
SOLVERS(SOLVER_FIND)
#undef SOLVER_FIND

/* Adds an estimate, or drops it if there is no room. */
static inline void root_estimates_add(struct root_estimates *out, double re, double im, int iterations, bool converged,
                                      bool cluster)
{
  if (out->count < POLYNOMIAL_MAX_DEGREE) {
    out->re[out->count] = re;
    out->im[out->count] = im;
    out->iterations[out->count] = iterations;
    out->converged[out->count] = converged;
    out->cluster[out->count] = cluster;
    out->reach[out->count] = 0.0;
    out->count++;
  }
}

/* Judges the roots from number `exact` on, which are the estimates for the roots of p. Sets their radius, status and im
 * from the polynomial and its coefficient errors, and drops those that cannot be told from infinity. On entry, status
 * is the solver's and radius the reach of the estimate. `all_sought`: there should be a value for every root. */
void validation_judge(const struct evaluation *p, bool all_sought, int exact, struct root_set *roots);

#endif
