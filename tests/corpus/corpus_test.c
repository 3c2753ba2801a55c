/* Proves that every solver makes only true statements on every polynomial of the corpus, in both bases, against
 * guaranteed roots.
 *
 * The Bernstein form is rounded, with bounds, and the truth is the power form it was made from, so the coefficient
 * bounds are tested as well. */
#include <math.h>
#include <string.h>

#include "algebra/solver.h"
#include "cmocka_test.h"
#include "corpus/corpus.h"
#include "corpus/exact_roots.h"
#include "effort.h"
#include "random.h"

static size_t count;
static struct corpus_entry entry[CORPUS_MAX];

static struct polynomial polynomial_of(const struct corpus_entry *from, enum basis basis)
{
  return (struct polynomial){from->degree, basis, basis == BASIS_POWER ? from->c : from->b,
                             basis == BASIS_POWER ? NULL : from->error};
}

/* What must hold for any answer of any solver. Returns the number of false statements. */
static int check_answer(const char *solver, const struct corpus_entry *of, enum basis basis, double tolerance,
                        const struct exact_roots *exact, const struct solver_options *options,
                        const struct root_set *roots)
{
  int wrong = roots->count > of->degree || roots->not_finite || roots->identically_zero;
  for (int i = 0; i < roots->count; i++) {
    const struct root *root = &roots->root[i];
    const double distance = exact_roots_nearest_below(exact, root->re, root->im);
    const int bad = !isfinite(root->re) || !isfinite(root->im) || !(root->radius >= 0.0) || distance > root->radius ||
                    (root->im != 0.0 && root->status == ROOT_CONVERGED &&
                     of->degree * fabs(root->im) <= root->radius) ||
                    root->iterations > options->max_iterations ||
                    (root->status == ROOT_CONVERGED && !(root->radius < INFINITY)) ||
                    (options->solver->real_only && (root->im != 0.0 || root->re < 0.0 || root->re > 1.0));
    if (bad) {
      print_error(
        "%s, %s, basis %d, tolerance %g: %.17g %+.17g i, radius %g, status %d, iterations %d, true distance %g\n",
        solver, of->name, (int)basis, tolerance, root->re, root->im, root->radius, (int)root->status, root->iterations,
        distance);
    }
    wrong += bad;
  }
  return wrong;
}

TEST(answers_are_true)
{
  static const double tolerances[] = {0.0 /* the default */, 1e-2, 1e-6, 1e-300};
  int wrong = 0;
  for (size_t i = 0; i < count; i++) {
    const struct polynomial power = polynomial_of(&entry[i], BASIS_POWER);
    struct exact_roots *exact = exact_roots_find(&power);
    for (size_t n = 0; n < 2 * solver_count(); n++) {
      const struct solver *solver = solver_at(n / 2);
      const enum basis basis = n % 2 == 0 ? BASIS_POWER : BASIS_BERNSTEIN;
      const struct polynomial p = polynomial_of(&entry[i], basis);
      struct solver_warm warm = {0};
      for (size_t t = 0; t < 2 * sizeof tolerances / sizeof tolerances[0]; t++) {
        const bool improved = t % 2 == 1;
        struct solver_options options;
        struct root_set roots;
        solver_options_default(solver, &options);
        solver_options_form(&options, improved);
        options.tolerance = t > 1 ? tolerances[t / 2] : options.tolerance;
        options.start = improved ? START_COLD : START_PREVIOUS;
        solver_solve(&p, &options, &warm, &roots);
        wrong += check_answer(solver->name, &entry[i], basis, options.tolerance, exact, &options, &roots);
        /* These miss none, by default. That each has its own value, families_test.c proves. */
        const bool complete = strcmp(solver->name, "aberth") == 0 || strcmp(solver->name, "bernstein") == 0;
        if (t == 1 && complete && basis == BASIS_POWER && roots.missing > 0)
          print_error("%s, %s: %d missing\n", solver->name, entry[i].name, roots.missing), wrong++;
      }
    }
    exact_roots_destroy(exact);
  }
  assert_int_equal(wrong, 0);
}

/* Random coefficients of all sizes, some of them zero, exact and with bounds, in both bases. The discs must hold roots
 * of the polynomial as given (which is within the bounds like any other). */
