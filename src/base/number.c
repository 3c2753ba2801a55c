/* Numbers as text. Reading gathers the digits into an integer and a power of ten. If both are exact in double, one
 * multiplication or division rounds correctly (Clinger 1990, "How to read floating point numbers accurately"). Other
 * numbers of everyday size are read and written in integers: with 5^n for n <= 54 in 128 bits, a double times a power of
 * ten is an integer times a power of two, so rounding is one exact comparison (ties to even, as IEEE arithmetic and
 * printf round). The rest goes to strtod and printf, without a decimal point, so that it means the same in every
 * locale. */
#include "base/number.h"

#include <assert.h>
#include <float.h>
#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/real.h"

enum {
  EXACT_DIGITS = 19,      /* an integer of this many decimal digits fits in 64 bits */
  EXACT_POWER = 22,       /* 10^22 is the largest power of ten that is a double */
  DECISIVE_DIGITS = 770,  /* a tie between doubles has at most 768 digits; further ones only break ties */
  EXPONENT_LIMIT = 100000 /* beyond it only the sign of the exponent matters, whatever the digits */
};

static const double POWERS_OF_TEN[EXACT_POWER + 1] = {1e0,  1e1,  1e2,  1e3,  1e4,  1e5,  1e6,  1e7,
                                                      1e8,  1e9,  1e10, 1e11, 1e12, 1e13, 1e14, 1e15,
                                                      1e16, 1e17, 1e18, 1e19, 1e20, 1e21, 1e22};

enum { SURE_DIGITS = 15, MAX_DIGITS = 17 }; /* 15 digits survive in a double, 17 tell any two doubles apart */

/* ---- conversion in integers ---- */

typedef unsigned __int128 uint128; /* of gcc and clang on every 64-bit machine */

enum {
  STORED_POWERS = 28, /* 5^27 is the largest power of 5 in 64 bits */
  MAX_POWER = 54      /* a product of two of them */
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

/* The nearest decimal number of `count` digits, 1 <= count <= 17: digits x 10^exponent, 10^(count-1) <= digits <
 * 10^count. Always true for count 17 and 1e-30 <= value <= 1e15. Other numbers may give false, and nothing is
 * written. */
static bool decimal_from_double(double value, int count, uint64_t *out_digits, int *out_exponent)
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

/* The double nearest to digits x 10^exponent, digits > 0. Always true for exponents from -27 to 27; otherwise false,
 * and nothing is written. */
static bool decimal_to_double(uint64_t digits, int exponent, double *out_value)
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

/* ---- reading ---- */

static bool is_digit(char c) { return c >= '0' && c <= '9'; }

/* The decimal digits of a number in the text, and their value. */
struct decimal {
  size_t digits_begin, digits_end; /* of the text: digits and at most one point */
  uint64_t mantissa;               /* the first EXACT_DIGITS digits from the first nonzero one */
  int64_t significant;             /* number of digits from the first nonzero one */
  int64_t exponent;                /* the value is the digits as one integer, times 10^exponent */
};

/* Adds the digits from text[i] on. Returns where they end. */
static size_t add_digits(const char *text, size_t length, size_t i, struct decimal *out)
{
  uint64_t mantissa = out->mantissa;
  if (mantissa == 0)
    while (i < length && text[i] == '0') i++;
  const size_t begin = i, room = out->significant < EXACT_DIGITS ? (size_t)(EXACT_DIGITS - out->significant) : 0;
  for (; i < length && is_digit(text[i]); i++)
    if (i - begin < room) mantissa = 10 * mantissa + (uint64_t)(text[i] - '0');
  out->mantissa = mantissa;
  out->significant += (int64_t)(i - begin);
  return i;
}

static size_t read_digits(const char *text, size_t length, struct decimal *out)
{
  const size_t begin = out->digits_begin, point = add_digits(text, length, begin, out);
  size_t end = point;
  if (point < length && text[point] == '.') {
    end = add_digits(text, length, point + 1, out);
    out->exponent = -(int64_t)(end - point - 1);
  }
  out->digits_end = end;
  return end - begin > (end > point) ? end : 0;
}

static size_t read_exponent(const char *text, size_t length, size_t i, struct decimal *out)
{
  if (i >= length || (text[i] != 'e' && text[i] != 'E')) return i;
  size_t j = i + 1;
  bool negative = false;
  if (j < length && (text[j] == '+' || text[j] == '-')) negative = text[j++] == '-';
  if (j >= length || !is_digit(text[j])) return i;
  int64_t exponent = 0;
  for (; j < length && is_digit(text[j]); j++)
    if (exponent < INT64_C(1000000000000)) exponent = 10 * exponent + (text[j] - '0');
  out->exponent += negative ? -exponent : exponent;
  return j;
}

/* Correct for any digits: strtod gets at most DECISIVE_DIGITS of them, and a last 1 for those left out. */
static double convert_slowly(const char *text, struct decimal decimal)
{
  char digits[DECISIVE_DIGITS + 40];
  size_t count = 0;
  int64_t left_out = 0;
  bool nonzero_left_out = false;
  for (size_t i = decimal.digits_begin; i < decimal.digits_end; i++) {
    if (text[i] == '.' || (count == 0 && text[i] == '0')) continue;
    if (count < DECISIVE_DIGITS) {
      digits[count++] = text[i];
    } else {
      left_out++;
      nonzero_left_out |= text[i] != '0';
    }
  }
  int64_t exponent = decimal.exponent + left_out;
  if (nonzero_left_out) {
    digits[count++] = '1';
    exponent--;
  }
  if (exponent > EXPONENT_LIMIT) exponent = EXPONENT_LIMIT;
  if (exponent < -EXPONENT_LIMIT) exponent = -EXPONENT_LIMIT;
  sprintf(digits + count, "e%d", (int)exponent);
  return strtod(digits, NULL);
}

enum number_kind number_read(const char *text, size_t length, double *out_value, size_t *out_used)
{
  size_t i = 0;
  bool negative = false;
  if (i < length && (text[i] == '+' || text[i] == '-')) negative = text[i++] == '-';
  struct decimal decimal = {.digits_begin = i};
  i = read_digits(text, length, &decimal);
  if (i == 0) return NUMBER_NONE;
  i = read_exponent(text, length, i, &decimal);

