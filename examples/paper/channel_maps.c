/* Fig 13 to 17 as maps: what the solver did for every pixel, line by line (pictures.h), and how far it is off.
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

enum map { MAP_ITERATIONS, MAP_RESIDUAL, MAP_DEVIATION, MAPS };

#define RIGHT 1e-12 /* a smaller deviation counts as none */

/* The relative distance of the solver's answer from the certified one; infinite if only one of them is a hit. */
static double deviation(const struct picture_pixel *found, const struct picture_pixel *exact)
{
  if (isinf(found->depth) || isinf(exact->depth)) return found->depth == exact->depth ? 0 : INFINITY;
  return fabs(found->depth - exact->depth) / exact->depth;
}

static void colour(enum map map, const struct picture_pixel *pixel, double off, float out_rgb[3])
{
  const double roots = pixel->solver.roots;
  const bool hit = isfinite(pixel->depth);
  for (int c = 0; c < 3; c++) out_rgb[c] = 1;
  if (map == MAP_ITERATIONS && roots > 0) picture_scale(log2(pixel->solver.iterations / roots) / 6, out_rgb);
  if (map == MAP_RESIDUAL && hit) picture_scale((log10(pixel->solver.residual) + 2) / 8, out_rgb);
  if (map == MAP_DEVIATION && hit) picture_scale((log10(off) + 16) / 16, out_rgb);
  if (map == MAP_DEVIATION && isinf(off)) out_rgb[1] = out_rgb[2] = 0;
}

static void print_row(size_t pixels, const struct picture_pixel found[], const struct picture_pixel exact[])
{
  double iterations = 0, roots = 0, rays = 0, hits = 0, accurate = 0, off = 0, wrong = 0;
  for (size_t p = 0; p < pixels; p++) {
    const struct explained_numbers *solver = &found[p].solver;
    const bool hit = isfinite(found[p].depth);
    const double deviates = deviation(&found[p], &exact[p]);
    iterations += solver->iterations, roots += solver->roots, rays += solver->roots > 0;
    hits += hit, accurate += hit && solver->residual < 1;
    off += deviates > RIGHT, wrong += isinf(deviates);
  }
  printf("%.2f,%.2f,%.4f,%.4f,%.4f\n", iterations / rays, roots / rays, accurate / hits, off / (double)pixels,
         wrong / (double)pixels);
}

int main(int argc, char **argv)
{
  static const char *const suffixes[MAPS] = {"-iterations.png", "-residual.png", "-deviation.png"};
  const int width = argc == 6 ? atoi(argv[2]) : 0, height = argc == 6 ? atoi(argv[3]) : 0;
  if (width < 1 || height < 1) {
    fputs("usage: channel_maps SCENE WIDTH HEIGHT SOLVER NAME\n", stderr);
    return 2;
  }
  const size_t pixels = (size_t)width * (size_t)height;
  struct picture_pixel *exact = picture_lines(argv[1], (size_t)width, (size_t)height, NULL);
  struct picture_pixel *found = picture_lines(argv[1], (size_t)width, (size_t)height, argv[4]);
  if (exact == NULL || found == NULL) return 3;
  bool good = true;
  for (int m = 0; m < MAPS && good; m++) {
    struct image image;
    good = picture_begin((size_t)width, (size_t)height, &image);
    for (size_t p = 0; p < pixels && good; p++)
      colour((enum map)m, &found[p], deviation(&found[p], &exact[p]), image.value + 3 * p);
    good = good && picture_end(&image, true, argv[5], suffixes[m]);
  }
  print_row(pixels, found, exact);
  free(exact);
  free(found);
  return good ? 0 : 4;
}
