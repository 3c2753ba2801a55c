/* A few doubles side by side: one ray a lane.
 *
 * Plain GCC/clang vector extensions, so one source serves every instruction set; LANES is what one register of the
 * target holds (vectors wider than that are taken apart into single doubles by the compiler, which costs more than
 * it saves). Arithmetic operators work lane by lane; a comparison gives a mask whose lanes are 0 or -1. A source
 * that uses this is compiled once per instruction set (src/intersect/CMakeLists.txt).
 */
#ifndef PSCN_BASE_LANES_H
#define PSCN_BASE_LANES_H

#include <stddef.h>
#include <stdint.h>

#if defined(__SSE2__)
#include <immintrin.h>
#endif

#if defined(__AVX512F__) && defined(__AVX512DQ__)
#define LANES 8
#elif defined(__AVX__)
#define LANES 4
#else
#define LANES 2
#endif

typedef double lanes __attribute__((vector_size(8 * LANES)));
typedef int64_t lane_mask __attribute__((vector_size(8 * LANES)));

#define LANES_INLINE static inline __attribute__((always_inline, unused))

/* Lane k: x. (x - 0 keeps every x, -0 and NaN included.) */
LANES_INLINE lanes lanes_all(double x) { return x - (lanes){0}; }

/* Lane k: x[k * stride]. */
LANES_INLINE lanes lanes_gather(const double *x, size_t stride)
{
#if LANES == 8
  return (lanes){x[0],          x[stride],     x[2 * stride], x[3 * stride],
                 x[4 * stride], x[5 * stride], x[6 * stride], x[7 * stride]};
#elif LANES == 4
  return (lanes){x[0], x[stride], x[2 * stride], x[3 * stride]};
#else
  return (lanes){x[0], x[stride]};
#endif
}

/* Lane k: mask ? a : b. */
LANES_INLINE lanes lanes_select(lane_mask mask, lanes a, lanes b)
{
#if defined(__AVX512F__) && defined(__AVX512DQ__)
  return (lanes)_mm512_mask_blend_pd(_mm512_movepi64_mask((__m512i)mask), (__m512d)b, (__m512d)a);
#elif defined(__AVX__)
  return (lanes)_mm256_blendv_pd((__m256d)b, (__m256d)a, (__m256d)mask);
#else
  return (lanes)((mask & (lane_mask)a) | (~mask & (lane_mask)b));
#endif
}

/* Lane k: a < b ? a : b, so b where either is NaN. */
LANES_INLINE lanes lanes_min(lanes a, lanes b)
{
#if defined(__AVX512F__) && defined(__AVX512DQ__)
  return (lanes)_mm512_min_pd((__m512d)a, (__m512d)b);
#elif defined(__AVX__)
  return (lanes)_mm256_min_pd((__m256d)a, (__m256d)b);
#elif defined(__SSE2__)
  return (lanes)_mm_min_pd((__m128d)a, (__m128d)b);
#else
  return lanes_select(a < b, a, b);
#endif
}

/* Lane k: a > b ? a : b, so b where either is NaN. */
LANES_INLINE lanes lanes_max(lanes a, lanes b)
{
#if defined(__AVX512F__) && defined(__AVX512DQ__)
  return (lanes)_mm512_max_pd((__m512d)a, (__m512d)b);
#elif defined(__AVX__)
  return (lanes)_mm256_max_pd((__m256d)a, (__m256d)b);
#elif defined(__SSE2__)
  return (lanes)_mm_max_pd((__m128d)a, (__m128d)b);
#else
  return lanes_select(a > b, a, b);
#endif
}

LANES_INLINE lanes lanes_abs(lanes a) { return (lanes)((lane_mask)a & (INT64_MAX - (lane_mask){0})); }

/* Lane k: the square root. */
LANES_INLINE lanes lanes_sqrt(lanes a)
{
#if defined(__AVX512F__) && defined(__AVX512DQ__)
  return (lanes)_mm512_sqrt_pd((__m512d)a);
#elif defined(__AVX__)
  return (lanes)_mm256_sqrt_pd((__m256d)a);
#elif defined(__SSE2__)
  return (lanes)_mm_sqrt_pd((__m128d)a);
#else
  for (int k = 0; k < LANES; k++) a[k] = __builtin_sqrt(a[k]);
  return a;
#endif
}

/* Lane k: a b - product exactly, for product = a b rounded: the rounding error of a product. Written so that no
 * contraction of multiply and add by the compiler can change it. */
LANES_INLINE lanes lanes_product_error(lanes a, lanes b, lanes product)
{
#if defined(__AVX512F__) && defined(__AVX512DQ__)
  return (lanes)_mm512_fmsub_pd((__m512d)a, (__m512d)b, (__m512d)product);
#elif defined(__FMA__)
  return (lanes)_mm256_fmsub_pd((__m256d)a, (__m256d)b, (__m256d)product);
#else
  for (int k = 0; k < LANES; k++) a[k] = __builtin_fma(a[k], b[k], -product[k]);
  return a;
#endif
}

/* Lane k: a b + c, with one rounding or two. */
LANES_INLINE lanes lanes_multiply_add(lanes a, lanes b, lanes c)
{
#if defined(__AVX512F__) && defined(__AVX512DQ__)
  return (lanes)_mm512_fmadd_pd((__m512d)a, (__m512d)b, (__m512d)c);
#elif defined(__FMA__)
  return (lanes)_mm256_fmadd_pd((__m256d)a, (__m256d)b, (__m256d)c);
#else
  return a * b + c;
#endif
}

/* The mask as bits: bit k is lane k. */
LANES_INLINE unsigned lanes_bits(lane_mask mask)
{
#if defined(__AVX512F__) && defined(__AVX512DQ__)
  return (unsigned)_mm512_movepi64_mask((__m512i)mask);
#elif defined(__AVX__)
  return (unsigned)_mm256_movemask_pd((__m256d)mask);
#elif defined(__SSE2__)
  return (unsigned)_mm_movemask_pd((__m128d)mask);
#else
  unsigned bits = 0;
  for (int k = 0; k < LANES; k++) bits |= (unsigned)(mask[k] & 1) << k;
  return bits;
#endif
}

/* The mask whose bits these are. */
LANES_INLINE lane_mask lanes_mask(unsigned bits)
{
#if LANES == 8
  const lane_mask weight = {1, 2, 4, 8, 16, 32, 64, 128};
#elif LANES == 4
  const lane_mask weight = {1, 2, 4, 8};
#else
  const lane_mask weight = {1, 2};
#endif
  return ((int64_t)bits & weight) == weight;
}

/* Whether any lane of the mask is set. */
LANES_INLINE int lanes_any(lane_mask mask) { return lanes_bits(mask) != 0; }

#endif
