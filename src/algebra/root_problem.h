/* What the table's solvers are given, what they return, and what they share. Internal to src/algebra.
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
  int unit;                                /* of x and u: 2^unit in the caller's u; 0 in Bernstein form */
  double c[POLYNOMIAL_MAX_DEGREE + 1];     /* ascending powers of x */
  double error[POLYNOMIAL_MAX_DEGREE + 1]; /* absolute bounds on the coefficients, all 0 where exact */
};

/* A method: writes out->count and out->root. Estimates are in u; one that is not finite means infinity. Their radius is
 * how far away the roots may be that they stand for. ROOT_LIMIT: the iteration limit came before the stopping rule;
 * ROOT_CLUSTER: of unknown multiplicity, or a pair that may not be real. warm may be NULL. */
typedef void solver_method(const struct root_problem *problem, const struct solver_options *options,
                           const struct solver_warm *warm, struct root_set *out);
solver_method bernstein_find, newton_find, laguerre_find, durand_kerner_find, aberth_find_baseline, aberth_find_avx2;

/* Adds a root, or drops it if there is no room. */
static inline void root_set_add(struct root_set *out, struct root root)
{
  if (out->count < POLYNOMIAL_MAX_DEGREE) out->root[out->count++] = root;
}

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
static inline struct complex_number root_problem_u_from_x(enum basis basis, struct complex_number x)
{
  if (basis == BASIS_POWER) return x;
  if (fabs(x.re) + fabs(x.im) < 1.0) { /* x / (1 + x) */
    const double d = (1.0 + x.re) * (1.0 + x.re) + x.im * x.im;
    return (struct complex_number){(x.re * (1.0 + x.re) + x.im * x.im) / d, x.im / d};
  }
  /* 1 - 1/(1 + x), which keeps 1 - u accurate */
  const double scale = fabs(1.0 + x.re) + fabs(x.im);
  const double a = (1.0 + x.re) / scale, b = x.im / scale;
  const double d = (a * a + b * b) * scale;
  return (struct complex_number){1.0 - a / d, b / d};
}

static inline struct complex_number root_problem_x_from_u(enum basis basis, struct complex_number u)
{
  if (basis == BASIS_POWER) return u;
  const double a = 1.0 - u.re, b = -u.im; /* 1 - u */
  const double d = a * a + b * b;
  return (struct complex_number){(u.re * a + u.im * b) / d, u.im / d};
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
static inline void root_problem_tell(const struct root_problem *problem, const struct solver_options *options, int root,
                                     int step, struct complex_number x)
{
  if (options->watch == NULL) return;
  const struct complex_number u = root_problem_u_from_x(problem->basis, x);
  options->watch->tell(options->watch->context, root, step, ldexp(u.re, problem->unit), ldexp(u.im, problem->unit));
}

/* ---- start values (start.c) ---- */

/* Writes problem->degree distinct finite values in x: those of `warm`, if it holds that many (equal ones are moved
 * apart), otherwise new ones by `radii`. The first `wanted` of these are enough. warm may be NULL. */
void start_values(const struct root_problem *problem, enum radii radii, const struct solver_warm *warm, int wanted,
                  double out_re[], double out_im[]);

/* The geometric mean of the moduli of the roots, in x. */
double start_mean_modulus(const struct root_problem *problem);

/* ---- all roots at once: roots that are stuck ----
 *
 * Symmetric starts (real values seeking a complex pair, pairs seeking two real roots) would never part by themselves.
 * So every TURN_PERIOD sweeps, a step that is no shorter than STUCK times the step at the last look is turned, by an
 * angle that no two roots share. A choice of speed only.
 */
enum { TURN_PERIOD = 5 };
#define STUCK 0.9

/* Whether this sweep, counted from 1, looks for stuck roots. */
static inline bool turn_due(int sweep) { return sweep % TURN_PERIOD == 0; }

/* The step of root number `root`, with |step|^2 in u being `square`. It is turned where the step is no shorter than
 * STUCK times the one of `checked`, the square at the last look (infinite at first). */
static inline struct complex_number turn_if_stuck(int root, struct complex_number step, double square, double checked)
{
  if (!(square >= STUCK * STUCK * checked)) return step;
  const double angle = 0.3 + 0.37 * root;
  return complex_multiply(step, (struct complex_number){cos(angle), sin(angle)});
}

/* ---- one root at a time (deflation.c) ---- */

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
                    struct root_set *out);

/* Divides c, of degree n, by x - a. The quotient has degree n - 1; the remainder is dropped. */
void deflation_divide_linear(enum deflation how, int n, double c[], double a);

/* Divides c, of degree n >= 2, by x^2 - sum x + product. The quotient has degree n - 2. */
void deflation_divide_quadratic(enum deflation how, int n, double c[], double sum, double product);

/* ---- the judge (validation.c) ---- */

/* Judges the roots from number `exact` on, which are the estimates for the roots of p. Sets their radius, status and im
 * from the polynomial and its coefficient errors, and drops those that cannot be told from infinity. On entry, status
 * is the solver's and radius the reach of the estimate. `all_sought`: there should be a value for every root. */
void validation_judge(const struct evaluation *p, bool all_sought, int exact, struct root_set *roots);

#endif
