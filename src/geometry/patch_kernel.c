/* The arithmetic of control points. Compiled once per instruction set, without contraction. */
#include "geometry/patch.h"

#include <math.h>
#include <string.h>

#include "base/double_lanes.h"
#include "base/kernel.h"
#include "base/real.h"

enum { SIDE = 4, POINTS = SIDE * SIDE, COORDINATES = 3 };

/* ---- a coordinate of several points side by side ---- */

/* Coordinate k of point `number` and those behind it, one to a lane. */
static inline lanes coordinate_at(const double P[4][4][3], int number, int k)
{
  return lanes_load_every(&P[0][0][0] + COORDINATES * number + k, COORDINATES);
}

void KERNEL(points_range)(const double P[4][4][3], double out_lo[3], double out_hi[3])
{
  for (int k = 0; k < COORDINATES; k++) {
    lanes lo = lanes_all(INFINITY), hi = lanes_all(-INFINITY);
    for (int number = 0; number < POINTS; number += LANES) {
      const lanes x = coordinate_at(P, number, k);
      lo = lanes_min(lo, x), hi = lanes_max(hi, x);
    }
    out_lo[k] = lo[0], out_hi[k] = hi[0];
    for (int n = 1; n < LANES; n++) out_lo[k] = real_min(out_lo[k], lo[n]), out_hi[k] = real_max(out_hi[k], hi[n]);
  }
}

bool KERNEL(points_frame)(const double P[4][4][3], const double center[3], double unit, double out_x[3][4][4],
                          double out_rest[3][4][4])
{
  lane_mask rounded = {0};
  for (int k = 0; k < COORDINATES; k++) {
    for (int number = 0; number < POINTS; number += LANES) {
      const struct double_lanes from = double_lanes_sum(coordinate_at(P, number, k), lanes_all(-center[k]));
      const lanes x = from.hi * unit, rest = from.lo * unit;
      memcpy(&out_x[k][0][0] + number, &x, sizeof x), memcpy(&out_rest[k][0][0] + number, &rest, sizeof rest);
      rounded |= from.lo != 0;
    }
  }
  return lanes_any(rounded);
}

/* ---- a point's coordinates side by side ---- */

/* The fourth number means nothing. */
typedef patch_row point;

/* Point `number` of points that are stored one after the other. */
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

/* The difference of a point and one further on; with differences it does not matter where the patch is. */
static inline point step(const double *points, int number, int further)
{
  return point_at(points, number + further) - point_at(points, number);
}

static inline void store(point p, double out[3])
{
  for (int k = 0; k < COORDINATES; k++) out[k] = p[k];
}

void KERNEL(points_tangents)(const double P[4][4][3], double u, double v, double out_du[3], double out_dv[3])
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
