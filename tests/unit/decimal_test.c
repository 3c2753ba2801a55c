/* Between doubles and decimal digits: against the C library, which is exact as well. */
#include "base/decimal.h"

#include <float.h>
#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cmocka_test.h"
#include "random.h"

enum { RANDOM_NUMBERS = 200000 };

/* A random mantissa, without sign, times 2^binary. */
static double random_double(struct random *random, int binary)
{
  return ldexp((double)(random_bits(random) >> 11 | UINT64_C(1) << 52), binary - 52);
}

static void expect_digits(double value, int count, uint64_t digits, int exponent)
{
  char text[64], ours[64];
  /* "%.*e" writes d.ddd; the point may be any character. So digits and exponent are compared apart. */
  snprintf(text, sizeof text, "%.*e", count - 1, value);
  snprintf(ours, sizeof ours, "%" PRIu64, digits);
  char theirs[64];
  size_t length = 0;
  for (const char *c = text; *c != 'e'; c++)
    if (*c >= '0' && *c <= '9') theirs[length++] = *c;
  theirs[length] = '\0';
  if (strcmp(ours, theirs) != 0 || atoi(strchr(text, 'e') + 1) != exponent + count - 1)
    print_error("%a as %d digits: %s here, %s there\n", value, count, ours, text);
  assert_string_equal(ours, theirs);
  assert_int_equal(atoi(strchr(text, 'e') + 1), exponent + count - 1);
}

TEST(digits_are_printfs)
{
  struct random random = {2021};
  uint64_t digits;
  int exponent;
  for (int k = 0; k < RANDOM_NUMBERS; k++) {
    const double value = random_double(&random, (int)(random_bits(&random) % 236) - 185); /* 1e-56 to 1e15 */
    const int count = 1 + k % 17;
    if (decimal_from_double(value, count, &digits, &exponent)) expect_digits(value, count, digits, exponent);
    else assert_true(count < 17 || value < 1e-37);
  }
}

TEST(ties_and_powers)
{
  static const double values[] = {0.5,
                                  1,
                                  1.5,
                                  2.5,
                                  0.125,
                                  0.375,
                                  9.5,
                                  99.5,
                                  0.95,
                                  9.99999,
                                  1e-5,
                                  1e15,
                                  1e14,
                                  999999,
                                  0x1p-60,
                                  0x1p49,
                                  1e-30,
                                  0.1,
                                  1.0 - DBL_EPSILON / 2,
                                  1.0 + DBL_EPSILON,
                                  123456789012345.5,
                                  5e-1,
                                  25,
                                  35,
                                  1e-22};
  uint64_t digits;
  int exponent;
  for (size_t k = 0; k < sizeof values / sizeof values[0]; k++) {
    assert_true(decimal_from_double(values[k], 17, &digits, &exponent));
    for (int count = 1; count <= 17; count++)
      if (decimal_from_double(values[k], count, &digits, &exponent)) expect_digits(values[k], count, digits, exponent);
  }
  static const double outside[] = {0, -1, INFINITY, NAN, 1e300, DBL_TRUE_MIN, DBL_MIN};
  for (size_t k = 0; k < sizeof outside / sizeof outside[0]; k++)
    assert_false(decimal_from_double(outside[k], 17, &digits, &exponent));
}

static void expect_double(uint64_t digits, int exponent)
{
  char text[64];
  snprintf(text, sizeof text, "%" PRIu64 "e%d", digits, exponent);
  double value = 0;
  assert_true(decimal_to_double(digits, exponent, &value));
  if (value != strtod(text, NULL)) print_error("%s: %a here, %a there\n", text, value, strtod(text, NULL));
  assert_true(value == strtod(text, NULL));
}

TEST(doubles_are_strtods)
{
  struct random random = {1982};
  for (int k = 0; k < RANDOM_NUMBERS; k++) {
    const uint64_t digits = random_bits(&random) >> (random_bits(&random) % 64);
    if (digits != 0) expect_double(digits, (int)(random_bits(&random) % 55) - 27);
  }
}

TEST(halfway_cases)
{
  /* Integers half way between two doubles, and one less and one more; also times powers of ten that a division removes
   * again. */
  for (int bits = 54; bits <= 63; bits++) {
    for (uint64_t odd = 0; odd < 4; odd++) {
      const uint64_t unit = UINT64_C(1) << (bits - 53); /* twice the last place of a double of this size */
      const uint64_t middle = (UINT64_C(1) << bits) + odd * unit + unit / 2;
      for (int step = -1; step <= 1; step++) {
        const uint64_t digits = middle + (uint64_t)(int64_t)step;
        expect_double(digits, 0);
        if (digits <= UINT64_MAX / 10) expect_double(10 * digits, -1);
      }
    }
  }
  expect_double(UINT64_MAX, 27);
  expect_double(UINT64_MAX, -27);
  expect_double(1, -27);
  double value;
  assert_false(decimal_to_double(1, 28, &value));
  assert_false(decimal_to_double(1, -28, &value));
  assert_false(decimal_to_double(0, 0, &value));
}
