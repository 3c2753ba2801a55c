/* Conversion between doubles and decimal digits, in integers. */
#include "base/decimal.h"

#include <assert.h>
#include <float.h>
#include <math.h>

#include "base/real.h"

typedef unsigned __int128 uint128; /* of gcc and clang on every 64-bit machine */

enum {
  STORED_POWERS = 28, /* 5^27 is the largest power of 5 in 64 bits */
  MAX_POWER = 54,     /* a product of two of them */
  MAX_DIGITS = 17
};

/* A power of 5 and the next three. */
#define FOUR_POWERS(power) power, 5 * power, 25 * power, 125 * power

static const uint64_t POWERS_OF_FIVE[STORED_POWERS] = {FOUR_POWERS(UINT64_C(1)),
                                                       FOUR_POWERS(UINT64_C(625)),
                                                       FOUR_POWERS(UINT64_C(390625)),
                                                       FOUR_POWERS(UINT64_C(244140625)),
                                                       FOUR_POWERS(UINT64_C(152587890625)),
                                                       FOUR_POWERS(UINT64_C(95367431640625)),
                                                       FOUR_POWERS(UINT64_C(59604644775390625))};

/* 10^n for n <= 19. */
static uint64_t power_of_ten(int n) { return POWERS_OF_FIVE[n] << n; }

/* 5^n for n <= MAX_POWER, exact. */
static uint128 power_of_five(int n)
{
  const int low = n < STORED_POWERS ? n : STORED_POWERS - 1;
  return (uint128)POWERS_OF_FIVE[low] * POWERS_OF_FIVE[n - low];
}

/* mantissa x 5^power / 2^shift, rounded to an integer, ties to even. The result must fit in 64 bits. mantissa < 2^53,
 * 1 <= shift < 192. */
static uint64_t scale(uint64_t mantissa, int power, int shift)
{
  const uint128 five = power_of_five(power);
  const uint128 low_product = (uint128)(uint64_t)five * mantissa;
  const uint128 high = (uint128)(uint64_t)(five >> 64) * mantissa + (low_product >> 64); /* of 2^64; < 2^117 */
  const uint64_t low = (uint64_t)low_product;
  uint64_t whole, fraction, rest; /* the fraction's first 64 bits, and whether anything follows */
  if (shift < 64) {
    whole = (uint64_t)(high << (64 - shift)) | low >> shift;
    fraction = low << (64 - shift);
    rest = 0;
  } else if (shift == 64) {
    whole = (uint64_t)high;
    fraction = low;
    rest = 0;
  } else if (shift < 128) {
    whole = (uint64_t)(high >> (shift - 64));
    fraction = (uint64_t)(high << (128 - shift));
    rest = low;
  } else {
    whole = (uint64_t)(high >> 64) >> (shift - 128);
    fraction = (uint64_t)(high >> (shift - 128));
    rest = (uint64_t)(high << (192 - shift)) | low;
  }
  const uint64_t half = UINT64_C(1) << 63;
  const bool up = fraction > half || (fraction == half && (rest != 0 || (whole & 1) != 0));
  return whole + up;
}

bool decimal_from_double(double value, int count, uint64_t *out_digits, int *out_exponent)
{
  if (count < 1 || count > MAX_DIGITS || !(value >= DBL_MIN && value <= 1e16)) return false;
  const uint64_t bits = real_bits(value);
  const uint64_t mantissa = (bits & ((UINT64_C(1) << 52) - 1)) | UINT64_C(1) << 52;
  const int binary = (int)(bits >> 52) - 1075; /* value = mantissa x 2^binary */
  /* The decimal exponent of the first digit, by value >= 2^(binary + 52): right or one too small. */
  int first = (int)floor((binary + DBL_MANT_DIG - 1) * 0.30102999566398120);
  for (;; first++) {
    const int power = count - 1 - first; /* digits = value x 10^power */
    const int shift = -(binary + power);
    if (power < 0 || power > MAX_POWER || shift < 1) return false;
    assert(shift < 192); /* otherwise the value would be less than one digit */
    /* Before rounding, the digits must be fewer than 10^count. With an exponent one too small they are at most ten
     * times as many, which still fits. */
    uint64_t digits = scale(mantissa, power, shift);
    if (digits > power_of_ten(count)) continue;
    if (digits == power_of_ten(count)) { /* rounded up to the next power, or exactly that power */
      digits /= 10;
      first++;
    }
    *out_digits = digits;
    *out_exponent = first - (count - 1);
    return true;
  }
}

/* The double nearest to (value + something in (0,1) if `sticky`) x 2^binary, for 2^63 <= value; in the normal range. */
static double round_wide(uint128 value, bool sticky, int binary)
{
  const uint64_t top = (uint64_t)(value >> 64);
  const int bits = top != 0 ? 128 - __builtin_clzll(top) : 64;
  const int excess = bits - DBL_MANT_DIG; /* at least 11 */
  const uint128 half = (uint128)1 << (excess - 1);
  const uint128 fraction = value & (2 * half - 1);
  uint64_t whole = (uint64_t)(value >> excess);
  whole += fraction > half || (fraction == half && (sticky || (whole & 1) != 0));
  return ldexp((double)whole, binary + excess);
}

bool decimal_to_double(uint64_t digits, int exponent, double *out_value)
{
  if (digits == 0 || exponent <= -STORED_POWERS || exponent >= STORED_POWERS) return false;
  const int zeros = __builtin_clzll(digits);
  const uint64_t shifted = digits << zeros;
  if (exponent >= 0) {
    *out_value = round_wide((uint128)shifted * POWERS_OF_FIVE[exponent], false, exponent - zeros);
  } else {
    const uint128 numerator = (uint128)shifted << 64;
    const uint64_t five = POWERS_OF_FIVE[-exponent];
    const uint128 quotient = numerator / five; /* >= 2^127 / 2^63 */
    *out_value = round_wide(quotient, quotient * five != numerator, exponent - zeros - 64);
  }
  return true;
}
