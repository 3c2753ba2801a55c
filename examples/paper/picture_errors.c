/* A solver's picture, and where and how it is wrong (Fig 16 and 17): a row of CSV on standard output, the picture and a
 * map.
 *
 *     picture_errors SCENE WIDTH HEIGHT SOLVER NAME
 *
 * Pixels are traced line by line (pictures.h). Compares the depth of every pixel with the default's, which is
 * certified; depths are the same within a fiftieth of the picture's range of depths. Writes NAME.png and NAME-map.png.
 * The map shows holes in blue (darker: through to the background), phantoms in red (darker: in front of nothing), and
 * right pixels in light grey.
 */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "pictures.h"

#define SAME_DEPTH 0.02

enum error { RIGHT, BACKGROUND, HOLE_BACKGROUND, HOLE_FARTHER, PHANTOM_BEFORE, PHANTOM_BACKGROUND, ERRORS };

static const float colours[ERRORS][3] = {{0.8F, 0.8F, 0.8F}, {1, 1, 1},       {0, 0, 0.5F},
                                         {0.3F, 0.5F, 1},    {1, 0.4F, 0.3F}, {0.6F, 0, 0}};

static enum error judge(double found, double exact, double same)
{
  if (isinf(found) && isinf(exact)) return BACKGROUND;
  if (isinf(found)) return HOLE_BACKGROUND;
  if (isinf(exact)) return PHANTOM_BACKGROUND;
  if (fabs(found - exact) <= same) return RIGHT;
  return found > exact ? HOLE_FARTHER : PHANTOM_BEFORE;
}

int main(int argc, char **argv)
{
  const int width = argc == 6 ? atoi(argv[2]) : 0, height = argc == 6 ? atoi(argv[3]) : 0;
  if (width < 1 || height < 1) {
    fputs("usage: picture_errors SCENE WIDTH HEIGHT SOLVER NAME\n", stderr);
    return 2;
  }
  const size_t pixels = (size_t)width * (size_t)height;
  struct picture_pixel *exact = picture_lines(argv[1], (size_t)width, (size_t)height, NULL);
  struct picture_pixel *found = picture_lines(argv[1], (size_t)width, (size_t)height, argv[4]);
  struct image map = {0}, picture = {0};
  if (exact == NULL || found == NULL || !picture_begin((size_t)width, (size_t)height, &map) ||
      !picture_begin((size_t)width, (size_t)height, &picture))
    return 3;
  double nearest = INFINITY, farthest = 0;
  for (size_t p = 0; p < pixels; p++)
    if (isfinite(exact[p].depth)) nearest = fmin(nearest, exact[p].depth), farthest = fmax(farthest, exact[p].depth);
  size_t count[ERRORS] = {0};
  for (size_t p = 0; p < pixels; p++) {
    const enum error error = judge(found[p].depth, exact[p].depth, SAME_DEPTH * (farthest - nearest));
    count[error]++;
    for (size_t c = 0; c < 3; c++) map.value[3 * p + c] = colours[error][c];
    for (size_t c = 0; c < 3; c++) picture.value[3 * p + c] = (float)found[p].rgb[c];
  }
  printf("%zu,%zu,%zu,%zu\n", count[HOLE_BACKGROUND], count[HOLE_FARTHER], count[PHANTOM_BEFORE],
         count[PHANTOM_BACKGROUND]);
  const bool good = picture_end(&map, true, argv[5], "-map.png") && picture_end(&picture, false, argv[5], ".png");
  free(exact);
  free(found);
  return good ? 0 : 4;
}
