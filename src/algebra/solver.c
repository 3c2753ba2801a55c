/* The table of solvers, and what is done with every polynomial: it is scaled, stripped, solved and judged. */
#include "algebra/solver.h"

#include <float.h>
#include <limits.h>
#include <math.h>
#include <string.h>

#include "algebra/root_problem.h"
#include "base/kernel.h"

/* eps of eq 10, absolute in the unknown: the smallest at which the paper's plain iterations still stop, because values
 * of size 100 do not move by less. eps and the steps a root may take decide when to stop, never what is true: radii and
 * certificates are made afterwards. */
#define STOP_TOLERANCE 1e-12

/* aberth.c is compiled once per instruction set. */
static void aberth_find(const struct root_problem *problem, const struct solver_options *options,
                        const struct solver_warm *warm, struct root_set *out)
{
  KERNEL_BEST(aberth_find)(problem, options, warm, out);
}

/* The first is the default. */
static const struct solver solvers[] = {
  {"bernstein", "real roots in [0,1] by sign variations in Bernstein form and bracketed Newton", true,
   SOLVER_LANES_SIGNS, 64, bernstein_find},
  {"newton", "one root after the other by Newton-Raphson, with deflation (eq 7 of the paper)", false,
   SOLVER_LANES_NEWTON, 200, newton_find},
  {"laguerre", "one root after the other by Laguerre's method, with deflation (eq 8 of the paper)", false,
   SOLVER_LANES_LAGUERRE, 100, laguerre_find},
  {"aberth", "all roots at once by Aberth's method (eq 9 of the paper)", false, SOLVER_LANES_ABERTH, 100, aberth_find},
  {"durand_kerner", "all roots at once by Weierstrass's method: Aberth's without a derivative", false,
   SOLVER_LANES_DURAND_KERNER, 200, durand_kerner_find},
};

size_t solver_count(void) { return sizeof solvers / sizeof solvers[0]; }

const struct solver *solver_at(size_t index) { return index < solver_count() ? &solvers[index] : NULL; }

const struct solver *solver_find(const char *name, size_t length)
{
  for (size_t i = 0; i < solver_count(); i++)
    if (strlen(solvers[i].name) == length && memcmp(solvers[i].name, name, length) == 0) return &solvers[i];
  return NULL;
}

void solver_options_form(struct solver_options *options, bool improved)
{
  options->radii = improved ? RADII_POLYGON : RADII_CIRCLE;
  options->stop = improved ? STOP_ROUNDING : STOP_STEP;
  options->horner = improved ? HORNER_CHARTS : HORNER_PLAIN;
  options->update = improved ? UPDATE_GAUSS_SEIDEL : UPDATE_JACOBI;
  options->rest = improved;
  options->deflation = improved ? DEFLATION_COMPOSITE : DEFLATION_FORWARD;
  options->refine = improved;
}

static bool has_form(const struct solver_options *options, bool improved)
{
  struct solver_options form;
  solver_options_form(&form, improved);
  return options->radii == form.radii && options->stop == form.stop && options->horner == form.horner &&
         options->update == form.update && options->rest == form.rest && options->deflation == form.deflation &&
         options->refine == form.refine;
}

bool solver_options_improved(const struct solver_options *options) { return has_form(options, true); }

bool solver_options_paper(const struct solver_options *options) { return has_form(options, false); }

void solver_options_default(const struct solver *solver, struct solver_options *out)
{
  *out = (struct solver_options){
    .solver = solver, .tolerance = STOP_TOLERANCE, .max_iterations = solver->max_iterations, .start = START_COLD};
  solver_options_form(out, true);
}

/* Whether there is something to solve. If not, out says why. */
static bool worth_solving(const struct polynomial *p, struct root_set *out)
{
  bool finite = true, zero = true;
  for (int k = 0; k <= p->degree; k++) {
    const double error = p->error == NULL ? 0.0 : p->error[k];
    const double size = fabs(p->c[k]);
    finite = finite && size <= DBL_MAX && error >= 0.0 && error <= DBL_MAX;
    zero = zero && size <= error;
  }
  out->not_finite = !finite;
  out->identically_zero = finite && zero;
  return finite && !zero;
}

/* Whether the coefficients imply a root at the end `from` with a modulus beyond 2^exponent, or below 2^-exponent
 * near 0 (Newton's polygon): a coefficient k steps inwards is larger than |c[from]| by a factor of more than 2^(k
 * exponent). */
