/* The paper's experiments on random polynomials (sections 3.4.1 and 3.4.2): one experiment a call, CSV on standard
 * output.
 *
 *     random_experiments degrees      Fig 2-5: iterations and time against the degree, eps = 1e-6
 *     random_experiments tolerances   Fig 6-10: iterations, time and accuracy against eps, degree 18
 *     random_experiments caps         the cap of steps, degree 18
 *     random_experiments order        Fig 11-12: accuracy against the order in which the roots were found, degree 18
 *     random_experiments improvements what each improvement does to iterations, time and accuracy, degree 18
 *
 * A word `once` behind that: the counts alone, times mean nothing.
 *
 * As in the paper, with Durand-Kerner's method beside: 100 polynomials with random coefficients (here uniform in
 * [-1,1], seeded) a point, power basis, Aberth's start values, eq 10 as the stop, eq 11 as the measure of accuracy. The
 * solvers' own values are judged, before the library's validation. Times are CPU time of the solver alone.
 */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "algebra/root_problem.h"
#include "algebra/solver.h"
#include "base/clock.h"
#include "measure.h"
#include "scene/method.h"

enum {
  POLYNOMIALS = 100,
  PAPER_DEGREE = 18,
  LAST_DEGREE = 24,
  REPEATS = 20 /* of every timed solve: a single one is too short for the clock */
};

static int repeats = REPEATS; /* of a solve, for its time */

static const char *const methods[] = {"newton", "laguerre", "aberth", "durand_kerner"};
enum { METHODS = sizeof methods / sizeof methods[0] };

/* Whether the method moves all roots together, so that none is the first. */
static bool at_once(const struct solver_options *options)
{
  return strcmp(options->solver->name, "aberth") == 0 || strcmp(options->solver->name, "durand_kerner") == 0;
}

static struct solver_options paper_options(const char *method, double tolerance)
{
  struct solver_options options;
  solver_options_default(solver_find(method, strlen(method)), &options);
  solver_options_form(&options, false);
  options.tolerance = tolerance;
  options.max_iterations = 500;
  return options;
}

static void random_problem(uint64_t *state, int degree, struct root_problem *out)
{
  *out = (struct root_problem){.degree = degree, .basis = BASIS_POWER};
  measure_random_polynomial(state, degree, out->c);
}

/* Finds all roots, or only the first one; a method that moves all at once always finds all. */
static void find(const struct root_problem *problem, const struct solver_options *options, bool first_only,
                 struct root_set *out)
{
  if (!first_only || at_once(options)) {
    options->solver->find(problem, options, NULL, out);
  } else {
    deflation_find(problem, options, NULL,
                   strcmp(options->solver->name, "newton") == 0 ? &newton_method : &laguerre_method, 1, out);
  }
}

struct summary {
  double iterations; /* mean over the roots sought */
  double deviation;  /* standard error of that mean, from the polynomials' own means */
  double seconds;    /* mean over the solves */
  double accurate;   /* share of the values that meet eq 11 */
  double error;      /* mean of log10 (|P(z)| / delta(z)), eq 11's two sides */
  double unconverged;
};

static struct summary measure(int degree, const struct solver_options *options, bool first_only, uint64_t seed)
{
  struct summary out = {0};
  double values = 0.0, sought = 0.0, sum = 0.0, squares = 0.0;
  for (int i = 0; i < POLYNOMIALS; i++) {
    struct root_problem problem;
    struct root_set roots;
    random_problem(&seed, degree, &problem);
    const double start = clock_seconds(CLOCK_THREAD_CPUTIME_ID);
    for (int repeat = 0; repeat < repeats; repeat++) find(&problem, options, first_only, &roots);
    out.seconds += (clock_seconds(CLOCK_THREAD_CPUTIME_ID) - start) / repeats / POLYNOMIALS;
    const int count = first_only && !at_once(options) ? 1 : roots.count;
    const double steps_before = out.iterations, sought_before = sought;
    for (int r = 0; r < count; r++) {
      const double ratio = measure_eq11(&problem, roots.root[r].re, roots.root[r].im);
      out.accurate += ratio < 1.0;
      out.error += log10(fmax(ratio, 1e-6));
      values += 1.0;
      out.iterations += roots.root[r].iterations;
      sought += roots.root[r].iterations > 0;
      out.unconverged += roots.root[r].status == ROOT_LIMIT;
    }
    const double mean = (out.iterations - steps_before) / fmax(sought - sought_before, 1.0);
    sum += mean, squares += mean * mean;
  }
  out.deviation = sqrt(fmax(squares / POLYNOMIALS - sum * sum / (POLYNOMIALS * POLYNOMIALS), 0.0) / (POLYNOMIALS - 1));
  out.accurate /= values;
  out.error /= values;
  out.unconverged /= values;
  out.iterations /= sought;
  return out;
}

