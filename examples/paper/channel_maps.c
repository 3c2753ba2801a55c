/* Fig 13 to 17 as maps: what the channels iterations, roots, residual and deviation say of every pixel.
 *
 *     channel_maps SCENE WIDTH HEIGHT SOLVER NAME
 *
 * Writes NAME-iterations.png (iterations a root, 1 to 64, a step of colour for each factor), NAME-residual.png (eq 11's
 * ratio of the root that is the hit, 1e-2 to 1e6; 1, where accurate ends, is a quarter up) and NAME-deviation.png (from
 * the certified distance, relative, 1e-16 to 1; red: a hole or a phantom). White where there is nothing to tell. A row
 * of CSV on standard output: the means of iterations and roots a ray that has any, the share of the hits that meet eq
 * 11, the shares of the pixels that deviate by more than 1e-12, and that are holes or phantoms.
 */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "pictures.h"

enum { ITERATIONS, ROOTS, RESIDUAL, DEVIATION, PATCH, VALUES };
enum map { MAP_ITERATIONS, MAP_RESIDUAL, MAP_DEVIATION, MAPS };

#define RIGHT 1e-12 /* a deviation of less is called none */

static void colour(enum map map, const float pixel[VALUES], float out_rgb[3])
{
  const double roots = (double)pixel[ROOTS], residual = (double)pixel[RESIDUAL], off = (double)pixel[DEVIATION];
  const bool hit = pixel[PATCH] >= 0;
  for (int c = 0; c < 3; c++) out_rgb[c] = 1;
  if (map == MAP_ITERATIONS && roots > 0) picture_scale(log2((double)pixel[ITERATIONS] / roots) / 6, out_rgb);
  if (map == MAP_RESIDUAL && hit) picture_scale((log10(residual) + 2) / 8, out_rgb);
  if (map == MAP_DEVIATION && hit) picture_scale((log10(off) + 16) / 16, out_rgb);
  if (map == MAP_DEVIATION && isinf(off)) out_rgb[1] = out_rgb[2] = 0;
}

static void print_row(size_t pixels, const float *values)
{
  double iterations = 0, roots = 0, rays = 0, hits = 0, accurate = 0, off = 0, wrong = 0;
  for (size_t p = 0; p < pixels; p++) {
    const float *pixel = values + p * VALUES;
    iterations += (double)pixel[ITERATIONS], roots += (double)pixel[ROOTS], rays += pixel[ROOTS] > 0;
    hits += pixel[PATCH] >= 0, accurate += pixel[PATCH] >= 0 && pixel[RESIDUAL] < 1;
    off += (double)pixel[DEVIATION] > RIGHT, wrong += isinf(pixel[DEVIATION]);
  }
  printf("%.2f,%.2f,%.4f,%.4f,%.4f\n", iterations / rays, roots / rays, accurate / hits, off / (double)pixels,
         wrong / (double)pixels);
}

int main(int argc, char **argv)
{
  static const char *const names[MAPS] = {"iterations", "residual", "deviation"};
  const int width = argc == 6 ? atoi(argv[2]) : 0, height = argc == 6 ? atoi(argv[3]) : 0;
  if (width < 1 || height < 1) {
    fputs("usage: channel_maps SCENE WIDTH HEIGHT SOLVER NAME\n", stderr);
    return 2;
  }
  const size_t pixels = (size_t)width * (size_t)height;
  float *values = picture_channels(argv[1], (size_t)width, (size_t)height, argv[4],
                                   "iterations,roots,residual,deviation,patch");
  if (values == NULL) return 3;
  bool good = true;
  for (int m = 0; m < MAPS && good; m++) {
    struct image image;
    char path[4096];
    good = snprintf(path, sizeof path, "%s-%s.png", argv[5], names[m]) < (int)sizeof path &&
           picture_begin((size_t)width, (size_t)height, &image);
    if (!good) break;
    for (size_t p = 0; p < pixels; p++) colour((enum map)m, values + p * VALUES, image.value + 3 * p);
    good = picture_end(&image, path);
  }
  print_row(pixels, values);
  free(values);
  return good ? 0 : 4;
}
