/* Small functions on doubles that the standard library lacks, or has slower. */
#ifndef PSCN_BASE_REAL_H
#define PSCN_BASE_REAL_H

#include <assert.h>
#include <float.h>
#include <math.h>
#include <stdint.h>
#include <string.h>

/* Error bounds and exact sums hold only if each operation is rounded by itself, to double, and none is moved. */
static_assert(FLT_EVAL_METHOD == 0, "doubles are not rounded to double after each operation");
#if defined(__FAST_MATH__) || defined(__ASSOCIATIVE_MATH__) || defined(__RECIPROCAL_MATH__) || \
  (defined(__FINITE_MATH_ONLY__) && __FINITE_MATH_ONLY__)
#error "-ffast-math, -Ofast and their parts break every proof: compile without them"
#endif

/* The unit roundoff of double: the most that one operation's relative error can be. */
#define UNIT_ROUNDOFF 0x1p-53

/* The smaller and the larger of two doubles, as one instruction each. Unlike fmin and fmax: b if either is NaN. */
static inline double real_min(double a, double b) { return a < b ? a : b; }
static inline double real_max(double a, double b) { return a > b ? a : b; }

/* x clamped to [lo, hi]; lo if it is NaN. */
static inline double real_clamp(double x, double lo, double hi) { return real_min(real_max(x, lo), hi); }

/* 2^exponent, or the largest power of two that is a double. */
static inline double real_power_of_two(int exponent)
{
  return ldexp(1, exponent < DBL_MAX_EXP ? exponent : DBL_MAX_EXP - 1);
}

/* x as it is stored, in IEEE 754's binary64: sign, exponent, fraction from the top bit down. */
static inline uint64_t real_bits(double x)
{
  uint64_t bits;
  memcpy(&bits, &x, sizeof bits);
  return bits;
}

/* 0 if x is finite. Only infinities and NaN have an exponent of ones, which carries into the sign. The results of many
 * numbers may be joined by |. */
static inline uint64_t real_infinite(double x) { return ((real_bits(x) & INT64_MAX) + (UINT64_C(1) << 52)) >> 63; }

/* x rounded to a multiple of the power of two `grain`. */
static inline double real_coarse(double x, double grain) { return rint(x / grain) * grain; }

#endif
