/* Signed integers of a few limbs.
 *
 * Internal to src/intersect/exact. A number is `n` limbs, the least first, in two's complement. All functions are exact
 * if the result fits into the limbs of `out`; whoever calls sees to that. out may be an operand, but not of a product.
 * Nothing allocates, numbers of ordinary rays are a few limbs long, and only sums and products are needed. So these
 * loops stand here rather than a library of integers of any size.
 */
#ifndef PSCN_INTERSECT_EXACT_LIMBS_H
#define PSCN_INTERSECT_EXACT_LIMBS_H

#include <math.h>
#include <stdbool.h>
#include <stdint.h>
#include <string.h>

#include "base/wide.h"

typedef uint64_t limb;
__extension__ typedef unsigned __int128 limb_pair;
__extension__ typedef __int128 limb_sum; /* of some numbers of 64 bits */
enum { LIMB_BITS = 64 };

/* 0, or all bits set for a negative number. */
static inline limb limbs_fill(const limb *a, int n) { return -(a[n - 1] >> (LIMB_BITS - 1)); }

static inline limb limbs_at(const limb *a, int n, int k) { return k < n ? a[k] : limbs_fill(a, n); }

static inline bool limbs_zero(const limb *a, int n)
{
  limb any = 0;
  for (int k = 0; k < n; k++) any |= a[k];
  return any == 0;
}

/* The least number of bits b with -2^b <= a < 2^b. */
static inline int limbs_bits(const limb *a, int n)
{
  const limb fill = limbs_fill(a, n);
  for (int k = n; k-- > 0;)
    if (a[k] != fill) return LIMB_BITS * k + LIMB_BITS - __builtin_clzll(a[k] ^ fill);
  return 0;
}

/* The limbs that a number of so many bits takes, with its sign. */
static inline int limbs_for(int bits) { return bits / LIMB_BITS + 1; }

/* Of a number that is not 0: how often 2 divides it. */
static inline int limbs_twos(const limb *a)
{
  int k = 0;
  while (a[k] == 0) k++;
  return LIMB_BITS * k + __builtin_ctzll(a[k]);
}

static inline void limbs_copy(limb *out, int n, const limb *a, int na)
{
  const limb fill = limbs_fill(a, na);
  for (int k = 0; k < n; k++) out[k] = k < na ? a[k] : fill;
}

/* out = x / 2^low, an integer less than 2^(64 n - 1) in size. */
static inline void limbs_double(limb *out, int n, double x, int low)
{
  int exponent;
  const int64_t number = (int64_t)ldexp(frexp(x, &exponent), 53);
  const int shift = number ? exponent - 53 - low : 0, whole = shift / LIMB_BITS;
  const limb_sum part = (limb_sum)number * ((limb_sum)1 << shift % LIMB_BITS);
  for (int k = 0; k < n; k++) out[k] = k < whole ? 0 : (limb)(part >> (k == whole ? 0 : k == whole + 1 ? 64 : 127));
}

/* out = a + b, or a - b; all of n limbs */
static inline void limbs_add(limb *out, const limb *a, const limb *b, int n)
{
  limb_pair sum = 0;
  for (int k = 0; k < n; k++) sum += (limb_pair)a[k] + b[k], out[k] = (limb)sum, sum >>= LIMB_BITS;
}

static inline void limbs_subtract(limb *out, const limb *a, const limb *b, int n)
{
  limb_pair sum = 1;
  for (int k = 0; k < n; k++) sum += (limb_pair)a[k] + ~b[k], out[k] = (limb)sum, sum >>= LIMB_BITS;
}

/* out = a b; out is neither of them */
static inline void limbs_product(limb *restrict out, int n, const limb *a, int na, const limb *b, int nb)
{
  memset(out, 0, (size_t)n * sizeof *out);
  for (int i = 0; i < na && i < n; i++) {
    limb_pair sum = 0;
    for (int k = 0; i + k < n; k++) {
      sum += (limb_pair)a[i] * limbs_at(b, nb, k) + out[i + k];
      out[i + k] = (limb)sum, sum >>= LIMB_BITS;
    }
  }
  limb_pair sum = 1;
  for (int k = 0; na + k < n && limbs_fill(a, na); k++) { /* a is the sum of its limbs less 2^(64 na) */
    sum += (limb_pair)out[na + k] + ~limbs_at(b, nb, k);
    out[na + k] = (limb)sum, sum >>= LIMB_BITS;
  }
}

/* The largest integer no more than a / 2^shift, modulo 2^64. */
static inline int64_t limbs_window(const limb *a, int n, int shift)
{
  const int whole = shift / LIMB_BITS, part = shift % LIMB_BITS;
  const limb low = limbs_at(a, n, whole), high = limbs_at(a, n, whole + 1);
  return (int64_t)(part ? low >> part | high << (LIMB_BITS - part) : low);
}

/* a 2^exponent, below 2^1000, in wide arithmetic, rounded down. *exact: nothing was rounded away. */
static inline wide limbs_wide(const limb *a, int n, int exponent, bool *exact)
{
  const int bits = limbs_bits(a, n), shift = bits > 112 ? bits - 112 : 0;
  const wide high = (wide)limbs_window(a, n, shift + 56);
  const wide low = (wide)((limb)limbs_window(a, n, shift) & (((limb)1 << 56) - 1));
  *exact = shift == 0 || limbs_twos(a) >= shift;
  wide x = high * 0x1p56 + low;
  for (exponent += shift; exponent < -1000; exponent += 1000) x *= 0x1p-1000;
  return x * (wide)ldexp(1, exponent);
}

#endif
