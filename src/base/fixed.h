/* Fixed-point numbers: whole multiples of FIXED_UNIT, 2^-117, smaller than 512 in size. Sums and differences are the
 * language's own, and exact; a product takes four multiplications of the processor. Where numbers are of one size and
 * errors are absolute, this gives more digits than `wide`, at an eighth of the time. Pure; the same on every machine.
 */
#ifndef PSCN_BASE_FIXED_H
#define PSCN_BASE_FIXED_H

#include <stdint.h>

#include "base/wide.h"

__extension__ typedef __int128 fixed; /* of gcc and clang on every 64-bit machine */
__extension__ typedef unsigned __int128 fixed_bits;

#define FIXED_UNIT 0x1p-117
enum { FIXED_POINT = 117 };

/* Each has an error below FIXED_UNIT. */
static inline fixed fixed_from(double x) { return (fixed)(x * (1 / FIXED_UNIT)); }
static inline fixed fixed_from_wide(wide x) { return (fixed)(x * (wide)(1 / FIXED_UNIT)); }

/* Rounded. */
static inline double fixed_double(fixed a) { return (double)a * FIXED_UNIT; }
static inline wide fixed_wide(fixed a) { return (wide)a * (wide)FIXED_UNIT; }

static inline fixed fixed_size(fixed a) { return a < 0 ? -a : a; }
static inline fixed fixed_max(fixed a, fixed b) { return a > b ? a : b; }

/* Rounded towards zero: the error is below 2 FIXED_UNIT. */
static inline fixed fixed_product(fixed a, fixed b)
{
  const fixed_bits p = (fixed_bits)fixed_size(a), q = (fixed_bits)fixed_size(b);
  const uint64_t p1 = (uint64_t)(p >> 64), p0 = (uint64_t)p, q1 = (uint64_t)(q >> 64), q0 = (uint64_t)q;
  /* p1 and q1 are below 2^62, so the sum is below 2^127. */
  const fixed_bits middle = (fixed_bits)p1 * q0 + (fixed_bits)p0 * q1 + (uint64_t)((fixed_bits)p0 * q0 >> 64);
  const fixed size = (fixed)(((fixed_bits)p1 * q1 << (128 - FIXED_POINT)) + (middle >> (FIXED_POINT - 64)));
  return (a < 0) != (b < 0) ? -size : size;
}

#endif
