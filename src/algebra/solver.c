/* The table of solvers, and the way every polynomial goes: scaled, stripped, solved, judged. */
#include "algebra/solver.h"

#include <float.h>
#include <math.h>
#include <string.h>

#include "algebra/root_kernel.h"
#include "base/kernel.h"

/* eps of eq 10, absolute in the unknown: the least at which the paper's plain iterations still stop by it, as values of
 * size 100 do not move by less. It and the steps a root may take decide when to stop, never what is true: radii and
 * certificates are made afterwards. */
#define STOP_TOLERANCE 1e-12

#define SOLVER_ROW(name, summary, real_only, lanes, steps) \
  {#name, summary, real_only, SOLVER_LANES_##lanes, STOP_TOLERANCE, steps, name##_find},
static const struct solver solvers[] = {SOLVERS(SOLVER_ROW)};
#undef SOLVER_ROW

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

bool solver_options_paper(const struct solver_options *options)
{
  return options->radii == RADII_CIRCLE && options->stop == STOP_STEP && options->horner == HORNER_PLAIN &&
         options->update == UPDATE_JACOBI && !options->rest && options->deflation == DEFLATION_FORWARD &&
         !options->refine;
}

void solver_options_default(const struct solver *solver, struct solver_options *out)
{
  *out = (struct solver_options){
    .solver = solver, .tolerance = solver->tolerance, .max_iterations = solver->max_iterations, .start = START_COLD};
  solver_options_form(out, true);
}

root_kernel *root_kernel_best(void)
{
#if defined(PSCN_HAS_AVX2)
  if (KERNEL_RUNS_AVX2) return root_kernel_avx2;
#endif
  return root_kernel_baseline;
}

/* The polynomial scaled by a power of two so that its largest coefficient lies in [1/2, 1), which changes no root.
 * False where there is nothing to solve; then out says why. */
static bool scale_polynomial(const struct polynomial *p, struct root_problem *scaled, struct root_set *out)
{
  double largest = 0.0;
  bool finite = true, zero = true;
  for (int k = 0; k <= p->degree; k++) {
    const double error = p->error == NULL ? 0.0 : p->error[k];
    const double size = fabs(p->c[k]);
    finite = finite && size <= DBL_MAX && error >= 0.0 && error <= DBL_MAX;
    zero = zero && size <= error;
    largest = fmax(largest, size);
  }
  out->not_finite = !finite;
  out->identically_zero = finite && zero;
  if (!finite || zero) return false;
  scaled->degree = p->degree;
  scaled->basis = p->basis;
  int exponent;
  (void)frexp(largest, &exponent);
  /* Two factors, because 2^-exponent itself may overflow. */
  const double first = ldexp(1.0, -(exponent / 2)), second = ldexp(1.0, -(exponent - exponent / 2));
  for (int k = 0; k <= p->degree; k++) {
    scaled->c[k] = p->c[k] * first * second;
    const bool exact = scaled->c[k] / first / second == p->c[k];
    scaled->error[k] = p->error == NULL ? 0.0 : p->error[k] * first * second * (1.0 + DBL_EPSILON);
    if (!exact || (p->error != NULL && p->error[k] > 0.0))
      scaled->error[k] += 2 * DBL_TRUE_MIN; /* what underflow may have taken */
  }
  return true;
}

static void add_root(struct root_set *out, double re, double im, int iterations, enum root_status status)
{
  if (out->count < POLYNOMIAL_MAX_DEGREE) out->root[out->count++] = (struct root){re, im, 0.0, iterations, status};
}

/* The same polynomial without its first `low` coefficients and those behind `high`. */
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
  for (int k = 0; k < low; k++) add_root(out, 0.0, 0.0, 0, low > 1 ? ROOT_CLUSTER : ROOT_CONVERGED);
  for (int k = 0; k < above && problem->basis == BASIS_BERNSTEIN; k++)
    add_root(out, 1.0, 0.0, 0, above > 1 ? ROOT_CLUSTER : ROOT_CONVERGED);
  cut_problem(problem, low, high);
  return problem->basis == BASIS_BERNSTEIN ? 0 : above;
}

