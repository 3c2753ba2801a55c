/* Proves that every solver makes only true statements on every polynomial of the corpus, in both bases, against
 * guaranteed roots.
 *
 * The Bernstein form is rounded, with bounds, and the truth is the power form it was made from, so the coefficient
 * bounds are tested as well. */
#include <math.h>
#include <stdlib.h>

#include "algebra/solver.h"
#include "cmocka_test.h"
#include "corpus/corpus.h"
#include "corpus/exact_roots.h"
#include "random.h"

struct fixture {
  size_t count;
  struct corpus_entry entry[CORPUS_MAX];
  struct exact_roots *exact[CORPUS_MAX];
};

static int set_up(void **state)
{
  struct fixture *fixture = calloc(1, sizeof *fixture);
  *state = fixture;
  if (fixture == NULL) return -1;
  fixture->count = corpus_read(fixture->entry);
  for (size_t i = 0; i < fixture->count; i++) {
    const struct polynomial p = {fixture->entry[i].degree, BASIS_POWER, fixture->entry[i].c, NULL};
    fixture->exact[i] = exact_roots_find(&p);
  }
  return fixture->count > 30 ? 0 : -1;
}

static int tear_down(void **state)
{
  struct fixture *fixture = *state;
  for (size_t i = 0; i < fixture->count; i++) exact_roots_destroy(fixture->exact[i]);
  free(fixture);
  return 0;
}

static struct polynomial polynomial_of(const struct corpus_entry *entry, enum basis basis)
{
  return (struct polynomial){entry->degree, basis, basis == BASIS_POWER ? entry->c : entry->b,
                             basis == BASIS_POWER ? NULL : entry->error};
}

/* What must hold for any answer of any solver. Returns the number of false statements. */
static int check_answer(const char *solver, const struct corpus_entry *entry, enum basis basis, double tolerance,
                        const struct exact_roots *exact, const struct solver_options *options,
                        const struct root_set *roots)
{
  int wrong = roots->count > entry->degree || roots->not_finite || roots->identically_zero;
  for (int i = 0; i < roots->count; i++) {
    const struct root *root = &roots->root[i];
    const double distance = exact_roots_nearest_below(exact, root->re, root->im);
    const int bad = !isfinite(root->re) || !isfinite(root->im) || !(root->radius >= 0.0) || distance > root->radius ||
                    (root->im != 0.0 && root->status == ROOT_CONVERGED &&
                     entry->degree * fabs(root->im) <= root->radius) ||
                    root->iterations > options->max_iterations ||
                    (root->status == ROOT_CONVERGED && !(root->radius < INFINITY)) ||
                    (options->solver->real_only && (root->im != 0.0 || root->re < 0.0 || root->re > 1.0));
    if (bad) {
      print_error(
        "%s, %s, basis %d, tolerance %g: %.17g %+.17g i, radius %g, status %d, iterations %d, true distance %g\n",
        solver, entry->name, (int)basis, tolerance, root->re, root->im, root->radius, (int)root->status,
        root->iterations, distance);
    }
    wrong += bad;
  }
  return wrong;
}

static void answers_are_true(void **state)
{
  const struct fixture *fixture = *state;
  static const double tolerances[] = {0.0 /* the default */, 1e-2, 1e-6, 1e-300};
  int wrong = 0;
  for (size_t s = 0; s < solver_count(); s++) {
    for (size_t i = 0; i < fixture->count; i++) {
      for (int basis = 0; basis < 2; basis++) {
        struct solver_warm warm = {0};
        for (size_t t = 0; t < sizeof tolerances / sizeof tolerances[0]; t++) {
          for (int improved = 0; improved < 2; improved++) {
            struct solver_options options;
            solver_options_default(solver_at(s), &options);
            solver_options_form(&options, improved);
            options.tolerance = t > 0 ? tolerances[t] : options.tolerance;
            options.start = improved ? START_COLD : START_PREVIOUS;
            const struct polynomial p = polynomial_of(&fixture->entry[i], (enum basis)basis);
            struct root_set roots;
            solver_solve(&p, &options, &warm, &roots);
            wrong += check_answer(solver_at(s)->name, &fixture->entry[i], (enum basis)basis, options.tolerance,
                                  fixture->exact[i], &options, &roots);
          }
        }
      }
    }
  }
  assert_int_equal(wrong, 0);
}

/* The default solver promises that no real root in [0,1] is lost: one disc of each answer must hold it. Roots so near
 * each other that they share a cluster may share its discs. */
static void no_real_root_is_lost(void **state)
{
  const struct fixture *fixture = *state;
  int lost = 0;
  for (size_t i = 0; i < fixture->count; i++) {
    for (int basis = 0; basis < 2; basis++) {
      struct solver_options options;
      solver_options_default(solver_find("bernstein", 9), &options);
      const struct polynomial p = polynomial_of(&fixture->entry[i], (enum basis)basis);
      struct root_set roots;
      solver_solve(&p, &options, NULL, &roots);
      for (int k = 0; k < exact_roots_count(fixture->exact[i]); k++) {
        const struct exact_root exact = exact_roots_at(fixture->exact[i], k);
        if (!exact.real || exact.re < 0.0 || exact.re > 1.0) continue;
        int held = 0;
        for (int r = 0; r < roots.count; r++) {
          held += exact_roots_distance_above(fixture->exact[i], k, roots.root[r].re, roots.root[r].im) <=
                  roots.root[r].radius;
        }
        if (held == 0) {
          print_error("%s, basis %d: the root %.17g of multiplicity %d is lost\n", fixture->entry[i].name, basis,
                      exact.re, exact.multiplicity);
        }
        lost += held == 0;
      }
    }
  }
  assert_int_equal(lost, 0);
}

