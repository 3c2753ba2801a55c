/* What the paper says of its methods without a figure: CSV on standard output.
 *
 *     claims lower       2.1: patches of lower degree cost less
 *     claims nearest     3.2: Laguerre's method goes to the root nearest to the start
 *     claims starts      3.3: Aberth's method converges from any distinct starts
 *     claims slopes      3.1 to 3.3: the orders of convergence, from the iterates
 */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "algebra/complex_number.h"
#include "algebra/sylvester.h"
#include "base/clock.h"
#include "forms.h"
#include "measure.h"

enum { POLYNOMIALS = 100, PAPER_DEGREE = 18, ROUNDS = 9 };

static struct solver_options paper_options(enum paper_method method, double tolerance)
{
  const char *name = paper_method_names[method];
  struct solver_options options;
  solver_options_default(solver_find(name, strlen(name)), &options);
  solver_options_form(&options, false);
  options.tolerance = tolerance, options.max_iterations = 500;
  return options;
}

/* ---- 2.1 ---- */

/* Random plane polynomials of one bidegree, and the median time of making a determinant. */
static double make_resultants(int n, double c[])
{
  const size_t terms = 2 * (size_t)n * (size_t)n + 1;
  double seconds[ROUNDS];
  for (int round = 0; round < ROUNDS; round++) {
    uint64_t seed = 7;
    double spent = 0;
    for (size_t p = 0; p < POLYNOMIALS; p++) {
      double a[16] = {0}, b[16] = {0};
      for (int i = 0; i <= n; i++) measure_random_polynomial(&seed, n, a + 4 * i);
      for (int i = 0; i <= n; i++) measure_random_polynomial(&seed, n, b + 4 * i);
      const double start = clock_seconds(CLOCK_THREAD_CPUTIME_ID);
      for (int k = 0; k < 10; k++) sylvester_determinant(n, n, a, b, c + p * terms);
      spent += (clock_seconds(CLOCK_THREAD_CPUTIME_ID) - start) / 10;
    }
    seconds[round] = spent / POLYNOMIALS;
  }
  return measure_median(ROUNDS, seconds);
}

static void lower(void)
{
  printf("bidegree,degree,ns_resultant,ns_newton,ns_laguerre,ns_aberth\n");
  static double c[POLYNOMIALS * (PAPER_DEGREE + 1)];
  for (int n = 1; n <= 3; n++) {
    printf("%d,%d,%.0f", n, 2 * n * n, make_resultants(n, c) * 1e9);
    const struct batch batch = {2 * n * n, POLYNOMIALS, c, 1e-6, 500, false, false};
    for (int m = 0; m < PAPER_METHODS; m++) {
      double seconds[ROUNDS];
      struct batch_totals totals;
      for (int round = 0; round < ROUNDS; round++) {
        const double start = clock_seconds(CLOCK_THREAD_CPUTIME_ID);
        for (int k = 0; k < 4; k++) form_run(FORM_SCALAR, (enum paper_method)m, &batch, &totals, NULL);
        seconds[round] = (clock_seconds(CLOCK_THREAD_CPUTIME_ID) - start) / 4 / POLYNOMIALS;
      }
      printf(",%.0f", measure_median(ROUNDS, seconds) * 1e9);
    }
    putchar('\n');
  }
}

/* ---- 3.2 ---- */

enum { BASIN_DEGREE = 7, BASIN_PIXELS = 240, BASIN_STEPS = 100, STARTS = 400 };

/* A step of eq 7 or eq 8 alone, without any safeguards. */
static struct complex_number plain_step(enum paper_method method, const struct root_problem *problem,
                                        struct complex_number z)
{
  const int n = problem->degree;
  struct complex_number p = {problem->c[n], 0}, slope = {0, 0}, half = {0, 0};
  for (int k = n - 1; k >= 0; k--) {
    half = complex_add(complex_multiply(half, z), slope);
    slope = complex_add(complex_multiply(slope, z), p);
    p = complex_multiply(p, z);
    p.re += problem->c[k];
  }
  if (p.re == 0 && p.im == 0) return p;
  if (method == PAPER_NEWTON) return complex_divide(complex_scale(-1, p), slope);
  const struct complex_number square = complex_scale(n - 1.0, complex_multiply(slope, slope));
  const struct complex_number product = complex_scale(2.0 * n, complex_multiply(p, half));
  const struct complex_number root = complex_sqrt(complex_scale(n - 1.0, complex_subtract(square, product)));
  const struct complex_number plus = complex_add(slope, root), minus = complex_subtract(slope, root);
  return complex_divide(complex_scale(-n, p), complex_norm(plus) >= complex_norm(minus) ? plus : minus);
}

