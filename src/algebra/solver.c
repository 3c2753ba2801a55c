/* The table of solvers, the items of a solver block, and the way every polynomial goes: scaled, stripped, solved,
 * judged. */
#include "algebra/solver.h"

#include <float.h>
#include <math.h>
#include <string.h>

#include "algebra/root_kernel.h"

/* eps of eq 10, absolute in the unknown: the least at which the paper's plain iterations still stop by it, as values of
 * size 100 do not move by less. It and the steps a root may take decide when to stop, never what is true: radii and
 * certificates are made afterwards. */
#define STOP_TOLERANCE 1e-12

/* One row a solver: name, summary, real roots only, tolerance, steps a root may take. */
static const struct solver solvers[] = {
  {"bernstein", "real roots in [0,1] by sign variations in Bernstein form and bracketed Newton", true, STOP_TOLERANCE,
   64, bernstein_find},
  {"newton", "one root after the other by Newton-Raphson, with deflation (eq 7 of the paper)", false, STOP_TOLERANCE,
   200, newton_find},
  {"laguerre", "one root after the other by Laguerre's method, with deflation (eq 8 of the paper)", false,
   STOP_TOLERANCE, 100, laguerre_find},
  {"aberth", "all roots at once by Aberth's method (eq 9 of the paper)", false, STOP_TOLERANCE, 100, aberth_find},
};

size_t solver_count(void)
{
  return sizeof solvers / sizeof solvers[0];
}

const struct solver *solver_at(size_t index)
{
  return index < solver_count() ? &solvers[index] : NULL;
}

const struct solver *solver_find(const char *name, size_t length)
{
  for (size_t i = 0; i < solver_count(); i++) {
    if (strlen(solvers[i].name) == length && memcmp(solvers[i].name, name, length) == 0) {
      return &solvers[i];
    }
  }
  return NULL;
}

/* The paper's iterations as printed, or what docs/paper.md found best. */
static void choose_form(struct solver_options *options, bool improved)
{
  options->radii = improved ? RADII_POLYGON : RADII_CIRCLE;
  options->stop = improved ? STOP_ROUNDING : STOP_STEP;
  options->update = improved ? UPDATE_GAUSS_SEIDEL : UPDATE_JACOBI;
  options->rest = improved;
  options->deflation = improved ? DEFLATION_COMPOSITE : DEFLATION_FORWARD;
  options->refine = improved;
}

/* Where the form is not named, the paper's goes with the paper's method, whichever of its items is said first. */
static void follow_form(struct solver_options *options)
{
  const bool paper = options->basis == BASIS_POWER && options->resultant == RESULTANT_SYLVESTER &&
                     options->back_substitution == BACK_SUBSTITUTION_EUCLID && !options->polish;
  if (!options->form_said) choose_form(options, !paper);
}

/* The items of a solver block. One macro writes the two accessors of an item, whose C types differ; `after` is done
 * when it was set. */
#define ITEM_ACCESSORS(field, type, after)                                   \
  static void set_##field(struct solver_options *options, double value)      \
  {                                                                          \
    options->field = (type)value;                                            \
    after;                                                                   \
  }                                                                          \
  static double get_##field(const struct solver_options *options)            \
  {                                                                          \
    return (double)options->field;                                           \
  }

ITEM_ACCESSORS(tolerance, double, (void)0)
ITEM_ACCESSORS(max_iterations, int, (void)0)
ITEM_ACCESSORS(start, enum start, (void)0)
ITEM_ACCESSORS(split, int, (void)0)
ITEM_ACCESSORS(basis, enum basis, follow_form(options))
ITEM_ACCESSORS(resultant, enum resultant, follow_form(options))
ITEM_ACCESSORS(back_substitution, enum back_substitution, follow_form(options))
ITEM_ACCESSORS(polish, bool, follow_form(options))
ITEM_ACCESSORS(radii, enum radii, options->form_said = true)
ITEM_ACCESSORS(stop, enum stop, options->form_said = true)
ITEM_ACCESSORS(update, enum update, options->form_said = true)
ITEM_ACCESSORS(rest, bool, options->form_said = true)
ITEM_ACCESSORS(deflation, enum deflation, options->form_said = true)
ITEM_ACCESSORS(refine, bool, options->form_said = true)

static void set_form(struct solver_options *options, double value)
{
  choose_form(options, value != 0.0);
  options->form_said = true;
}

