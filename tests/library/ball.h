/* A closed ball of eight patches, for tests: radius 1, about the origin, poles at y = 1 and -1. */
#ifndef PSCN_TESTS_LIBRARY_BALL_H
#define PSCN_TESTS_LIBRARY_BALL_H

#include <string.h>

enum { BALL_PATCHES = 8 };

/* Fills points with the control nets [patch][i][j][coordinate]. */
static inline void ball_points(double points[BALL_PATCHES][4][4][3])
{
  const double k = 0.5522847498, c = 0.5522847498 * 0.5522847498; /* a constant, whatever the arithmetic here */
  const double quarter[4][4][3] = {{{0, 1, 0}, {0, 1, 0}, {0, 1, 0}, {0, 1, 0}},
                                   {{k, 1, 0}, {k, 1, c}, {c, 1, k}, {0, 1, k}},
                                   {{1, k, 0}, {1, k, k}, {k, k, 1}, {0, k, 1}},
                                   {{1, 0, 0}, {1, 0, k}, {k, 0, 1}, {0, 0, 1}}};
  for (int patch = 0; patch < BALL_PATCHES; patch++) {
    memcpy(points[patch], quarter, sizeof quarter);
    for (int n = 0; n < 16; n++) {
      double *p = points[patch][n / 4][n % 4];
      for (int axis = 0; axis < 3; axis++)
        if (patch >> axis & 1) p[axis] = 0 - p[axis]; /* and no -0 */
    }
  }
}

#endif