/* The root that the start leads to; -1: none within BASIN_STEPS. */
static int goes_to(enum paper_method method, const struct root_problem *problem, const struct root_set *roots,
                   struct complex_number z)
{
  for (int step = 0; step < BASIN_STEPS; step++) {
    const struct complex_number move = plain_step(method, problem, z);
    z = complex_add(z, move);
    if (complex_norm(move) < 1e-20 * complex_norm(z)) break;
  }
  for (int k = 0; k < roots->count; k++)
    if (hypot(roots->root[k].re - z.re, roots->root[k].im - z.im) < 1e-6) return k;
  return -1;
}

static int nearest_root(const struct root_set *roots, struct complex_number z)
{
  int best = 0;
  for (int k = 1; k < roots->count; k++) {
    const struct root *root = &roots->root[k], *other = &roots->root[best];
    if (hypot(root->re - z.re, root->im - z.im) < hypot(other->re - z.re, other->im - z.im)) best = k;
  }
  return best;
}

static void random_problem(uint64_t *seed, int degree, struct root_problem *out, struct root_set *out_roots)
{
  struct solver_options options;
  *out = (struct root_problem){.degree = degree, .basis = BASIS_POWER};
  measure_random_polynomial(seed, degree, out->c);
  solver_options_default(solver_find("aberth", 6), &options);
  const struct polynomial p = {degree, BASIS_POWER, out->c, NULL};
  solver_solve(&p, &options, NULL, out_roots);
}

static void nearest(void)
{
  printf("degree,method,nearest,lost,starts\n");
  for (int degree = BASIN_DEGREE; degree <= PAPER_DEGREE; degree += PAPER_DEGREE - BASIN_DEGREE) {
    for (int m = 0; m < PAPER_ABERTH; m++) {
      uint64_t seed = 5;
      int near = 0, lost = 0;
      for (int p = 0; p < POLYNOMIALS; p++) {
        struct root_problem problem;
        struct root_set roots;
        random_problem(&seed, degree, &problem, &roots);
        for (int s = 0; s < STARTS; s++) {
          const struct complex_number z = {4 * measure_random(&seed) - 2, 4 * measure_random(&seed) - 2};
          const int root = goes_to((enum paper_method)m, &problem, &roots, z);
          near += root == nearest_root(&roots, z), lost += root < 0;
        }
      }
      const double all = (double)POLYNOMIALS * STARTS;
      printf("%d,%s,%.4f,%.4f,%.0f\n", degree, paper_method_names[m], near / all, lost / all, all);
    }
  }
}

/* ---- 3.3 ---- */

enum { MOST_SWEEPS = 2000 };

/* Eq 9 alone, without safeguards: each sweep moves all values, from those of the last sweep. Returns whether all have
 * settled. */
static bool all_rest(const struct root_problem *problem, struct complex_number z[])
{
  const int n = problem->degree;
  const struct complex_number one = {1, 0};
  for (int sweep = 0; sweep < MOST_SWEEPS; sweep++) {
    struct complex_number move[PAPER_DEGREE];
    double longest = 0;
    for (int i = 0; i < n; i++) {
      const struct complex_number newton = plain_step(PAPER_NEWTON, problem, z[i]); /* -N_i */
      struct complex_number sum = {0, 0};
      for (int j = 0; j < n; j++)
        if (j != i) sum = complex_add(sum, complex_divide(one, complex_subtract(z[i], z[j])));
      move[i] = complex_divide(newton, complex_add(one, complex_multiply(newton, sum)));
      const double length = complex_modulus(move[i]) / fmax(1, complex_modulus(z[i]));
      if (!isfinite(length)) return false;
      longest = fmax(longest, length);
    }
    for (int i = 0; i < n; i++) z[i] = complex_add(z[i], move[i]);
    if (longest < 1e-10) return true;
  }
  return false;
}

