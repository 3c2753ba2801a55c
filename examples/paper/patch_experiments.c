/* The paper's experiments on a patch (section 4, Fig 13-15): CSV on standard output.
 *
 *     patch_experiments SCENE WIDTH HEIGHT [DIGITS]     with DIGITS only eps = 1e-DIGITS
 *
 * Every pixel's ray against the first patch of the scene, in the order of the picture's lines: Sylvester's determinant
 * in the power basis, degree 18, all roots. Against eps: iterations a root; CPU time of the solver a pixel; the shares
 * of roots that meet eq 11, and of pixels all of whose roots do; from Aberth's start values (cold), and from the roots
 * of the ray before (previous).
 */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/clock.h"
#include "measure.h"
#include "patch_rays.h"

enum { DEGREE = PATCH_DEGREE };

static const char *const methods[] = {"newton", "laguerre", "aberth", "durand_kerner"};

struct totals {
  double iterations, roots, seconds, accurate_roots, accurate_pixels, pixels;
};

static void solve_pixel(const double c[], const struct solver_options *options, struct solver_warm *warm,
                        struct totals *totals)
{
  struct root_problem problem = {.degree = DEGREE, .basis = BASIS_POWER};
  struct root_set roots;
  memcpy(problem.c, c, sizeof problem.c[0] * (DEGREE + 1));
  if (c[0] == 0.0 || c[DEGREE] == 0.0) return; /* it has a root at 0 or at infinity, and is not of degree 18 */
  const double start = clock_seconds(CLOCK_THREAD_CPUTIME_ID);
  options->solver->find(&problem, options, warm, &roots);
  totals->seconds += clock_seconds(CLOCK_THREAD_CPUTIME_ID) - start;
  int accurate = 0;
  warm->count = 0;
  for (int i = 0; i < roots.count; i++) {
    totals->iterations += roots.root[i].iterations;
    totals->roots += roots.root[i].iterations > 0;
    accurate += measure_eq11(&problem, roots.root[i].re, roots.root[i].im) < 1.0;
    if (isfinite(roots.root[i].re) && isfinite(roots.root[i].im)) {
      warm->re[warm->count] = roots.root[i].re;
      warm->im[warm->count++] = roots.root[i].im;
    }
  }
  totals->accurate_roots += accurate;
  totals->accurate_pixels += accurate == DEGREE;
  totals->pixels += 1.0;
}

static void experiment(const double *c, size_t pixels, int only)
{
  for (int digits = only > 0 ? only : 1; digits <= (only > 0 ? only : 14); digits++) {
    for (size_t m = 0; m < sizeof methods / sizeof methods[0]; m++) {
      for (int previous = 0; previous < 2; previous++) {
        struct solver_options options;
        solver_options_default(solver_find(methods[m], strlen(methods[m])), &options);
        solver_options_form(&options, false);
        options.tolerance = pow(10.0, -digits);
        options.max_iterations = 500;
        struct solver_warm warm = {0};
        struct totals totals = {0};
        for (size_t p = 0; p < pixels; p++) {
          if (previous == 0) warm.count = 0;
          solve_pixel(c + p * (DEGREE + 1), &options, &warm, &totals);
        }
        printf("1e-%d,%s,%s,%.3f,%.3f,%.4f,%.4f\n", digits, methods[m], previous != 0 ? "previous" : "cold",
               totals.iterations / totals.roots, totals.seconds / totals.pixels * 1e6,
               totals.accurate_pixels / totals.pixels, totals.accurate_roots / totals.pixels / DEGREE);
      }
    }
  }
}

int main(int argc, char **argv)
{
  const bool good = argc == 4 || argc == 5;
  const int width = good ? atoi(argv[2]) : 0, height = good ? atoi(argv[3]) : 0, only = argc == 5 ? atoi(argv[4]) : 0;
  if (width < 1 || height < 1) {
    fputs("usage: patch_experiments SCENE WIDTH HEIGHT [DIGITS]\n", stderr);
    return 2;
  }
  printf("eps,method,start,iterations,us_pixel,accurate_pixels,accurate_roots\n");
  double *c = patch_polynomials(argv[1], (size_t)width, (size_t)height, BASIS_POWER);
  if (c == NULL) return 3;
  experiment(c, (size_t)width * (size_t)height, only);
  free(c);
  return 0;
}
