/* Numbers as text: what is read as a number, how much of the text it takes, its nearest double, and what is written. */
#include "base/number.h"

#include <float.h>
#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cmocka_test.h"
#include "random.h"

enum { SEED = 20261127, MANY = 50000, LONG = 1200 };

static void expect_read(const char *text, enum number_kind kind, double expected, size_t expected_used)
{
  double value = 0;
  size_t used = 0;
  const enum number_kind found = number_read(text, strlen(text), &value, &used);
  if (found != kind || used != expected_used || value != expected)
    print_error("%.60s: %a, %zu bytes\n", text, value, used);
  assert_true(found == kind && used == expected_used);
  assert_true(value == expected && signbit(value) == signbit(expected));
}

TEST(what_is_a_number)
{
  static const char *const none[] = {"", ".", "-", "+.", "-.e5", "e5", ".e5", " 1", "inf", "nan", "+-1", ",5"};
  for (size_t k = 0; k < sizeof none / sizeof none[0]; k++) expect_read(none[k], NUMBER_NONE, 0, 0);
  static const struct {
    const char *text;
    double value;
    size_t used;
  } cases[] = {{"1", 1, 1},
               {"+1.5e3x", 1500, 6},
               {"-.5", -0.5, 3},
               {"5.", 5, 2},
               {"5..", 5, 2},
               {"1e", 1, 1},
               {"1e+", 1, 1},
               {"1ex", 1, 1},
               {"1.e2", 100, 4},
               {"1E-2", 0.01, 4},
               {"0x10", 0, 1},
               {"1,5", 1, 1},
               {"-0", -0.0, 2},
               {"-0.0e9", -0.0, 6},
               {"1e-999", 0, 6},
               {"0e999999999", 0, 11},
               {"1e-99999999999999999999", 0, 23},
               {"0e99999999999999999999", 0, 22},
               {"123456789012345", 123456789012345, 15},
               {"1234567890123456", 1234567890123456, 16},
               {"0000000000000000000000000000001", 1, 31}};
  for (size_t k = 0; k < sizeof cases / sizeof cases[0]; k++)
    expect_read(cases[k].text, NUMBER_FINITE, cases[k].value, cases[k].used);
  expect_read("1e309", NUMBER_OVERFLOW, INFINITY, 5);
  expect_read("-1e99999999999999999999", NUMBER_OVERFLOW, -INFINITY, 23);
  expect_read("1e18446744073709551616", NUMBER_OVERFLOW, INFINITY, 22);         /* 2^64 */
  expect_read("1234567890123456789e4294967296", NUMBER_OVERFLOW, INFINITY, 30); /* 2^32 */
  double value;
  size_t used;
  assert_true(number_read("1e5", 2, &value, &used) == NUMBER_FINITE && value == 1 && used == 1);
  assert_true(number_read("12345", 3, &value, &used) == NUMBER_FINITE && value == 123 && used == 3);
  assert_true(number_read("1.2345", 4, &value, &used) == NUMBER_FINITE && value == 1.23 && used == 4);
  assert_true(number_read("0.00", 3, &value, &used) == NUMBER_FINITE && value == 0 && used == 3);
  assert_true(number_read("1.5e12", 5, &value, &used) == NUMBER_FINITE && value == 15 && used == 5);
}

/* Random digits, with or without a point and an exponent, are read as by strtod. */
TEST(it_is_the_nearest_double)
{
  struct random random = {SEED};
  for (int n = 0; n < MANY; n++) {
    char text[64];
    size_t length = 0, digits = 1 + random_bits(&random) % 30, point = random_bits(&random) % 40;
    for (size_t k = 0; k < digits; k++) {
      if (k == point) text[length++] = '.';
      text[length++] = (char)('0' + random_bits(&random) % (n % 3 ? 10 : 2));
    }
    const int exponent = (int)(random_bits(&random) % 660) - 350;
    snprintf(text + length, sizeof text - length, n % 5 ? "e%d" : "", exponent);
    const double expected = strtod(text, NULL);
    expect_read(text, isfinite(expected) ? NUMBER_FINITE : NUMBER_OVERFLOW, expected, strlen(text));
  }
}

/* Half way between two doubles the even one is taken; a single digit, however far behind, decides otherwise. */
TEST(ties_are_decided_by_all_digits)
{
  char text[LONG];
  for (int more = 0; more < 2; more++) {
    const int length = snprintf(text, sizeof text, "9007199254740993.%0900d", more);
    expect_read(text, NUMBER_FINITE, more ? 0x1p53 + 2 : 0x1p53, (size_t)length);
  }
  /* Half way, in 768 digits, between the largest subnormal and the least normal, which is even. */
  const int length = snprintf(text, sizeof text, "%.767Le", 0x1p-1022L - 0x1p-1075L);
  char *const last = strchr(text, 'e') - 1;
  assert_true(length > 770 && *last != '0');
  expect_read(text, NUMBER_FINITE, DBL_MIN, (size_t)length);
  --*last;
  expect_read(text, NUMBER_FINITE, DBL_MIN - DBL_TRUE_MIN, (size_t)length);
}