static void starts(void)
{
  static const char *const kinds[] = {"complex", "real"};
  printf("degree,starts,rest\n");
  for (int degree = BASIN_DEGREE; degree <= PAPER_DEGREE; degree += PAPER_DEGREE - BASIN_DEGREE) {
    for (int kind = 0; kind < 2; kind++) {
      uint64_t seed = 13;
      int rest = 0;
      for (int p = 0; p < 4 * POLYNOMIALS; p++) {
        struct root_problem problem = {.degree = degree, .basis = BASIS_POWER};
        struct complex_number z[PAPER_DEGREE];
        measure_random_polynomial(&seed, degree, problem.c);
        for (int i = 0; i < degree; i++) {
          z[i].re = 4 * measure_random(&seed) - 2;
          z[i].im = 4 * measure_random(&seed) - 2;
          if (kind == 1) z[i].im = 0;
        }
        rest += all_rest(&problem, z);
      }
      printf("%d,%s,%.4f\n", degree, kinds[kind], rest / (4.0 * POLYNOMIALS));
    }
  }
}

/* ---- the orders ---- */

/* All values of one solve. */
enum { STEPS_KEPT = 600 };
struct ways {
  int steps[PAPER_DEGREE];
  struct complex_number at[PAPER_DEGREE][STEPS_KEPT];
};

static void keep(void *context, int root, int step, double re, double im)
{
  struct ways *ways = context;
  if (step >= STEPS_KEPT) return;
  ways->at[root][step] = (struct complex_number){re, im};
  ways->steps[root] = step + 1;
}

/* The sums of a line through points (x, y). */
struct line {
  double n, x, y, xx, xy;
};

/* Errors between these, relative to the root or 1, are small enough to show the order, and far enough from rounding. */
#define NEAR 3e-2
#define ROUNDED 1e-13

static void take_step(struct line *line, double error, double next)
{
  if (!(error < NEAR && next > ROUNDED && next < error)) return;
  const double x = log10(error), y = log10(next);
  line->n += 1, line->x += x, line->y += y, line->xx += x * x, line->xy += x * y;
}

static double error_at(const struct ways *ways, int root, int step)
{
  const struct complex_number last = ways->at[root][ways->steps[root] - 1], z = ways->at[root][step];
  return hypot(z.re - last.re, z.im - last.im) / fmax(1, complex_modulus(last));
}

/* Newton and Laguerre: each root by itself. Aberth: the largest error of all roots, which make one iteration. */
static void take_steps(const struct ways *ways, enum paper_method method, struct line *line)
{
  if (method == PAPER_ABERTH) {
    for (int step = 0; step + 2 < ways->steps[0]; step++) {
      double error = 0, next = 0;
      for (int root = 0; root < PAPER_DEGREE; root++)
        error = fmax(error, error_at(ways, root, step)), next = fmax(next, error_at(ways, root, step + 1));
      take_step(line, error, next);
    }
    return;
  }
  for (int root = 0; root < PAPER_DEGREE; root++)
    for (int step = 0; step + 2 < ways->steps[root]; step++)
      take_step(line, error_at(ways, root, step), error_at(ways, root, step + 1));
}

static void orders(void)
{
  printf("method,order,steps\n");
  static struct ways ways;
  for (int m = 0; m < PAPER_METHODS; m++) {
    const struct solver_watch watch = {keep, &ways};
    struct solver_options options = paper_options((enum paper_method)m, 1e-14);
    struct line line = {0};
    uint64_t seed = 11;
    options.watch = &watch;
    for (int p = 0; p < 4 * POLYNOMIALS; p++) {
      struct root_problem problem = {.degree = PAPER_DEGREE, .basis = BASIS_POWER};
      struct root_set roots;
      measure_random_polynomial(&seed, PAPER_DEGREE, problem.c);
      memset(ways.steps, 0, sizeof ways.steps);
      options.solver->find(&problem, &options, NULL, &roots);
      take_steps(&ways, (enum paper_method)m, &line);
    }
    const double slope = (line.n * line.xy - line.x * line.y) / (line.n * line.xx - line.x * line.x);
    printf("%s,%.2f,%.0f\n", paper_method_names[m], slope, line.n);
  }
}

int main(int argc, char **argv)
{
  static const struct {
    const char *name;
    void (*run)(void);
  } claims[] = {{"lower", lower}, {"nearest", nearest}, {"starts", starts}, {"slopes", orders}};
  for (size_t k = 0; argc == 2 && k < sizeof claims / sizeof claims[0]; k++)
    if (strcmp(argv[1], claims[k].name) == 0) return claims[k].run(), 0;
  fputs("usage: claims lower | nearest | starts | slopes\n", stderr);
  return 2;
}