/* Values whose modulus is beyond 2^EXTREME, either way, are not for the iterations, whose squares would over- or
 * underflow. */
#define EXTREME 500.0

/* Whether the coefficients stand for a root of such a modulus at the end `from` (Newton's polygon): |c[from]| is less
 * than that of another one k steps inwards by more than 2^(k EXTREME). */
static bool end_is_extreme(const double c[], int from, int inwards, int count)
{
  for (int k = 1; k <= count; k++)
    if (log2(fabs(c[from + inwards * k])) - log2(fabs(c[from])) > k * EXTREME) return true;
  return false;
}

/* Takes out coefficients at the ends that vanish within their errors or against the others, with first guesses of their
 * roots: near 0, and near 1 or infinity. */
static void strip_extremes(struct root_problem *problem, struct root_set *out)
{
  const double *c = problem->c;
  int low = 0, high = problem->degree;
  for (; low < high && end_is_extreme(c, low, 1, high - low); low++)
    add_root(out, c[low + 1] == 0.0 ? 0.0 : -c[low] / c[low + 1], 0.0, 0, ROOT_CONVERGED);
  for (; high > low && end_is_extreme(c, high, -1, high - low); high--) {
    const double u = problem->basis == BASIS_BERNSTEIN ? 1.0 : -c[high - 1] / c[high];
    if (isfinite(u)) add_root(out, u, 0.0, 0, ROOT_CONVERGED);
  }
  cut_problem(problem, low, high);
}

static void remember(const struct root_estimates *estimates, struct solver_warm *warm)
{
  warm->count = 0;
  for (int i = 0; i < estimates->count; i++) {
    if (isfinite(estimates->re[i]) && isfinite(estimates->im[i])) {
      warm->re[warm->count] = estimates->re[i];
      warm->im[warm->count] = estimates->im[i];
      warm->count++;
    }
  }
}

/* The roots, each with the radius of what it stands for, the first *out_exact of them exact, and the polynomial that
 * has the others. False where there is nothing to solve. */
static bool find_roots(const struct polynomial *p, const struct solver_options *options, struct solver_warm *warm,
                       struct root_problem *out_rest, int *out_exact, struct root_set *out)
{
  out->count = out->missing = 0;
  if (!scale_polynomial(p, out_rest, out)) return false;
  const int infinite = strip_ends(out_rest, out);
  *out_exact = out->count;
  struct root_problem problem = *out_rest;
  strip_extremes(&problem, out);
  if (problem.degree > 0) {
    struct root_estimates estimates;
    estimates.count = 0;
    const bool previous = options->start == START_PREVIOUS && warm != NULL;
    options->solver->find(&problem, options, previous ? warm : NULL, &estimates);
    for (int i = 0; i < estimates.count; i++) {
      if (isfinite(estimates.re[i]) && isfinite(estimates.im[i])) {
        const enum root_status status = !estimates.converged[i] ? ROOT_LIMIT
                                        : estimates.cluster[i]  ? ROOT_CLUSTER
                                                                : ROOT_CONVERGED;
        add_root(out, estimates.re[i], estimates.im[i], estimates.iterations[i], status);
        out->root[out->count - 1].radius = estimates.reach[i];
      }
    }
    if (previous) remember(&estimates, warm);
  }
  if (!options->solver->real_only) out->missing = p->degree - infinite - out->count;
  return true;
}

void solver_roots(const struct polynomial *p, const struct solver_options *options, struct solver_warm *warm,
                  struct root_set *out)
{
  struct root_problem rest;
  int exact;
  (void)find_roots(p, options, warm, &rest, &exact, out);
}

void solver_solve(const struct polynomial *p, const struct solver_options *options, struct solver_warm *warm,
                  struct root_set *out)
{
  struct root_problem rest;
  int exact;
  if (!find_roots(p, options, warm, &rest, &exact, out)) return;
  const int sought = out->count + out->missing;
  struct evaluation evaluation;
  evaluation_prepare(rest.degree, rest.basis, rest.c, rest.error, &evaluation);
  validation_judge(&evaluation, !options->solver->real_only, exact, out);
  if (!options->solver->real_only) out->missing = sought - out->count;
}
