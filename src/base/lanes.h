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

#if defined(__AVX__)
LANES_INLINE void lanes_turn_square(__m256d x[4])
{
  const __m256d a = _mm256_unpacklo_pd(x[0], x[1]), b = _mm256_unpackhi_pd(x[0], x[1]);
  const __m256d c = _mm256_unpacklo_pd(x[2], x[3]), d = _mm256_unpackhi_pd(x[2], x[3]);
  x[0] = _mm256_permute2f128_pd(a, c, 0x20), x[1] = _mm256_permute2f128_pd(b, d, 0x20);
  x[2] = _mm256_permute2f128_pd(a, c, 0x31), x[3] = _mm256_permute2f128_pd(b, d, 0x31);
}

LANES_INLINE void lanes_load_square(const double *from, size_t stride, __m256d x[4])
{
  x[0] = _mm256_loadu_pd(from), x[1] = _mm256_loadu_pd(from + stride);
  x[2] = _mm256_loadu_pd(from + 2 * stride), x[3] = _mm256_loadu_pd(from + 3 * stride);
  lanes_turn_square(x);
}

LANES_INLINE void lanes_store_square(__m256d x[4], double *to, size_t stride)
{
  lanes_turn_square(x);
  _mm256_storeu_pd(to, x[0]), _mm256_storeu_pd(to + stride, x[1]);
  _mm256_storeu_pd(to + 2 * stride, x[2]), _mm256_storeu_pd(to + 3 * stride, x[3]);
}
#endif

/* Lane k of *a, *b, *c, *d: from[k * stride] and the three numbers behind it. */
LANES_INLINE void lanes_load4(const double *from, size_t stride, lanes *a, lanes *b, lanes *c, lanes *d)
{
#if LANES == 8
  __m256d x[4], y[4];
  lanes_load_square(from, stride, x), lanes_load_square(from + 4 * stride, stride, y);
  *a = (lanes)_mm512_insertf64x4(_mm512_castpd256_pd512(x[0]), y[0], 1);
  *b = (lanes)_mm512_insertf64x4(_mm512_castpd256_pd512(x[1]), y[1], 1);
  *c = (lanes)_mm512_insertf64x4(_mm512_castpd256_pd512(x[2]), y[2], 1);
  *d = (lanes)_mm512_insertf64x4(_mm512_castpd256_pd512(x[3]), y[3], 1);
#elif LANES == 4
  __m256d x[4];
  lanes_load_square(from, stride, x);
  *a = (lanes)x[0], *b = (lanes)x[1], *c = (lanes)x[2], *d = (lanes)x[3];
#else
  for (size_t k = 0; k < LANES; k++) {
    const double *x = from + k * stride;
    (*a)[k] = x[0], (*b)[k] = x[1], (*c)[k] = x[2], (*d)[k] = x[3];
  }
#endif
}

/* The other way: to[k * stride] and the three behind it are lane k of a, b, c, d. */
LANES_INLINE void lanes_store4(lanes a, lanes b, lanes c, lanes d, double *to, size_t stride)
{
#if LANES == 8
  __m256d x[4] = {_mm512_castpd512_pd256((__m512d)a), _mm512_castpd512_pd256((__m512d)b),
                  _mm512_castpd512_pd256((__m512d)c), _mm512_castpd512_pd256((__m512d)d)};
  __m256d y[4] = {_mm512_extractf64x4_pd((__m512d)a, 1), _mm512_extractf64x4_pd((__m512d)b, 1),
                  _mm512_extractf64x4_pd((__m512d)c, 1), _mm512_extractf64x4_pd((__m512d)d, 1)};
  lanes_store_square(x, to, stride), lanes_store_square(y, to + 4 * stride, stride);
#elif LANES == 4
  __m256d x[4] = {(__m256d)a, (__m256d)b, (__m256d)c, (__m256d)d};
  lanes_store_square(x, to, stride);
#else
  for (size_t k = 0; k < LANES; k++) {
    double *x = to + k * stride;
    x[0] = a[k], x[1] = b[k], x[2] = c[k], x[3] = d[k];
  }
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

/* How many lanes of the mask are set. */
LANES_INLINE unsigned lanes_count(lane_mask mask) { return (unsigned)__builtin_popcount(lanes_bits(mask)); }

/* Whether any lane of the mask is set. */
LANES_INLINE int lanes_any(lane_mask mask) { return lanes_bits(mask) != 0; }

#endif