/* Integers half way between two doubles, and one less and one more; also times ten, which a division removes again. */
TEST(ties_of_integers)
{
  for (int bits = 54; bits <= 63; bits++) {
    for (uint64_t odd = 0; odd < 4; odd++) {
      const uint64_t unit = UINT64_C(1) << (bits - 53); /* twice the last place of a double of this size */
      const uint64_t middle = (UINT64_C(1) << bits) + odd * unit + unit / 2;
      for (int step = -1; step <= 1; step++) {
        char text[32];
        const int length = snprintf(text, sizeof text, "%" PRIu64 "0e-1", middle + (uint64_t)(int64_t)step);
        expect_read(text, NUMBER_FINITE, strtod(text, NULL), (size_t)length);
        text[length - 4] = '\0';
        expect_read(text, NUMBER_FINITE, strtod(text, NULL), (size_t)length - 4);
      }
    }
  }
}

TEST(zeros_on_either_side_count_for_nothing)
{
  char text[LONG];
  int length = snprintf(text, sizeof text, "0.%0900de900", 1);
  expect_read(text, NUMBER_FINITE, 1, (size_t)length);
  length = snprintf(text, sizeof text, "1%0900de-900", 0);
  expect_read(text, NUMBER_FINITE, 1, (size_t)length);
}

static void expect_written(double value, const char *shortest, const char *all)
{
  char text[NUMBER_TEXT_SIZE];
  assert_int_equal(number_write(value, text), strlen(shortest));
  assert_string_equal(text, shortest);
  assert_int_equal(number_write_17(value, text), strlen(all));
  assert_string_equal(text, all);
}

TEST(what_is_written)
{
  expect_written(0.1, "0.1", "0.10000000000000001");
  expect_written(-1.0 / 3, "-0.3333333333333333", "-0.33333333333333331");
  expect_written(1e16, "10000000000000000", "10000000000000000");
  expect_written(1e17, "1e17", "1e17");
  expect_written(-1.5e17, "-1.5e17", "-1.5e17");
  expect_written(0.00001, "0.00001", "0.000010000000000000001");
  expect_written(0x1p-20, "9.5367431640625e-7", "9.5367431640625e-7");
  expect_written(2e-6, "2e-6", "1.9999999999999999e-6");
  expect_written(1e-7, "1e-7", "9.9999999999999995e-8");
  expect_written(1e-14, "1e-14", "1e-14"); /* its digits are rounded up to the next power */
  expect_written(123.5, "123.5", "123.5");
  expect_written(DBL_TRUE_MIN, "5e-324", "4.9406564584124654e-324");
  expect_written(DBL_MAX, "1.7976931348623157e308", "1.7976931348623157e308");
  expect_written(0, "0", "0");
  expect_written(-0.0, "-0", "-0");
  expect_written(INFINITY, "inf", "inf");
  expect_written(-INFINITY, "-inf", "-inf");
  expect_written(NAN, "nan", "nan");
}

/* The digits of a number without zeros on either side, the point and the exponent. */
static void digits_of(const char *text, char out[64])
{
  size_t length = 0;
  for (const char *c = text; *c != '\0' && *c != 'e'; c++)
    if (*c >= '0' && *c <= '9' && (length > 0 || *c != '0')) out[length++] = *c;
  while (length > 0 && out[length - 1] == '0') length--;
  out[length] = '\0';
}

/* The 17 digits are printf's. And no number of one digit less reads back as the same. */
TEST(what_is_written_reads_back)
{
  struct random random = {SEED + 1};
  for (int n = 0; n < MANY; n++) {
    const int exponent = n % 2 ? (int)(random_bits(&random) % 2090) - 1068 : (int)(random_bits(&random) % 200) - 150;
    const double value = ldexp(random_between(&random, -2, 2), exponent);
    char text[NUMBER_TEXT_SIZE], other[64];
    char ours[64], theirs[64];
    assert_true(number_write_17(value, text) < NUMBER_TEXT_SIZE && strtod(text, NULL) == value);
    snprintf(other, sizeof other, "%.16e", value);
    digits_of(text, ours), digits_of(other, theirs);
    assert_string_equal(ours, theirs);
    assert_true(number_write(value, text) < NUMBER_TEXT_SIZE && strtod(text, NULL) == value);
    digits_of(text, ours);
    const int digits = (int)strlen(ours);
    if (digits < 2) continue;
    snprintf(other, sizeof other, "%.*e", digits - 2, value);
    assert_true(strtod(other, NULL) != value);
  }
}

int main(void)
{
  print_message("seed %d\n", SEED);
  return test_run();
}
