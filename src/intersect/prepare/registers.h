/* Vectors of three coordinates for making the numbers of leaves.
 *
 * Internal to src/intersect/prepare. Each coordinate has a register, and each lane is a leaf. With PSCN_ONE_LEAF there
 * is one leaf, whose coordinates are side by side in one AVX2 register, the fourth number being 0. Both do the same
 * operations on each coordinate in the same order, without contraction, so that both make the same bits.
 */
#ifndef PSCN_INTERSECT_PREPARE_REGISTERS_H
#define PSCN_INTERSECT_PREPARE_REGISTERS_H

#include <math.h>

#include "base/lanes.h"

#ifdef PSCN_ONE_LEAF

enum { REGISTERS = 1 };

/* Coordinate k in all lanes. */
LANES_INLINE lanes coordinate(const lanes v[REGISTERS], int k) { return lanes_all(v[0][k]); }

LANES_INLINE void from_coordinates(const lanes x[3], lanes out[REGISTERS])
{
  out[0] = (lanes){x[0][0], x[1][0], x[2][0], 0};
}

/* What register k holds of a net. */
LANES_INLINE void load_net(const double x[3][16], int k, lanes out[4][4])
{
  (void)k; /* there is only one */
  for (int i = 0; i < 4; i++) {
    for (int c = 0; c < 3; c++) out[i][c] = _mm256_loadu_pd(&x[c][4 * i]);
    out[i][3] = lanes_all(0);
    four_doubles_turn(out[i]);
  }
}

/* x, y, z become y, z, x. */
LANES_INLINE lanes next_coordinates(lanes v) { return _mm256_permute4x64_pd(v, 0xc9); }

/* The largest and the least of the four numbers, in all lanes. */
LANES_INLINE lanes lane_max(lanes x)
{
  x = lanes_max(x, _mm256_permute2f128_pd(x, x, 1));
  return lanes_max(x, _mm256_permute_pd(x, 5));
}

LANES_INLINE lanes lane_min(lanes x)
{
  x = lanes_min(x, _mm256_permute2f128_pd(x, x, 1));
  return lanes_min(x, _mm256_permute_pd(x, 5));
}

/* The square of the vector's length, in all lanes. */
LANES_INLINE lanes square_of(const lanes v[REGISTERS])
{
  const lanes square = v[0] * v[0];
  return lanes_all(square[0]) + lanes_all(square[1]) + lanes_all(square[2]);
}

/* The largest square of the vectors' lengths. */
LANES_INLINE lanes largest_square(const lanes v[][REGISTERS], int count)
{
  lanes largest = {0};
  for (int n = 0; n < count; n += 4) { /* four at once; the last ones more than once */
    lanes x[4];
    for (int k = 0; k < 4; k++) x[k] = v[n + k < count ? n + k : count - 1][0];
    four_doubles_turn(x);
    largest = lanes_max(x[0] * x[0] + x[1] * x[1] + x[2] * x[2], largest);
  }
  return lane_max(largest);
}

/* The least and the largest of g times a control point. */
LANES_INLINE void net_range(const lanes g[REGISTERS], lanes x[REGISTERS][4][4], lanes *lo, lanes *hi)
{
  const lanes a = coordinate(g, 0), b = coordinate(g, 1), c = coordinate(g, 2);
  *lo = lanes_all(INFINITY), *hi = lanes_all(-INFINITY);
  for (int i = 0; i < 4; i++) {
    lanes of[4] = {x[0][i][0], x[0][i][1], x[0][i][2], x[0][i][3]};
    four_doubles_turn(of);
    const lanes value = a * of[0] + b * of[1] + c * of[2];
    *lo = lanes_min(*lo, value), *hi = lanes_max(*hi, value);
  }
  *lo = lane_min(*lo), *hi = lane_max(*hi);
}

LANES_INLINE void cross(const lanes a[REGISTERS], const lanes b[REGISTERS], lanes out[REGISTERS])
{
  const lanes a1 = next_coordinates(a[0]), a2 = next_coordinates(a1);
  const lanes b1 = next_coordinates(b[0]), b2 = next_coordinates(b1);
  out[0] = a1 * b2 - a2 * b1;
}

#else

enum { REGISTERS = 3 };

LANES_INLINE lanes coordinate(const lanes v[REGISTERS], int k) { return v[k]; }

LANES_INLINE void from_coordinates(const lanes x[3], lanes out[REGISTERS])
{
  for (int k = 0; k < 3; k++) out[k] = x[k];
}

LANES_INLINE void load_net(const double x[3][16], int k, lanes out[4][4])
{
  for (int n = 0; n < 16; n++) out[n / 4][n % 4] = lanes_all(x[k][n]);
}

LANES_INLINE void cross(const lanes a[REGISTERS], const lanes b[REGISTERS], lanes out[REGISTERS])
{
  out[0] = a[1] * b[2] - a[2] * b[1];
  out[1] = a[2] * b[0] - a[0] * b[2];
  out[2] = a[0] * b[1] - a[1] * b[0];
}

LANES_INLINE lanes square_of(const lanes v[REGISTERS]) { return v[0] * v[0] + v[1] * v[1] + v[2] * v[2]; }

LANES_INLINE lanes largest_square(const lanes v[][REGISTERS], int count)
{
  lanes largest = {0};
  for (int n = 0; n < count; n++) largest = lanes_max(square_of(v[n]), largest);
  return largest;
}

LANES_INLINE void net_range(const lanes g[REGISTERS], lanes x[REGISTERS][4][4], lanes *lo, lanes *hi)
{
  *lo = lanes_all(INFINITY), *hi = lanes_all(-INFINITY);
  for (int n = 0; n < 16; n++) {
    const int i = n / 4, j = n % 4;
    const lanes value = g[0] * x[0][i][j] + g[1] * x[1][i][j] + g[2] * x[2][i][j];
    *lo = lanes_min(*lo, value), *hi = lanes_max(*hi, value);
  }
}

#endif

/* These two in all lanes, also with one leaf. */
LANES_INLINE lanes coordinates_sum(const lanes v[REGISTERS])
{
  return coordinate(v, 0) + coordinate(v, 1) + coordinate(v, 2);
}

LANES_INLINE lanes coordinates_max(const lanes v[REGISTERS])
{
  return lanes_max(coordinate(v, 0), lanes_max(coordinate(v, 1), coordinate(v, 2)));
}

#endif
