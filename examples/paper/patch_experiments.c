/* The paper's experiments on a patch (section 4, Fig 13-15): CSV on standard output.
 *
 *     patch_experiments SCENE WIDTH HEIGHT
 *
 * Every pixel's ray against the first patch of the scene, in the order of the picture's lines: Sylvester's determinant
 * in the power basis (and beyond the paper, in scaled Bernstein form), degree 18, all roots. Against eps: iterations a
 * root, CPU time of the solver a pixel, and the shares of roots, and of pixels all of whose roots, that meet eq 11;
 * from Aberth's start values (cold), and from the roots of the ray before (previous).
 */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "algebra/sylvester.h"
#include "base/clock.h"
#include "geometry/vector.h"
#include "language/language.h"
#include "measure.h"

enum { BIDEGREE = 3, DEGREE = 18 };

static const char *const methods[] = {"newton", "laguerre", "aberth", "durand_kerner"};

/* Bernstein coefficients b[0], b[stride], ... of a cubic to power coefficients. */
static void cubic_to_power(double *b, int stride)
{
  const double b0 = b[0], b1 = b[stride], b2 = b[2 * stride], b3 = b[3 * stride];
  b[stride] = 3.0 * (b1 - b0);
  b[2 * stride] = 3.0 * (b2 - 2.0 * b1 + b0);
  b[3 * stride] = b3 - 3.0 * (b2 - b1) - b0;
}

/* Eq 3: the plane of this normal through the point, in the patch's parameters. */
static void plane_polynomial(const struct scene_patch *patch, const double normal[3], const double point[3],
                             enum basis basis, double out[16])
{
  static const double choose[4] = {1.0, 3.0, 3.0, 1.0};
  for (int i = 0; i < 4; i++) {
    for (int j = 0; j < 4; j++) {
      double from[3];
      for (int k = 0; k < 3; k++) from[k] = patch->P[i][j][k] - point[k];
      out[4 * i + j] = vector_dot(normal, from) * (basis == BASIS_BERNSTEIN ? choose[i] * choose[j] : 1.0);
    }
  }
  for (int i = 0; basis == BASIS_POWER && i < 4; i++) cubic_to_power(out + 4 * i, 1);
  for (int j = 0; basis == BASIS_POWER && j < 4; j++) cubic_to_power(out + j, 4);
}

/* r(u) of the ray through the point (s,t) of the picture; eq 2 with two planes that are perpendicular to each other. */
static void pixel_polynomial(const struct scene *scene, double s, double t, enum basis basis, double out_c[DEGREE + 1])
{
  const struct scene_camera *camera = &scene->camera;
  double d[3], first[3], second[3], a[16], b[16];
  for (int k = 0; k < 3; k++) d[k] = camera->direction[k] + (s - 0.5) * camera->right[k] + (0.5 - t) * camera->up[k];
  vector_cross(d, camera->right, first);
  vector_cross(d, first, second);
  const double first_scale = 1.0 / vector_length(first), second_scale = 1.0 / vector_length(second);
  for (int k = 0; k < 3; k++) {
    first[k] *= first_scale;
    second[k] *= second_scale;
  }
  plane_polynomial(&scene->patches[0], first, camera->location, basis, a);
  plane_polynomial(&scene->patches[0], second, camera->location, basis, b);
  sylvester_determinant(BIDEGREE, BIDEGREE, a, b, out_c);
}

struct totals {
  double iterations, roots, seconds, accurate_roots, accurate_pixels, pixels;
};

static void solve_pixel(enum basis basis, const double c[], const struct solver_options *options,
                        struct solver_warm *warm, struct totals *totals)
{
  struct root_problem problem = {.degree = DEGREE, .basis = basis};
  struct root_estimates roots;
  memcpy(problem.c, c, sizeof problem.c[0] * (DEGREE + 1));
  if (c[0] == 0.0 || c[DEGREE] == 0.0) return; /* a root at 0 or at infinity: not of degree 18 */
  const double start = clock_seconds(CLOCK_THREAD_CPUTIME_ID);
  options->solver->find(&problem, options, warm, &roots);
  totals->seconds += clock_seconds(CLOCK_THREAD_CPUTIME_ID) - start;
  int accurate = 0;
  warm->count = 0;
  for (int i = 0; i < roots.count; i++) {
    totals->iterations += roots.iterations[i];
    totals->roots += roots.iterations[i] > 0;
    accurate += measure_eq11(&problem, roots.re[i], roots.im[i]) < 1.0;
    if (isfinite(roots.re[i]) && isfinite(roots.im[i])) {
      warm->re[warm->count] = roots.re[i];
      warm->im[warm->count++] = roots.im[i];
    }
  }
  totals->accurate_roots += accurate;
  totals->accurate_pixels += accurate == DEGREE;
  totals->pixels += 1.0;
}

static void experiment(enum basis basis, const double *c, size_t pixels)
{
  for (int digits = 1; digits <= 14; digits++) {
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
          solve_pixel(basis, c + p * (DEGREE + 1), &options, &warm, &totals);
        }
        printf("1e-%d,%s,%s,%s,%.3f,%.3f,%.4f,%.4f\n", digits, methods[m], previous != 0 ? "previous" : "cold",
               basis == BASIS_POWER ? "power" : "bernstein", totals.iterations / totals.roots,
               totals.seconds / totals.pixels * 1e6, totals.accurate_pixels / totals.pixels,
               totals.accurate_roots / totals.pixels / DEGREE);
      }
    }
  }
}

static void tell(void *context, const char *text, size_t length)
{
  (void)context;
  fwrite(text, 1, length, stderr);
}

int main(int argc, char **argv)
{
  if (argc != 4) {
    fputs("usage: patch_experiments SCENE WIDTH HEIGHT\n", stderr);
    return 2;
  }
  const int width = atoi(argv[2]), height = atoi(argv[3]);
  const struct language_settings settings = {.image_width = width, .image_height = height, .tolerance = NAN};
  struct diagnostics diagnostics = {.tell = tell};
  struct scene *scene = NULL;
  if (width < 1 || height < 1 || language_load(argv[1], &settings, &diagnostics, &scene) != STATUS_OK) return 3;
  const size_t pixels = (size_t)width * (size_t)height;
  double *c = malloc(pixels * (DEGREE + 1) * sizeof *c);
  if (c == NULL) return 5;
  printf("eps,method,start,basis,iterations,us_pixel,accurate_pixels,accurate_roots\n");
  for (int basis = BASIS_POWER; basis >= BASIS_BERNSTEIN; basis--) {
    for (size_t p = 0; p < pixels; p++) {
      const double s = ((double)(p % (size_t)width) + 0.5) / width, t = ((double)(p / (size_t)width) + 0.5) / height;
      pixel_polynomial(scene, s, t, (enum basis)basis, c + p * (DEGREE + 1));
    }
    experiment((enum basis)basis, c, pixels);
  }
  free(c);
  scene_destroy(scene);
  return 0;
}
