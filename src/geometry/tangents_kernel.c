/* The arithmetic of tangents.h. Compiled once per instruction set. */
#include "geometry/tangents.h"

#include <string.h>

#include "base/kernel.h"
#include "geometry/patch.h"

enum { SIDE = 4, POINTS = SIDE * SIDE, COORDINATES = 3 };

/* A point's coordinates side by side; the fourth number means nothing. */
typedef patch_row point;

/* One of the points that stand one behind the other. */
static inline point point_at(const double *points, int number)
{
  const double *at = points + COORDINATES * number;
  point p = {at[0], at[1], at[2]};
  if (number + 1 < POINTS) memcpy(&p, at, sizeof p);
  return p;
}

/* The weights of a cubic's four control values in its value, and of their three differences in its derivative. */
struct weights {
  double value[4], difference[3];
};

static struct weights weights_at(double t)
{
  const double s = 1 - t;
  struct weights w = {.difference = {3 * (s * s), 6 * (s * t), 3 * (t * t)}};
  double unused[4];
  patch_weights(t, w.value, unused);
  return w;
}

/* From a point to one further on; from differences of control points, so that where the patch is does not matter. */
static inline point step(const double *points, int number, int further)
{
  return point_at(points, number + further) - point_at(points, number);
}

static inline void store(point p, double out[3])
{
  for (int k = 0; k < COORDINATES; k++) out[k] = p[k];
}

void KERNEL(patch_tangents)(const double P[4][4][3], double u, double v, double out_du[3], double out_dv[3])
{
  const double *points = &P[0][0][0];
  const struct weights in_u = weights_at(u), in_v = weights_at(v);
  point du = {0}, dv = {0};
#pragma GCC unroll 3
  for (int i = 0; i + 1 < SIDE; i++) {
    point along_u = {0}, along_v = {0};
#pragma GCC unroll 4
    for (int j = 0; j < SIDE; j++) {
      along_u += in_v.value[j] * step(points, SIDE * i + j, SIDE);
      along_v += in_u.value[j] * step(points, SIDE * j + i, 1);
    }
    du += in_u.difference[i] * along_u, dv += in_v.difference[i] * along_v;
  }
  store(du, out_du), store(dv, out_dv);
}
