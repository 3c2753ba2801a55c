/* Where a solver's picture is wrong, and how (Fig 16 and 17): a row of CSV on standard output, and a map.
 *
 *     picture_errors SCENE WIDTH HEIGHT SOLVER MAP.png
 *
 * The depth of every pixel by the solver, against the default's, which is certified. Depths are the same within a
 * fiftieth of the depths there are in the picture. Map: blue holes (darker: through to the background), red phantoms
 * (darker: in front of nothing), light grey what is right.
 */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "pictures.h"

#define SAME_DEPTH 0.02

enum error { RIGHT, BACKGROUND, HOLE_BACKGROUND, HOLE_FARTHER, PHANTOM_BEFORE, PHANTOM_BACKGROUND, ERRORS };

static const float colours[ERRORS][3] = {{0.8F, 0.8F, 0.8F}, {1, 1, 1},       {0, 0, 0.5F},
                                         {0.3F, 0.5F, 1},    {1, 0.4F, 0.3F}, {0.6F, 0, 0}};

static enum error judge(float found, float exact, double same)
{
  if (isinf(found) && isinf(exact)) return BACKGROUND;
  if (isinf(found)) return HOLE_BACKGROUND;
  if (isinf(exact)) return PHANTOM_BACKGROUND;
  if (fabs((double)found - exact) <= same) return RIGHT;
  return found > exact ? HOLE_FARTHER : PHANTOM_BEFORE;
}

int main(int argc, char **argv)
{
  const int width = argc == 6 ? atoi(argv[2]) : 0, height = argc == 6 ? atoi(argv[3]) : 0;
  if (width < 1 || height < 1) {
    fputs("usage: picture_errors SCENE WIDTH HEIGHT SOLVER MAP.png\n", stderr);
    return 2;
  }
  const size_t pixels = (size_t)width * (size_t)height;
  float *exact = picture_channels(argv[1], (size_t)width, (size_t)height, NULL, "depth");
  float *found = picture_channels(argv[1], (size_t)width, (size_t)height, argv[4], "depth");
  struct image map = {0};
  if (exact == NULL || found == NULL || !picture_begin((size_t)width, (size_t)height, &map)) return 3;
  double nearest = INFINITY, farthest = 0;
  for (size_t p = 0; p < pixels; p++)
    if (isfinite(exact[p])) nearest = fmin(nearest, exact[p]), farthest = fmax(farthest, exact[p]);
  size_t count[ERRORS] = {0};
  for (size_t p = 0; p < pixels; p++) {
    const enum error error = judge(found[p], exact[p], SAME_DEPTH * (farthest - nearest));
    count[error]++;
    for (int c = 0; c < 3; c++) map.value[3 * p + (size_t)c] = colours[error][c];
  }
  printf("%zu,%zu,%zu,%zu\n", count[HOLE_BACKGROUND], count[HOLE_FARTHER], count[PHANTOM_BEFORE],
         count[PHANTOM_BACKGROUND]);
  const bool good = picture_end(&map, argv[5]);
  free(exact);
  free(found);
  return good ? 0 : 4;
}