static double get_form(const struct solver_options *options)
{
  const bool paper = options->radii == RADII_CIRCLE && options->stop == STOP_STEP && options->update == UPDATE_JACOBI &&
                     !options->rest && options->deflation == DEFLATION_FORWARD && !options->refine;
  return paper ? 0.0 : 1.0;
}

void solver_options_default(const struct solver *solver, struct solver_options *out)
{
  *out = (struct solver_options){
    .solver = solver,
    .tolerance = solver->tolerance,
    .max_iterations = solver->max_iterations,
    .start = START_COLD,
    .basis = BASIS_BERNSTEIN,
    .resultant = RESULTANT_BEZOUT,
    .back_substitution = BACK_SUBSTITUTION_NULL_VECTOR,
    .polish = true,
    .split = 0,
  };
  follow_form(out);
}

static const char *const form_words[] = {"paper", "improved", NULL};
static const char *const radii_words[] = {"circle", "polygon", NULL};
static const char *const stop_words[] = {"step", "rounding", NULL};
static const char *const update_words[] = {"jacobi", "gauss_seidel", NULL};
static const char *const deflation_words[] = {"forward", "composite", NULL};
static const char *const start_words[] = {"cold", "previous", NULL};
static const char *const basis_words[] = {"bernstein", "power", NULL};
static const char *const resultant_words[] = {"bezout", "sylvester", NULL};
static const char *const back_substitution_words[] = {"null_vector", "euclid", NULL};
static const char *const off_on[] = {"off", "on", NULL};
static const char *const split_words[] = {"auto", NULL};

/* Limits: a tolerance of 1 in a parameter of [0,1] asks for nothing; iterations are bounded so that no solve can
 * hang. */
#define MAX_TOLERANCE 1.0
#define MAX_ITERATIONS 10000
#define MAX_SPLIT 64

static const struct solver_item items[] = {
  {"tolerance", "a root has converged when a step is below this (eps of eq 10), absolute in u", SOLVER_ITEM_NUMBER,
   NULL, DBL_MIN, MAX_TOLERANCE, set_tolerance, get_tolerance},
  {"max_iterations", "steps a root may take", SOLVER_ITEM_INTEGER, NULL, 1, MAX_ITERATIONS, set_max_iterations,
   get_max_iterations},
  {"start", "from Aberth's circle, or from the roots of the previous ray on the same patch", SOLVER_ITEM_KEYWORD,
   start_words, 0, 1, set_start, get_start},
  {"basis", "in which the resultant is written", SOLVER_ITEM_KEYWORD, basis_words, 0, 1, set_basis, get_basis},
  {"resultant", "how v is eliminated", SOLVER_ITEM_KEYWORD, resultant_words, 0, 1, set_resultant, get_resultant},
  {"back_substitution", "how v is found from u", SOLVER_ITEM_KEYWORD, back_substitution_words, 0, 1,
   set_back_substitution, get_back_substitution},
  {"polish", "on: Newton on the patch itself, and every answer certified; off: the solver's roots are the answer",
   SOLVER_ITEM_KEYWORD, off_on, 0, 1, set_polish, get_polish},
  {"split", "each patch is cut into N x N leaves; 1 = whole patches", SOLVER_ITEM_INTEGER, split_words, 1, MAX_SPLIT,
   set_split, get_split},
  /* form stands before the items it sets, so that a block written in this order reads back the same. */
  {"form", "all of the following at once: the paper's iterations as printed, or improved", SOLVER_ITEM_KEYWORD,
   form_words, 0, 1, set_form, get_form},
  {"radii", "cold start values on Aberth's circle, or on circles by Newton's polygon", SOLVER_ITEM_KEYWORD, radii_words,
   0, 1, set_radii, get_radii},
  {"stop", "by eq 10 alone, or also where the value is below its own rounding bound", SOLVER_ITEM_KEYWORD, stop_words,
   0, 1, set_stop, get_stop},
  {"update", "aberth: from the values before the sweep, or from the newest", SOLVER_ITEM_KEYWORD, update_words, 0, 1,
   set_update, get_update},
  {"rest", "aberth: a root that is done is left alone while others move", SOLVER_ITEM_KEYWORD, off_on, 0, 1, set_rest,
   get_rest},
  {"deflation", "newton, laguerre: division from the highest power, or from both ends", SOLVER_ITEM_KEYWORD,
   deflation_words, 0, 1, set_deflation, get_deflation},
  {"refine", "newton, laguerre: last steps on the polynomial before deflation", SOLVER_ITEM_KEYWORD, off_on, 0, 1,
   set_refine, get_refine},
};

