/* A few doubles side by side: one ray per lane.
 *
 * Plain GCC/clang vector extensions, so one source serves every instruction set. LANES is what one register of the
 * target holds; the compiler takes wider vectors apart into single doubles, which costs more than they save.
 * Arithmetic operators work lane by lane; a comparison gives a mask whose lanes are 0 or -1. A source that uses this is
 * compiled once per instruction set (base/kernel.h).
 */
#ifndef PSCN_BASE_LANES_H
#define PSCN_BASE_LANES_H

#include <stddef.h>
#include <stdint.h>

#if defined(__SSE2__)
#include <immintrin.h>
#endif

/* LANES_OP(min_pd) is the intrinsic of that name for the whole register. Without SSE2 there are none. */
#if defined(__AVX512F__) && defined(__AVX512DQ__)
#define LANES 8
#define LANES_OP(name) _mm512_##name
#elif defined(__AVX__)
#define LANES 4
#define LANES_OP(name) _mm256_##name
#else
#define LANES 2
#if defined(__SSE2__)
#define LANES_OP(name) _mm_##name
#endif
#endif

typedef double lanes __attribute__((vector_size(8 * LANES)));
typedef int64_t lane_mask __attribute__((vector_size(8 * LANES)));

#define LANES_INLINE static inline __attribute__((always_inline, unused))

/* Lane k: x. (x - 0 keeps every x, -0 and NaN included.) */
LANES_INLINE lanes lanes_all(double x) { return x - (lanes){0}; }

/* Four doubles, whatever a register holds. */
typedef double four_doubles __attribute__((vector_size(32)));

/* Transposes: number k of row n becomes number n of row k. */
LANES_INLINE void four_doubles_turn(four_doubles x[4])
{
  const four_doubles a = __builtin_shufflevector(x[0], x[1], 0, 4, 2, 6),
                     b = __builtin_shufflevector(x[0], x[1], 1, 5, 3, 7);
  const four_doubles c = __builtin_shufflevector(x[2], x[3], 0, 4, 2, 6),
                     d = __builtin_shufflevector(x[2], x[3], 1, 5, 3, 7);
  x[0] = __builtin_shufflevector(a, c, 0, 1, 4, 5), x[1] = __builtin_shufflevector(b, d, 0, 1, 4, 5);
  x[2] = __builtin_shufflevector(a, c, 2, 3, 6, 7), x[3] = __builtin_shufflevector(b, d, 2, 3, 6, 7);
}

#if defined(__AVX__)
LANES_INLINE void lanes_load_square(const double *from, size_t stride, four_doubles x[4])
{
  x[0] = _mm256_loadu_pd(from), x[1] = _mm256_loadu_pd(from + stride);
  x[2] = _mm256_loadu_pd(from + 2 * stride), x[3] = _mm256_loadu_pd(from + 3 * stride);
  four_doubles_turn(x);
}

LANES_INLINE void lanes_store_square(four_doubles x[4], double *to, size_t stride)
{
  four_doubles_turn(x);
  _mm256_storeu_pd(to, x[0]), _mm256_storeu_pd(to + stride, x[1]);
  _mm256_storeu_pd(to + 2 * stride, x[2]), _mm256_storeu_pd(to + 3 * stride, x[3]);
}
#endif

/* Lane k: from[k * stride]. */
LANES_INLINE lanes lanes_load_every(const double *from, size_t stride)
{
  lanes x = {0};
  for (size_t k = 0; k < LANES; k++) x[k] = from[k * stride];
  return x;
}

/* Lane k of *a, *b, *c, *d: from[k * stride] and the three numbers after it. */
LANES_INLINE void lanes_load4(const double *from, size_t stride, lanes *a, lanes *b, lanes *c, lanes *d)
{
#if LANES == 8
  four_doubles x[4], y[4];
  lanes_load_square(from, stride, x), lanes_load_square(from + 4 * stride, stride, y);
  *a = _mm512_insertf64x4(_mm512_castpd256_pd512(x[0]), y[0], 1);
  *b = _mm512_insertf64x4(_mm512_castpd256_pd512(x[1]), y[1], 1);
  *c = _mm512_insertf64x4(_mm512_castpd256_pd512(x[2]), y[2], 1);
  *d = _mm512_insertf64x4(_mm512_castpd256_pd512(x[3]), y[3], 1);
#elif LANES == 4
  four_doubles x[4];
  lanes_load_square(from, stride, x);
  *a = x[0], *b = x[1], *c = x[2], *d = x[3];
#else
  for (size_t k = 0; k < LANES; k++) {
    const double *x = from + k * stride;
    (*a)[k] = x[0], (*b)[k] = x[1], (*c)[k] = x[2], (*d)[k] = x[3];
  }
#endif
}

