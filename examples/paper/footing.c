/* The paper's three methods on an equal footing: CSV on standard output.
 *
 *     footing degrees [once]             Fig 2, 4, 5: against the degree, eps = 1e-6
 *     footing tolerances                 Fig 9: against eps, degree 18
 *     footing patch SCENE WIDTH HEIGHT   Fig 14: the rays of a picture, against eps
 *
 * Each method scalar as printed and on lanes, one polynomial a lane (forms.h); CPU time, the median of rounds in which
 * all of them take turns, so that a busy machine slows all alike; and operations, counted, by our Table 1 and the
 * paper's.
 */
#include <float.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/clock.h"
#include "forms.h"
#include "measure.h"
#include "patch_rays.h"

enum {
  POLYNOMIALS = 100,
  PAPER_DEGREE = 18,
  MAX_ITERATIONS = 500,
  ROUNDS = 21,      /* at most */
  LAST_DIGIT = 13,  /* of eps = 1e-1 ... */
  COLD_DIGIT = 6,   /* where the patch is also measured from Aberth's start values */
  MANY_SWEEPS = 11, /* with more digits Aberth's method hardly meets eq 10, and uses all sweeps it may */
};

/* Seconds a polynomial. */
struct measured {
  struct batch_totals totals;
  double seconds;
};

/* The number of rounds, and of runs in each, so that a turn is long enough for the clock. */
struct effort {
  int rounds, repeat;
};

static int most_rounds = ROUNDS;

static void measure_all(struct batch batch, struct effort effort, struct measured out[PAPER_METHODS][FORMS])
{
  static double seconds[PAPER_METHODS][FORMS][ROUNDS];
  const int rounds = effort.rounds < most_rounds ? effort.rounds : most_rounds;
  for (int round = 0; round < rounds; round++) {
    for (int m = 0; m < PAPER_METHODS; m++) {
      for (int f = 0; f < FORMS; f++) {
        const double start = clock_seconds(CLOCK_THREAD_CPUTIME_ID);
        for (int k = 0; k < effort.repeat; k++)
          form_run((enum form)f, (enum paper_method)m, &batch, &out[m][f].totals, NULL);
        seconds[m][f][round] = (clock_seconds(CLOCK_THREAD_CPUTIME_ID) - start) / effort.repeat / (double)batch.count;
      }
    }
  }
  for (int m = 0; m < PAPER_METHODS; m++)
    for (int f = 0; f < FORMS; f++) out[m][f].seconds = measure_median((size_t)rounds, seconds[m][f]);
}

static double *random_polynomials(int degree, uint64_t seed)
{
  const size_t terms = (size_t)degree + 1;
  double *c = malloc(POLYNOMIALS * terms * sizeof *c);
  for (size_t p = 0; c != NULL && p < POLYNOMIALS; p++) measure_random_polynomial(&seed, degree, c + p * terms);
  return c;
}

/* What is timed at one degree: the first root (Aberth's method: all); the same with an eps that never ends it, after a
 * few iterations and after many; all roots. */
enum task { ONE, FEW, MANY, ALL, TASKS };
enum { FEW_ITERATIONS = 4, MANY_ITERATIONS = 20 };

/* Seconds of an iteration of one root, without its start and what follows the root. */
static double iterating(const struct measured *few, const struct measured *many, double roots)
{
  const double more = many->totals.iterations / many->totals.sought - few->totals.iterations / few->totals.sought;
  return (many->seconds - few->seconds) / roots / more;
}

static void degree_rows(int degree, struct measured found[TASKS][PAPER_METHODS][FORMS])
{
  for (int m = 0; m < PAPER_METHODS; m++) {
    for (int f = 0; f < FORMS; f++) {
      const struct measured *one = &found[ONE][m][f], *all = &found[ALL][m][f];
      const double roots = m == PAPER_ABERTH ? degree : 1, iterations = one->totals.iterations / one->totals.sought;
      printf("%d,%s,%s,%.3f,%.4f,%.4f,%.4f,%.0f,%.0f,%.0f,%.0f,%.1f,%.1f\n", degree, paper_method_names[m],
             form_names[f], iterations, iterating(&found[FEW][m][f], &found[MANY][m][f], roots) * 1e6,
             one->seconds / roots * 1e6, all->seconds * 1e6, one->totals.operations / roots / POLYNOMIALS,
             all->totals.operations / POLYNOMIALS, one->totals.operations_paper / roots / POLYNOMIALS,
             all->totals.operations_paper / POLYNOMIALS, one->totals.operations / one->totals.iterations,
             one->totals.operations_paper / one->totals.iterations);
    }
  }
}