size_t solver_item_count(void)
{
  return sizeof items / sizeof items[0];
}

const struct solver_item *solver_item_at(size_t index)
{
  return index < solver_item_count() ? &items[index] : NULL;
}

const struct root_kernel *root_kernel_best(void)
{
#ifdef PSCN_ROOT_KERNEL_AVX2
  if (__builtin_cpu_supports("avx2")) {
    return &root_kernel_avx2;
  }
#endif
  return &root_kernel_baseline;
}

/* The polynomial scaled by a power of two so that its largest coefficient lies in [1/2, 1), which changes no root. */
struct scaled {
  double c[POLYNOMIAL_MAX_DEGREE + 1];
  double error[POLYNOMIAL_MAX_DEGREE + 1];
};

/* False where there is nothing to solve; then out says why. */
static bool scale_polynomial(const struct polynomial *p, struct scaled *scaled, struct root_set *out)
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
  if (!finite || zero) {
    return false;
  }
  int exponent;
  (void)frexp(largest, &exponent);
  /* Two factors, because 2^-exponent itself may overflow. */
  const double first = ldexp(1.0, -(exponent / 2)), second = ldexp(1.0, -(exponent - exponent / 2));
  for (int k = 0; k <= p->degree; k++) {
    scaled->c[k] = p->c[k] * first * second;
    const bool exact = scaled->c[k] / first / second == p->c[k];
    scaled->error[k] = p->error == NULL ? 0.0 : p->error[k] * first * second * (1.0 + DBL_EPSILON);
    if (!exact || (p->error != NULL && p->error[k] > 0.0)) {
      scaled->error[k] += 2 * DBL_TRUE_MIN; /* what underflow may have taken */
    }
  }
  return true;
}

static void add_root(struct root_set *out, double re, double im, int iterations, enum root_status status)
{
  if (out->count < POLYNOMIAL_MAX_DEGREE) {
    out->root[out->count++] = (struct root){re, im, INFINITY, iterations, status};
  }
}

/* Takes out the roots at the ends of the coefficients: u = 0, and u = 1 (Bernstein) or infinity (power, not listed). */
static void strip_ends(const struct polynomial *p, const struct scaled *scaled, struct root_problem *problem,
                       struct root_set *out)
{
  int low = 0, high = p->degree;
  while (low < high && scaled->c[low] == 0.0) {
    low++;
  }
  while (high > low && scaled->c[high] == 0.0) {
    high--;
  }
  for (int k = 0; k < low; k++) {
    add_root(out, 0.0, 0.0, 0, low > 1 ? ROOT_CLUSTER : ROOT_CONVERGED);
  }
  if (p->basis == BASIS_BERNSTEIN) {
    for (int k = high; k < p->degree; k++) {
      add_root(out, 1.0, 0.0, 0, p->degree - high > 1 ? ROOT_CLUSTER : ROOT_CONVERGED);
    }
  }
  problem->degree = high - low;
  problem->basis = p->basis;
  memcpy(problem->c, scaled->c + low, sizeof problem->c[0] * (size_t)(high - low + 1));
  memcpy(problem->error, scaled->error + low, sizeof problem->error[0] * (size_t)(high - low + 1));
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

/* The roots with infinite radii. False where there is nothing to solve. */
static bool find_roots(const struct polynomial *p, const struct solver_options *options, struct solver_warm *warm,
                       struct scaled *scaled_out, struct root_set *out)
{
  out->count = 0;
  if (!scale_polynomial(p, scaled_out, out)) {
    return false;
  }
  struct root_problem problem;
  strip_ends(p, scaled_out, &problem, out);
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
      }
    }
    if (previous) {
      remember(&estimates, warm);
    }
  }
  return true;
}

void solver_roots(const struct polynomial *p, const struct solver_options *options, struct solver_warm *warm,
                  struct root_set *out)
{
  struct scaled scaled;
  (void)find_roots(p, options, warm, &scaled, out);
}

void solver_solve(const struct polynomial *p, const struct solver_options *options, struct solver_warm *warm,
                  struct root_set *out)
{
  struct scaled scaled;
  if (!find_roots(p, options, warm, &scaled, out)) {
    return;
  }
  struct evaluation evaluation;
  evaluation_prepare(p->degree, p->basis, scaled.c, scaled.error, &evaluation);
  validation_judge(&evaluation, out);
}