  double value;
  const uint64_t exact = UINT64_C(1) << 53;
  if (decimal.mantissa == 0) {
    value = 0.0;
  } else if (decimal.significant <= EXACT_DIGITS && decimal.mantissa <= exact && decimal.exponent >= -EXACT_POWER &&
             decimal.exponent <= EXACT_POWER) {
    value = (double)(int64_t)decimal.mantissa;
    if (decimal.exponent < 0) value /= POWERS_OF_TEN[-decimal.exponent];
    else value *= POWERS_OF_TEN[decimal.exponent];
  } else if (decimal.significant > EXACT_DIGITS || llabs(decimal.exponent) > EXPONENT_LIMIT ||
             !decimal_to_double(decimal.mantissa, (int)decimal.exponent, &value)) {
    value = convert_slowly(text, decimal);
  }
  *out_value = negative ? -value : value;
  *out_used = i;
  return isfinite(value) ? NUMBER_FINITE : NUMBER_OVERFLOW;
}

/* ---- writing ---- */

/* Lays out digits d.ddd times 10^exponent: plainly where that is short, otherwise with an exponent. */
static size_t lay_out(bool negative, const char *digits, int count, int exponent, char *out)
{
  enum { PLAIN_BELOW = 17, PLAIN_FROM = -5 };
  char *to = out;
  if (negative) *to++ = '-';
  if (exponent >= PLAIN_FROM && exponent < PLAIN_BELOW) {
    if (exponent < 0) {
      *to++ = '0';
      *to++ = '.';
      for (int i = -1; i > exponent; i--) *to++ = '0';
      for (int i = 0; i < count; i++) *to++ = digits[i];
    } else {
      for (int i = 0; i < count || i <= exponent; i++) {
        if (i == exponent + 1) *to++ = '.';
        *to++ = i < count ? digits[i] : '0';
      }
    }
    *to = '\0';
  } else {
    *to++ = digits[0];
    if (count > 1) *to++ = '.';
    for (int i = 1; i < count; i++) *to++ = digits[i];
    to += sprintf(to, "e%d", exponent);
  }
  return (size_t)(to - out);
}

/* `count` correctly rounded significant digits of a finite value other than 0. The decimal point of "%e" depends on the
 * locale and may be several bytes; it is skipped. */
static void round_to_digits(double value, int count, char *out_digits, int *out_exponent)
{
  uint64_t integer;
  if (decimal_from_double(fabs(value), count, &integer, out_exponent)) {
    *out_exponent += count - 1;
    /* The last eight digits and the others do not wait for each other. */
    uint32_t part[2] = {(uint32_t)(integer % 100000000), (uint32_t)(integer / 100000000)};
    for (int k = count - 1; k >= 0; k--) {
      uint32_t *left = &part[k < count - 8];
      out_digits[k] = (char)('0' + *left % 10);
      *left /= 10;
    }
    return;
  }
  char text[64];
  snprintf(text, sizeof text, "%.*e", count - 1, fabs(value));
  int found = 0;
  const char *from = text;
  for (; found < count; from++)
    if (is_digit(*from)) out_digits[found++] = *from;
  *out_exponent = atoi(from + 1);
}

/* Writes `count` significant digits, without trailing zeros. Returns the length. */
static size_t write_rounded(double value, int count, char *out)
{
  char digits[MAX_DIGITS];
  int exponent = 0;
  if (!isfinite(value) || value == 0) {
    strcpy(out, isnan(value) ? "nan" : isinf(value) ? (value < 0 ? "-inf" : "inf") : signbit(value) ? "-0" : "0");
    return strlen(out);
  }
  round_to_digits(value, count, digits, &exponent);
  while (count > 1 && digits[count - 1] == '0') count--;
  return lay_out(value < 0, digits, count, exponent, out);
}

size_t number_write(double value, char *out)
{
  const int first = fabs(value) < DBL_MIN ? 1 : SURE_DIGITS; /* subnormals hold fewer digits */
  size_t length = 0, used;
  double back = (double)NAN;
  for (int count = first; count <= MAX_DIGITS && back != value; count++) {
    length = write_rounded(value, count, out);
    (void)number_read(out, length, &back, &used);
  }
  return length;
}

size_t number_write_17(double value, char *out) { return write_rounded(value, MAX_DIGITS, out); }