static bool end_is_beyond(double exponent, const double c[], int from, int inwards, int count)
{
  for (int k = 1; k <= count; k++)
    if (log2(fabs(c[from + inwards * k])) - log2(fabs(c[from])) > k * exponent) return true;
  return false;
}

/* A root with a modulus beyond 2^FARTHEST, or below its inverse, is no double. */
#define FARTHEST 1075.0

/* The exponent of the unit in which roots are sought: of x with u = 2^unit x. In powers of u the unit is next to the
 * mean modulus of the roots that are doubles, so no size of u makes values, their bounds or their squares overflow or
 * underflow. The paper's tolerance is in u, and [0,1] is an interval of u: for these the unit is 1, as in Bernstein
 * form. */
static int unit_of(const struct root_problem *problem, const struct solver_options *options)
{
  const double *c = problem->c;
  if (problem->basis != BASIS_POWER || options->stop == STOP_STEP || options->solver->real_only) return 0;
  int low = 0, high = problem->degree;
  while (low < high && end_is_beyond(FARTHEST, c, low, 1, high - low)) low++;
  while (high > low && end_is_beyond(FARTHEST, c, high, -1, high - low)) high--;
  const double mean = high == low ? 0.0 : (log2(fabs(c[low])) - log2(fabs(c[high]))) / (high - low);
  return isfinite(mean) ? (int)lrint(mean) : 0;
}

/* Changes to x in the unit of the problem, and scales by a power of two so that the largest coefficient lies in
 * [1/2, 1). */
static void scale_problem(struct root_problem *problem)
{
  const int unit = problem->unit;
  int largest = INT_MIN;
  for (int k = 0; k <= problem->degree; k++) {
    int exponent;
    (void)frexp(problem->c[k], &exponent);
    if (problem->c[k] != 0.0 && exponent + k * unit > largest) largest = exponent + k * unit;
  }
  for (int k = 0; k <= problem->degree; k++) {
    const int exponent = k * unit - largest;
    const double c = problem->c[k], error = problem->error[k];
    problem->c[k] = ldexp(c, exponent);
    problem->error[k] = ldexp(error, exponent) * (1.0 + DBL_EPSILON);
    if (error > 0.0 || ldexp(problem->c[k], -exponent) != c)
      problem->error[k] += 2 * DBL_TRUE_MIN; /* what underflow may have lost */
  }
}

/* Cuts off the first `low` coefficients and those behind `high`. */
static void cut_problem(struct root_problem *problem, int low, int high)
{
  problem->degree = high - low;
  memmove(problem->c, problem->c + low, sizeof problem->c[0] * (size_t)(high - low + 1));
  memmove(problem->error, problem->error + low, sizeof problem->error[0] * (size_t)(high - low + 1));
}

/* Takes out the exact roots at the ends of the coefficients: u = 0, and u = 1 (Bernstein) or infinity (power, not
 * listed). Returns how many are at infinity. */
static int strip_ends(struct root_problem *problem, struct root_set *out)
{
  int low = 0, high = problem->degree;
  while (low < high && problem->c[low] == 0.0 && problem->error[low] == 0.0) low++;
  while (high > low && problem->c[high] == 0.0 && problem->error[high] == 0.0) high--;
  const int above = problem->degree - high;
  for (int k = 0; k < low; k++) root_set_add(out, (struct root){.status = low > 1 ? ROOT_CLUSTER : ROOT_CONVERGED});
  for (int k = 0; k < above && problem->basis == BASIS_BERNSTEIN; k++)
    root_set_add(out, (struct root){.re = 1.0, .status = above > 1 ? ROOT_CLUSTER : ROOT_CONVERGED});
  cut_problem(problem, low, high);
  return problem->basis == BASIS_BERNSTEIN ? 0 : above;
}

/* The squares of values with a modulus beyond 2^EXTREME, or below its inverse, would overflow or underflow in the
 * iterations. */
#define EXTREME 500.0

/* Takes out end coefficients that are 0, but with an error, or vanish against the others. Adds first guesses of their
 * roots: near 0, and near 1 or infinity. */
