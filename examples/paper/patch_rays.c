/* r(u) of the rays of a picture. See patch_rays.h. */
#include "patch_rays.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "algebra/sylvester.h"
#include "geometry/vector.h"
#include "language/language.h"

enum { BIDEGREE = 3 };

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

/* r(u) of the ray through the point (s,t) of the picture: eq 2 with two perpendicular planes. */
static void pixel_polynomial(const struct scene *scene, double s, double t, enum basis basis,
                             double out_c[PATCH_DEGREE + 1])
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

static void tell(void *context, const char *text, size_t length)
{
  (void)context;
  fwrite(text, 1, length, stderr);
}

double *patch_polynomials(const char *scene_path, size_t width, size_t height, enum basis basis)
{
  const struct language_settings settings = {.image_width = (int)width, .image_height = (int)height, .tolerance = NAN};
  struct diagnostics diagnostics = {.tell = tell};
  struct scene *scene = NULL;
  if (language_load(scene_path, &settings, &diagnostics, &scene) != STATUS_OK) return NULL;
  double *c = malloc(width * height * (PATCH_DEGREE + 1) * sizeof *c);
  for (size_t p = 0; c != NULL && p < width * height; p++) {
    const double s = ((double)(p % width) + 0.5) / (double)width, t = ((double)(p / width) + 0.5) / (double)height;
    pixel_polynomial(scene, s, t, basis, c + p * (PATCH_DEGREE + 1));
  }
  scene_destroy(scene);
  return c;
}