/* The inverse of lanes_load4: to[k * stride] and the three numbers after it are lane k of a, b, c, d. */
LANES_INLINE void lanes_store4(lanes a, lanes b, lanes c, lanes d, double *to, size_t stride)
{
#if LANES == 8
  four_doubles x[4] = {_mm512_castpd512_pd256(a), _mm512_castpd512_pd256(b), _mm512_castpd512_pd256(c),
                       _mm512_castpd512_pd256(d)};
  four_doubles y[4] = {_mm512_extractf64x4_pd(a, 1), _mm512_extractf64x4_pd(b, 1), _mm512_extractf64x4_pd(c, 1),
                       _mm512_extractf64x4_pd(d, 1)};
  lanes_store_square(x, to, stride), lanes_store_square(y, to + 4 * stride, stride);
#elif LANES == 4
  four_doubles x[4] = {a, b, c, d};
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
#if LANES == 8
  return _mm512_mask_blend_pd(_mm512_movepi64_mask((__m512i)mask), b, a);
#elif LANES == 4
  return _mm256_blendv_pd(b, a, (__m256d)mask);
#else
  return (lanes)((mask & (lane_mask)a) | (~mask & (lane_mask)b));
#endif
}

/* Lane k: a < b ? a : b, so b where either is NaN. */
LANES_INLINE lanes lanes_min(lanes a, lanes b)
{
#if defined(LANES_OP)
  return LANES_OP(min_pd)(a, b);
#else
  return lanes_select(a < b, a, b);
#endif
}

/* Lane k: a > b ? a : b, so b where either is NaN. */
LANES_INLINE lanes lanes_max(lanes a, lanes b)
{
#if defined(LANES_OP)
  return LANES_OP(max_pd)(a, b);
#else
  return lanes_select(a > b, a, b);
#endif
}

/* Lane k: x clamped to [lo, hi]; lo if it is NaN. */
LANES_INLINE lanes lanes_clamp(lanes x, double lo, double hi)
{
  return lanes_min(lanes_max(x, lanes_all(lo)), lanes_all(hi));
}

LANES_INLINE lanes lanes_abs(lanes a) { return (lanes)((lane_mask)a & (INT64_MAX - (lane_mask){0})); }

/* Lane k: the square root. */
LANES_INLINE lanes lanes_sqrt(lanes a)
{
#if defined(LANES_OP)
  return LANES_OP(sqrt_pd)(a);
#else
  for (int k = 0; k < LANES; k++) a[k] = __builtin_sqrt(a[k]);
  return a;
#endif
}

/* Lane k: a b - product, with one rounding. If product is a b rounded, this is its error, exactly. Written so that no
 * contraction of multiply and add by the compiler can change it. */
LANES_INLINE lanes lanes_product_error(lanes a, lanes b, lanes product)
{
#if LANES == 8 || defined(__FMA__)
  return LANES_OP(fmsub_pd)(a, b, product);
#else
  for (int k = 0; k < LANES; k++) a[k] = __builtin_fma(a[k], b[k], -product[k]);
  return a;
#endif
}

/* Lane k: a b + c, with one rounding or two. */
LANES_INLINE lanes lanes_multiply_add(lanes a, lanes b, lanes c)
{
#if LANES == 8 || defined(__FMA__)
  return LANES_OP(fmadd_pd)(a, b, c);
#else
  return a * b + c;
#endif
}

/* The mask as bits: bit k is lane k. */
LANES_INLINE unsigned lanes_bits(lane_mask mask)
{
#if LANES == 8
  return _mm512_movepi64_mask((__m512i)mask);
#elif defined(LANES_OP)
  return (unsigned)LANES_OP(movemask_pd)((lanes)mask);
#else
  unsigned bits = 0;
  for (int k = 0; k < LANES; k++) bits |= (unsigned)(mask[k] & 1) << k;
  return bits;
#endif
}

/* The mask with these bits. */
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