static void strip_extremes(struct root_problem *problem, struct root_set *out)
{
  const double *c = problem->c;
  int low = 0, high = problem->degree;
  for (; low < high && end_is_beyond(EXTREME, c, low, 1, high - low); low++)
    root_set_add(out, (struct root){.re = c[low + 1] == 0.0 ? 0.0 : -c[low] / c[low + 1], .status = ROOT_CONVERGED});
  for (; high > low && end_is_beyond(EXTREME, c, high, -1, high - low); high--) {
    const double u = problem->basis == BASIS_BERNSTEIN ? 1.0 : -c[high - 1] / c[high];
    if (isfinite(u)) root_set_add(out, (struct root){.re = u, .status = ROOT_CONVERGED});
  }
  cut_problem(problem, low, high);
}

/* Finds the roots in x, with their reach as radius, of what is left of p without its exact roots at the ends, which are
 * the first ones in the answer. Returns false where there is nothing to solve. */
static bool find_roots(const struct polynomial *p, const struct solver_options *options, struct solver_warm *warm,
                       struct root_problem *rest, int *out_exact, struct root_set *out)
{
  out->count = out->missing = 0;
  if (!worth_solving(p, out)) return false;
  *rest = (struct root_problem){.degree = p->degree, .basis = p->basis};
  memcpy(rest->c, p->c, sizeof p->c[0] * (size_t)(p->degree + 1));
  if (p->error != NULL) memcpy(rest->error, p->error, sizeof p->error[0] * (size_t)(p->degree + 1));
  const int infinite = strip_ends(rest, out);
  *out_exact = out->count;
  rest->unit = unit_of(rest, options);
  scale_problem(rest);
  struct root_problem problem = *rest;
  /* not for a solver of [0,1]: its answer is every root there and no other, which a guess may not be */
  if (!options->solver->real_only) strip_extremes(&problem, out);
  if (problem.degree > 0) {
    const bool previous = options->start == START_PREVIOUS && warm != NULL;
    struct root_set found;
    options->solver->find(&problem, options, previous ? warm : NULL, &found);
    if (previous) warm->count = 0;
    for (int i = 0; i < found.count; i++) {
      const struct root root = found.root[i];
      if (!isfinite(root.re) || !isfinite(root.im)) continue;
      root_set_add(out, root);
      if (!previous) continue;
      warm->re[warm->count] = ldexp(root.re, rest->unit);
      warm->im[warm->count++] = ldexp(root.im, rest->unit);
    }
  }
  if (!options->solver->real_only) out->missing = p->degree - infinite - out->count;
  return true;
}

/* Converts the roots from x to u. Those too large for a double there are missing. */
static void roots_in_u(int unit, bool real_only, struct root_set *out)
{
  int kept = 0;
  for (int i = 0; i < out->count; i++) {
    struct root root = out->root[i];
    const double radius = ldexp(root.radius, unit);
    const struct root in_u = {ldexp(root.re, unit), ldexp(root.im, unit), radius, root.iterations, root.status};
    if (!isfinite(in_u.re) || !isfinite(in_u.im)) continue;
    out->root[kept] = in_u;
    /* what underflow may have lost, of the radius and of the value */
    if (ldexp(in_u.re, -unit) != root.re || ldexp(in_u.im, -unit) != root.im || ldexp(radius, -unit) < root.radius)
      out->root[kept].radius += 3 * DBL_TRUE_MIN;
    kept++;
  }
  if (!real_only) out->missing += out->count - kept;
  out->count = kept;
}

void solver_roots(const struct polynomial *p, const struct solver_options *options, struct solver_warm *warm,
                  struct root_set *out)
{
  struct root_problem rest;
  int exact;
  if (find_roots(p, options, warm, &rest, &exact, out)) roots_in_u(rest.unit, options->solver->real_only, out);
}

void solver_solve(const struct polynomial *p, const struct solver_options *options, struct solver_warm *warm,
                  struct root_set *out)
{
  struct root_problem rest;
  int exact;
  if (!find_roots(p, options, warm, &rest, &exact, out)) return;
  const bool real_only = options->solver->real_only;
  const int sought = out->count + out->missing;
  struct evaluation evaluation;
  evaluation_prepare(rest.degree, rest.basis, rest.c, rest.error, &evaluation);
  validation_judge(&evaluation, !real_only, exact, out);
  if (!real_only) out->missing = sought - out->count;
  roots_in_u(rest.unit, real_only, out);
}