static void degrees(void)
{
  printf("degree,method,iterations_one,us_iteration,us_one,us_all,deviation\n");
  for (int degree = 2; degree <= LAST_DEGREE; degree += degree < 6 ? 1 : 2) {
    for (int m = 0; m < METHODS; m++) {
      const struct solver_options options = paper_options(methods[m], 1e-6);
      const struct summary one = measure(degree, &options, true, (uint64_t)degree);
      const struct summary all = measure(degree, &options, false, (uint64_t)degree);
      const double one_root = at_once(&options) ? one.seconds / degree : one.seconds;
      printf("%d,%s,%.3f,%.4f,%.4f,%.4f,%.3f\n", degree, methods[m], one.iterations, one_root / one.iterations * 1e6,
             one_root * 1e6, all.seconds * 1e6, one.deviation);
    }
  }
}

static void tolerances(void)
{
  printf("eps,method,iterations_one,us_one,accurate_one,us_all,accurate_all,unconverged\n");
  for (int digits = 1; digits <= 15; digits++) {
    for (int m = 0; m < METHODS; m++) {
      const struct solver_options options = paper_options(methods[m], pow(10.0, -digits));
      const struct summary one = measure(PAPER_DEGREE, &options, true, 99);
      const struct summary all = measure(PAPER_DEGREE, &options, false, 99);
      printf("1e-%d,%s,%.3f,%.4f,%.4f,%.4f,%.4f,%.4f\n", digits, methods[m], one.iterations,
             (at_once(&options) ? one.seconds / PAPER_DEGREE : one.seconds) * 1e6, one.accurate, all.seconds * 1e6,
             all.accurate, all.unconverged);
    }
  }
}

static void order(void)
{
  static const double eps[] = {1e-2, 1e-4, 1e-6, 1e-8, 1e-10, 1e-12};
  printf("eps,method,order,accurate,log10_ratio\n");
  for (size_t e = 0; e < sizeof eps / sizeof eps[0]; e++) {
    for (int m = 0; m < METHODS; m++) {
      const struct solver_options options = paper_options(methods[m], eps[e]);
      double accurate[PAPER_DEGREE] = {0}, error[PAPER_DEGREE] = {0};
      uint64_t seed = 99;
      for (int i = 0; i < POLYNOMIALS; i++) {
        struct root_problem problem;
        struct root_set roots;
        random_problem(&seed, PAPER_DEGREE, &problem);
        find(&problem, &options, false, &roots);
        for (int r = 0; r < roots.count; r++) {
          const double ratio = measure_eq11(&problem, roots.root[r].re, roots.root[r].im);
          accurate[r] += ratio < 1.0;
          error[r] += log10(fmax(ratio, 1e-6));
        }
      }
      for (int r = 0; r < PAPER_DEGREE; r++)
        printf("%g,%s,%d,%.4f,%.3f\n", eps[e], methods[m], r + 1, accurate[r] / POLYNOMIALS, error[r] / POLYNOMIALS);
    }
  }
}