TEST(wild_coefficients)
{
  enum { LARGEST_EXPONENT = 60 };
  const size_t trials = effort_count(300000, 60);
  struct random random = {31};
  int wrong = 0;
  for (size_t trial = 0; trial < trials; trial++) {
    struct corpus_entry wild = {.name = "wild"};
    double error[POLYNOMIAL_MAX_DEGREE + 1];
    wild.degree = 1 + (int)(random_bits(&random) % 24);
    const double spread = trial % 4 == 0 ? LARGEST_EXPONENT : trial % 4 == 1 ? 10.0 : 1.0;
    for (int k = 0; k <= wild.degree; k++) {
      const double size = exp2(random_between(&random, -spread, spread));
      wild.c[k] = random_bits(&random) % 5 == 0 ? 0.0 : random_between(&random, -1.0, 1.0) * size;
      if (trial % 4 == 3) wild.c[k] = rint(4.0 * wild.c[k]); /* small integers: multiple and rational roots */
      error[k] = random_bits(&random) % 2 == 0 ? 0.0 : 1e-9 * size;
    }
    wild.c[random_bits(&random) % 2 == 0 ? 0 : wild.degree] = 3.0;
    for (int basis = 0; basis < 2; basis++) {
      const struct polynomial exact_p = {wild.degree, (enum basis)basis, wild.c, NULL};
      struct exact_roots *exact = exact_roots_find(&exact_p);
      for (size_t s = 0; s < solver_count(); s++) {
        for (int bounds = 0; bounds < 2; bounds++) {
          struct solver_options options;
          solver_options_default(solver_at(s), &options);
          const struct polynomial p = {wild.degree, (enum basis)basis, wild.c, bounds != 0 ? error : NULL};
          struct root_set roots;
          solver_solve(&p, &options, NULL, &roots);
          wrong += check_answer(solver_at(s)->name, &wild, (enum basis)basis, options.tolerance, exact, &options,
                                &roots);
        }
      }
      exact_roots_destroy(exact);
    }
  }
  assert_int_equal(wrong, 0);
}

/* Multiplies c of degree n by u - root, in its basis. Returns the new degree. */
static int times_linear(enum basis basis, int n, double c[], double root)
{
  const double slope = basis == BASIS_POWER ? 1.0 : 1.0 - root;
  c[n + 1] = slope * c[n];
  for (int k = n; k > 0; k--) c[k] = slope * c[k - 1] - root * c[k];
  c[0] *= -root;
  return n + 1;
}

/* Roots of [0,1] near each other, near the ends and near halves of intervals, of a polynomial with bounds. */
static int draw_bounded(struct random *random, size_t trial, enum basis basis, double c[], double error[])
{
  const int degree = 1 + (int)(random_bits(random) % (trial % 3 == 0 ? 18 : 6));
  const double site = (double)(random_bits(random) % 17) / 16, spread = exp2(-(double)(random_bits(random) % 30));
  double largest = 0.0;
  c[0] = 1.0;
  for (int n = 0; n < degree;) {
    const double beside = random_bits(random) % 2 == 0 ? 0.0 : spread * random_between(random, -1.0, 1.0);
    const double root = random_bits(random) % 3 != 0 ? site + beside : random_between(random, -0.2, 1.2);
    n = times_linear(basis, n, c, root);
  }
  for (int k = 0; k <= degree; k++) largest = fmax(largest, fabs(c[k]));
  const double size = exp2(-10.0 - (double)(random_bits(random) % 45));
  const uint64_t kind = random_bits(random) % 3;
  for (int k = 0; k <= degree; k++)
    error[k] = size * (kind == 0 ? fabs(c[k]) : kind == 1 || random_bits(random) % 2 == 0 ? largest : 0.0);
  return degree;
}

/* The number of real roots in [0,1] that lie within no answer's radius. */
static int count_lost(const struct exact_roots *exact, const struct root_set *roots)
{
  int lost = 0;
  for (int k = 0; k < exact_roots_count(exact) && !roots->identically_zero; k++) {
    const struct exact_root at = exact_roots_at(exact, k);
    bool held = !at.real || at.re < 0.0 || at.re > 1.0;
    for (int r = 0; r < roots->count; r++)
      held |= exact_roots_distance_below(exact, k, roots->root[r].re, roots->root[r].im) <= roots->root[r].radius;
    lost += !held;
  }
  return lost;
}

/* Any polynomial within the bounds may be the true one: no root of it in [0,1] is lost. */
TEST(no_root_within_bounds_is_lost)
{
  const size_t trials = effort_count(1000000, 200);
  struct random random = {7};
  int lost = 0;
  for (size_t trial = 0; trial < trials; trial++) {
    const enum basis basis = (enum basis)(trial % 2);
    double c[POLYNOMIAL_MAX_DEGREE + 1], error[POLYNOMIAL_MAX_DEGREE + 1], truth[POLYNOMIAL_MAX_DEGREE + 1];
    const int degree = draw_bounded(&random, trial, basis, c, error);
    for (int k = 0; k <= degree; k++) {
      const double part = fmin(fmax(random_between(&random, -2.0, 2.0), -1.0), 1.0);
      truth[k] = c[k] + part * error[k];
      if (fabs(truth[k] - c[k]) > error[k]) truth[k] = c[k];
    }
    const struct polynomial p = {degree, basis, c, error}, true_p = {degree, basis, truth, NULL};
    struct exact_roots *exact = exact_roots_find(&true_p);
    struct solver_options options;
    struct root_set roots;
    solver_options_default(solver_find("bernstein", 9), &options);
    solver_solve(&p, &options, NULL, &roots);
    const int here = count_lost(exact, &roots);
    if (here > 0) print_error("trial %zu, degree %d, basis %d: %d lost\n", trial, degree, (int)basis, here);
    lost += here;
    exact_roots_destroy(exact);
  }
  assert_int_equal(lost, 0);
}

int main(void)
{
  count = corpus_read(entry);
  return count > 30 ? test_run() : 1;
}
