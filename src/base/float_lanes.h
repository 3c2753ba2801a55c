/* Floats side by side, as many as a register holds: one ray per lane, where few bits will do. As doubles they fill
 * several packets of LANES rays each (base/lanes.h).
 *
 * Plain GCC/clang vector extensions. Arithmetic operators work lane by lane; a comparison gives a mask whose lanes are
 * 0 or -1.
 */
#ifndef PSCN_BASE_FLOAT_LANES_H
#define PSCN_BASE_FLOAT_LANES_H

#include "base/lanes.h"

#define FLOAT_LANES (2 * LANES)
#if defined(LANES_OP)
#define FLOAT_LANES_OP(name) LANES_OP(name)
#endif

/* The number of these packets. */
enum { PACKETS = FLOAT_LANES / LANES };

typedef float float_lanes __attribute__((vector_size(4 * FLOAT_LANES)));
typedef int32_t float_mask __attribute__((vector_size(4 * FLOAT_LANES)));

/* Lane k: x. */
LANES_INLINE float_lanes float_lanes_all(float x) { return x - (float_lanes){0}; }

/* The doubles of all packets, rounded to nearest. x[0] goes to the first LANES lanes. */
LANES_INLINE float_lanes float_lanes_join(const lanes x[PACKETS])
{
#if LANES == 8
  return _mm512_insertf32x8(_mm512_castps256_ps512(_mm512_cvtpd_ps(x[0])), _mm512_cvtpd_ps(x[1]), 1);
#elif LANES == 4
  return _mm256_insertf128_ps(_mm256_castps128_ps256(_mm256_cvtpd_ps(x[0])), _mm256_cvtpd_ps(x[1]), 1);
#elif defined(LANES_OP)
  return _mm_movelh_ps(_mm_cvtpd_ps(x[0]), _mm_cvtpd_ps(x[1]));
#else
  float_lanes joined;
  for (int k = 0; k < FLOAT_LANES; k++) joined[k] = (float)x[k / LANES][k % LANES];
  return joined;
#endif
}

/* Lane k: mask ? a : b. */
LANES_INLINE float_lanes float_lanes_select(float_mask mask, float_lanes a, float_lanes b)
{
#if FLOAT_LANES == 8
  return _mm256_blendv_ps(b, a, (__m256)mask);
#else
  return (float_lanes)((mask & (float_mask)a) | (~mask & (float_mask)b));
#endif
}

LANES_INLINE float_lanes float_lanes_abs(float_lanes a)
{
  return (float_lanes)((float_mask)a & (INT32_MAX - (float_mask){0}));
}

/* Lane k: a < b ? a : b, so b where either is NaN. */
LANES_INLINE float_lanes float_lanes_min(float_lanes a, float_lanes b)
{
#if defined(FLOAT_LANES_OP)
  return FLOAT_LANES_OP(min_ps)(a, b);
#else
  return float_lanes_select(a < b, a, b);
#endif
}

/* Lane k: a > b ? a : b, so b where either is NaN. */
LANES_INLINE float_lanes float_lanes_max(float_lanes a, float_lanes b)
{
#if defined(FLOAT_LANES_OP)
  return FLOAT_LANES_OP(max_ps)(a, b);
#else
  return float_lanes_select(a > b, a, b);
#endif
}

/* Four floats side by side, whatever the register holds: one ray, four boxes. Functions as above. */
typedef float four_floats __attribute__((vector_size(16)));
typedef int32_t four_mask __attribute__((vector_size(16)));

LANES_INLINE four_floats four_floats_all(float x) { return x - (four_floats){0}; }

LANES_INLINE four_floats four_floats_min(four_floats a, four_floats b)
{
#if defined(LANES_OP)
  return _mm_min_ps(a, b);
#else
  return (four_floats)(((a < b) & (four_mask)a) | (~(a < b) & (four_mask)b));
#endif
}

LANES_INLINE four_floats four_floats_max(four_floats a, four_floats b)
{
#if defined(LANES_OP)
  return _mm_max_ps(a, b);
#else
  return (four_floats)(((a > b) & (four_mask)a) | (~(a > b) & (four_mask)b));
#endif
}

LANES_INLINE four_floats four_floats_abs(four_floats a)
{
  return (four_floats)((four_mask)a & (INT32_MAX - (four_mask){0}));
}

/* Lanes 1, 2, 0 of x, in this order; the last lane stays. */
LANES_INLINE four_floats four_floats_next(four_floats x) { return __builtin_shufflevector(x, x, 1, 2, 0, 3); }

LANES_INLINE unsigned four_mask_bits(four_mask mask)
{
#if defined(LANES_OP)
  return (unsigned)_mm_movemask_ps((four_floats)mask);
#else
  unsigned bits = 0;
  for (int k = 0; k < 4; k++) bits |= (unsigned)(mask[k] & 1) << k;
  return bits;
#endif
}

/* The mask as 16 bits per lane, all of them the same. */
LANES_INLINE uint64_t four_mask_words(four_mask mask)
{
#if defined(LANES_OP) && defined(__x86_64__)
  return (uint64_t)_mm_cvtsi128_si64(_mm_packs_epi32((__m128i)mask, (__m128i)mask));
#else
  uint64_t words = 0;
  for (int k = 0; k < 4; k++) words |= (uint64_t)(uint16_t)mask[k] << 16 * k;
  return words;
#endif
}

/* The mask as bits: bit k is lane k. */
LANES_INLINE unsigned float_lanes_bits(float_mask mask)
{
#if FLOAT_LANES == 16
  return _mm512_movepi32_mask((__m512i)mask);
#elif defined(FLOAT_LANES_OP)
  return (unsigned)FLOAT_LANES_OP(movemask_ps)((float_lanes)mask);
#else
  unsigned bits = 0;
  for (int k = 0; k < FLOAT_LANES; k++) bits |= (unsigned)(mask[k] & 1) << k;
  return bits;
#endif
}

/* Bit k: whether lane k of a is at most lane k of b. */
LANES_INLINE unsigned float_lanes_up_to(float_lanes a, float_lanes b)
{
#if FLOAT_LANES == 16
  return _mm512_cmp_ps_mask(a, b, _CMP_LE_OQ);
#else
  return float_lanes_bits(a <= b);
#endif
}

#endif