/* The effect of the cap of steps: every method with few and many steps a root, eps = 1e-6 and 1e-12. */
static void caps(void)
{
  static const int most[] = {5, 10, 20, 30, 50, 100, 200, 500, 2000};
  printf("cap,eps,method,iterations,unconverged,accurate\n");
  for (size_t k = 0; k < sizeof most / sizeof most[0]; k++)
    for (int tight = 0; tight < 2; tight++)
      for (int m = 0; m < METHODS; m++) {
        struct solver_options options = paper_options(methods[m], tight ? 1e-12 : 1e-6);
        options.max_iterations = most[k];
        const struct summary all = measure(PAPER_DEGREE, &options, false, 99);
        printf("%d,%g,%s,%.2f,%.4f,%.4f\n", most[k], options.tolerance, methods[m], all.iterations, all.unconverged,
               all.accurate);
      }
}

/* A variant: items set on top of the paper's form, in this order. */
struct variant {
  const char *method, *name;
  const char *item[4];
  double value[4];
};

static const struct variant variants[] = {
  {"newton", "paper", {NULL}, {0}},
  {"newton", "radii polygon", {"radii"}, {1}},
  {"newton", "horner charts", {"horner"}, {1}},
  {"newton", "stop rounding", {"stop"}, {1}},
  {"newton", "deflation composite", {"deflation"}, {1}},
  {"newton", "refine on", {"refine"}, {1}},
  {"newton", "all (form improved)", {"form"}, {1}},
  {"laguerre", "paper", {NULL}, {0}},
  {"laguerre", "radii polygon", {"radii"}, {1}},
  {"laguerre", "horner charts", {"horner"}, {1}},
  {"laguerre", "stop rounding", {"stop"}, {1}},
  {"laguerre", "deflation composite", {"deflation"}, {1}},
  {"laguerre", "refine on", {"refine"}, {1}},
  {"laguerre", "all (form improved)", {"form"}, {1}},
  {"aberth", "paper", {NULL}, {0}},
  {"aberth", "radii polygon", {"radii"}, {1}},
  {"aberth", "horner charts", {"horner"}, {1}},
  {"aberth", "stop rounding", {"stop"}, {1}},
  {"aberth", "rest on", {"rest"}, {1}},
  {"aberth", "update gauss_seidel", {"update"}, {1}},
  {"aberth", "all (form improved)", {"form"}, {1}},
  {"durand_kerner", "paper", {NULL}, {0}},
  {"durand_kerner", "all (form improved)", {"form"}, {1}},
};

static void improvements(void)
{
  printf("method,variant,eps,iterations,us_all,accurate,log10_ratio,unconverged\n");
  for (size_t v = 0; v < sizeof variants / sizeof variants[0]; v++) {
    for (int tight = 0; tight < 2; tight++) {
      struct method method = {.roots = paper_options(variants[v].method, tight ? 1e-12 : 1e-6)};
      for (int i = 0; i < 4 && variants[v].item[i] != NULL; i++)
        method_item_find(variants[v].item[i])->set(&method, variants[v].value[i]);
      const struct summary all = measure(PAPER_DEGREE, &method.roots, false, 99);
      printf("%s,%s,%g,%.2f,%.2f,%.4f,%.2f,%.4f\n", variants[v].method, variants[v].name, method.roots.tolerance,
             all.iterations, all.seconds * 1e6, all.accurate, all.error, all.unconverged);
    }
  }
}

int main(int argc, char **argv)
{
  static const struct {
    const char *name;
    void (*run)(void);
  } experiments[] = {
    {"degrees", degrees}, {"tolerances", tolerances}, {"order", order}, {"caps", caps}, {"improvements", improvements}};
  const bool once = argc == 3 && strcmp(argv[2], "once") == 0;
  if (once) repeats = 1;
  for (size_t k = 0; (argc == 2 || once) && k < sizeof experiments / sizeof experiments[0]; k++)
    if (strcmp(argv[1], experiments[k].name) == 0) return experiments[k].run(), 0;
  fputs("usage: random_experiments degrees|tolerances|order|caps|improvements [once]\n", stderr);
  return 2;
}
