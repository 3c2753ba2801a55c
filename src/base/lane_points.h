/* Points with their three coordinates side by side in a register, for when few rays leave most lanes of base/lanes.h
 * empty. Point k has lanes 4k to 4k + 2; lane 4k + 3 means nothing.
 */
#ifndef PSCN_BASE_LANE_POINTS_H
#define PSCN_BASE_LANE_POINTS_H

#include "base/lanes.h"

/* How many points there is room for; if none, there are no functions. */
#define LANE_POINTS (LANES / 4)

#if LANE_POINTS > 0

/* The lanes that the points belong to. */
struct lane_points {
#if LANES == 8
  __m512i spread, collect; /* from which lane each comes */
#else
  __m256i spread; /* as floats */
#endif
};

/* `bits`: 1 to LANE_POINTS lanes. */
LANES_INLINE struct lane_points lane_points_of(unsigned bits)
{
  const int first = __builtin_ctz(bits);
#if LANES == 8
  const int last = 31 - __builtin_clz(bits);
  const __m512i lane = _mm512_setr_epi64(0, 1, 2, 3, 4, 5, 6, 7), one = _mm512_set1_epi64(first);
  const __m512i other = _mm512_set1_epi64(last); /* the same for a single point */
  return (struct lane_points){_mm512_mask_blend_epi64(0xf0, one, other),
                              _mm512_maskz_set1_epi64(_mm512_cmpeq_epi64_mask(lane, other), 4)};
#else
  return (struct lane_points){_mm256_set1_epi64x(0x200000002 * first + 0x100000000)};
#endif
}

/* Each point's lane of x, in all lanes of the point. */
LANES_INLINE lanes lane_points_spread(const struct lane_points *points, lanes x)
{
#if LANES == 8
  return _mm512_permutexvar_pd(points->spread, x);
#else
  return (lanes)_mm256_permutevar8x32_ps((__m256)x, points->spread);
#endif
}

/* Coordinate c of each point, in the lane that the point belongs to; in other lanes some point's. */
LANES_INLINE lanes lane_points_collect(const struct lane_points *points, lanes x, int c)
{
#if LANES == 8
  return _mm512_permutexvar_pd(_mm512_add_epi64(points->collect, _mm512_set1_epi64(c)), x);
#else
  (void)points;
  return lanes_all(x[c]);
#endif
}

/* The three numbers, for every point. The fourth is read, and means nothing. */
LANES_INLINE lanes lane_points_load(const double from[3])
{
#if LANES == 8
  return _mm512_broadcast_f64x4(_mm256_loadu_pd(from));
#else
  return _mm256_loadu_pd(from);
#endif
}

#endif

#endif