static bool degrees(void)
{
  printf(
    "degree,method,form,iterations_one,us_iteration,us_one,us_all,operations_one,operations_all,paper_one,paper_all,"
    "operations_iteration,paper_iteration\n");
  for (int degree = 2; degree <= FORMS_DEGREE; degree += degree < 6 ? 1 : 2) {
    double *c = random_polynomials(degree, (uint64_t)degree);
    if (c == NULL) return false;
    struct measured found[TASKS][PAPER_METHODS][FORMS];
    struct batch batch = {degree, POLYNOMIALS, c, 1e-6, MAX_ITERATIONS, false, true};
    measure_all(batch, (struct effort){ROUNDS, 4}, found[ONE]);
    batch.tolerance = DBL_MIN, batch.max_iterations = FEW_ITERATIONS;
    measure_all(batch, (struct effort){ROUNDS, 4}, found[FEW]);
    batch.max_iterations = MANY_ITERATIONS;
    measure_all(batch, (struct effort){ROUNDS, 4}, found[MANY]);
    batch.tolerance = 1e-6, batch.max_iterations = MAX_ITERATIONS, batch.first_only = false;
    measure_all(batch, (struct effort){ROUNDS, 2}, found[ALL]);
    degree_rows(degree, found);
    free(c);
  }
  return true;
}

/* Rows against eps for one batch of polynomials. */
static void against_eps(struct batch batch, const char *start, int first, int last, struct effort effort)
{
  for (int digits = first; digits <= last; digits++) {
    struct measured found[PAPER_METHODS][FORMS];
    if (digits > MANY_SWEEPS) effort = (struct effort){1, 1};
    batch.tolerance = pow(10.0, -digits);
    measure_all(batch, effort, found);
    for (int m = 0; m < PAPER_METHODS; m++) {
      for (int f = 0; f < FORMS; f++) {
        const struct batch_totals *totals = &found[m][f].totals;
        printf("1e-%d,%s,%s,%s,%.3f,%.4f,%.0f,%.0f\n", digits, start, paper_method_names[m], form_names[f],
               totals->iterations / totals->sought, found[m][f].seconds * 1e6, totals->operations / (double)batch.count,
               totals->operations_paper / (double)batch.count);
      }
    }
  }
}

static bool tolerances(void)
{
  double *c = random_polynomials(PAPER_DEGREE, 99);
  if (c == NULL) return false;
  printf("eps,start,method,form,iterations,us_all,operations_all,paper_all\n");
  against_eps((struct batch){PAPER_DEGREE, POLYNOMIALS, c, 0, MAX_ITERATIONS, false, false}, "cold", 1, LAST_DIGIT,
              (struct effort){ROUNDS, 2});
  free(c);
  return true;
}

/* Drops those that have a root at 0 or at infinity, which are not of degree 18. */
static size_t keep_whole(size_t count, double *c)
{
  size_t kept = 0;
  for (size_t p = 0; p < count; p++) {
    const double *from = c + p * (PATCH_DEGREE + 1);
    if (from[0] == 0.0 || from[PATCH_DEGREE] == 0.0) continue;
    memmove(c + kept++ * (PATCH_DEGREE + 1), from, (PATCH_DEGREE + 1) * sizeof *c);
  }
  return kept;
}

static bool patch(const char *scene, int width, int height)
{
  const size_t count = (size_t)width * (size_t)height;
  double *c = patch_polynomials(scene, (size_t)width, (size_t)height, BASIS_POWER);
  if (c == NULL) return false;
  printf("eps,start,method,form,iterations,us_pixel,operations_pixel,paper_pixel\n");
  struct batch batch = {PATCH_DEGREE, keep_whole(count, c), c, 0, MAX_ITERATIONS, true, false};
  against_eps(batch, "previous", 1, LAST_DIGIT, (struct effort){3, 1});
  batch.previous = false;
  against_eps(batch, "cold", COLD_DIGIT, COLD_DIGIT, (struct effort){3, 1});
  free(c);
  return true;
}

int main(int argc, char **argv)
{
  const char *what = argc > 1 ? argv[1] : "";
  const bool once = argc == 3 && strcmp(argv[2], "once") == 0;
  if (once) most_rounds = 1;
  if ((argc == 2 || once) && strcmp(what, "degrees") == 0) return degrees() ? 0 : 5;
  if (argc == 2 && strcmp(what, "tolerances") == 0) return tolerances() ? 0 : 5;
  if (argc == 5 && strcmp(what, "patch") == 0 && atoi(argv[3]) > 0 && atoi(argv[4]) > 0)
    return patch(argv[2], atoi(argv[3]), atoi(argv[4])) ? 0 : 3;
  fputs("usage: footing degrees [once] | tolerances | patch SCENE WIDTH HEIGHT\n", stderr);
  return 2;
}