/* Aberth's method, by default, finds every root of every polynomial, and none twice: values and true roots can be
 * paired so that each root lies within its partner's disc. (In the power basis, whose coefficients are exact.) */
static void aberth_finds_all(void **state)
{
  const struct fixture *fixture = *state;
  int missing = 0;
  for (size_t i = 0; i < fixture->count; i++) {
    struct solver_options options;
    solver_options_default(solver_find("aberth", 6), &options);
    const struct polynomial p = polynomial_of(&fixture->entry[i], BASIS_POWER);
    struct root_set roots;
    solver_solve(&p, &options, NULL, &roots);
    bool taken[POLYNOMIAL_MAX_DEGREE] = {false};
    for (int k = 0; k < exact_roots_count(fixture->exact[i]); k++) {
      const int copies = exact_roots_at(fixture->exact[i], k).multiplicity;
      for (int copy = 0; copy < copies; copy++) {
        int best = -1;
        double best_distance = INFINITY;
        for (int r = 0; r < roots.count; r++) {
          const double distance = exact_roots_distance_below(fixture->exact[i], k, roots.root[r].re, roots.root[r].im);
          if (!taken[r] && distance <= roots.root[r].radius && distance < best_distance) {
            best = r;
            best_distance = distance;
          }
        }
        if (best < 0) {
          const struct exact_root exact = exact_roots_at(fixture->exact[i], k);
          print_error("%s: no value for %.17g %+.17g i\n", fixture->entry[i].name, exact.re, exact.im);
          missing++;
        } else {
          taken[best] = true;
        }
      }
    }
  }
  assert_int_equal(missing, 0);
}

/* Random coefficients of all sizes, some of them zero, exact and with bounds, in both bases. The discs must hold roots
 * of the polynomial as given (which is within the bounds like any other). */
static void wild_coefficients(void **state)
{
  (void)state;
  enum { TRIALS = 300, LARGEST_EXPONENT = 60 };
  struct random random = {31};
  int wrong = 0;
  for (int trial = 0; trial < TRIALS; trial++) {
    struct corpus_entry entry = {.name = "wild"};
    double error[POLYNOMIAL_MAX_DEGREE + 1];
    entry.degree = 1 + (int)(random_bits(&random) % 24);
    const double spread = trial % 4 == 0 ? LARGEST_EXPONENT : trial % 4 == 1 ? 10.0 : 1.0;
    for (int k = 0; k <= entry.degree; k++) {
      const double size = exp2(random_between(&random, -spread, spread));
      entry.c[k] = random_bits(&random) % 5 == 0 ? 0.0 : random_between(&random, -1.0, 1.0) * size;
      if (trial % 4 == 3) entry.c[k] = rint(4.0 * entry.c[k]); /* small integers: multiple and rational roots */
      error[k] = random_bits(&random) % 2 == 0 ? 0.0 : 1e-9 * size;
    }
    entry.c[random_bits(&random) % 2 == 0 ? 0 : entry.degree] = 3.0;
    for (int basis = 0; basis < 2; basis++) {
      const struct polynomial exact_p = {entry.degree, (enum basis)basis, entry.c, NULL};
      struct exact_roots *exact = exact_roots_find(&exact_p);
      for (size_t s = 0; s < solver_count(); s++) {
        for (int bounds = 0; bounds < 2; bounds++) {
          struct solver_options options;
          solver_options_default(solver_at(s), &options);
          const struct polynomial p = {entry.degree, (enum basis)basis, entry.c, bounds != 0 ? error : NULL};
          struct root_set roots;
          solver_solve(&p, &options, NULL, &roots);
          wrong += check_answer(solver_at(s)->name, &entry, (enum basis)basis, options.tolerance, exact, &options,
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
static int draw_bounded(struct random *random, int trial, enum basis basis, double c[], double error[])
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
static void no_root_within_bounds_is_lost(void **state)
{
  (void)state;
  enum { TRIALS = 1000 };
  struct random random = {7};
  int lost = 0;
  for (int trial = 0; trial < TRIALS; trial++) {
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
    if (here > 0) print_error("trial %d, degree %d, basis %d: %d lost\n", trial, degree, (int)basis, here);
    lost += here;
    exact_roots_destroy(exact);
  }
  assert_int_equal(lost, 0);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(answers_are_true),
    cmocka_unit_test(no_real_root_is_lost),
    cmocka_unit_test(aberth_finds_all),
    cmocka_unit_test(wild_coefficients),
    cmocka_unit_test(no_root_within_bounds_is_lost),
  };
  return cmocka_run_group_tests(tests, set_up, tear_down);
}
