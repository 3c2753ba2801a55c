/* Lanes against scalar code, on values of every kind. Compiled once per instruction set (CMakeLists.txt); skipped if
 * the processor lacks it. */
#include "base/lanes.h"

#include <float.h>
#include <math.h>
#include <stdbool.h>
#include <string.h>

#include "base/double_double.h"
#include "base/double_lanes.h"
#include "base/float_lanes.h"
#include "base/lane_points.h"
#include "cmocka_test.h"
#include "lanes_main.h"

/* Volatile, so that the compiler computes nothing. */
static volatile double values[] = {
  0.0,
  -0.0,
  1.0,
  -1.0,
  0.1,
  -0.7,
  1 + DBL_EPSILON,
  3e-8,
  -1e19,
  1e300,
  -1e-300,
  FLT_MAX,
  -2 * (double)FLT_MAX,
  FLT_MIN / 8,
  1 + 0x1p-24,
  1 + 0x3p-24,
  DBL_MAX,
  -DBL_MAX,
  DBL_MIN,
  DBL_MIN / 4,
  -DBL_TRUE_MIN,
  INFINITY,
  -INFINITY,
  NAN,
};
enum { VALUES = sizeof values / sizeof values[0], PAIRS = VALUES * VALUES, TRIPLES = PAIRS * VALUES };

/* Lane l of row n holds combination n + l, so every combination comes to every lane. */
static double first_value(int n) { return values[n % VALUES]; }
static double second_value(int n) { return values[n / VALUES % VALUES]; }
static double third_value(int n) { return values[n / PAIRS % VALUES]; }

static lanes row(double value(int), int n)
{
  lanes x;
  for (int l = 0; l < LANES; l++) x[l] = value(n + l);
  return x;
}

static float_lanes float_row(double value(int), int n)
{
  float_lanes x;
  for (int l = 0; l < FLOAT_LANES; l++) x[l] = (float)value(n + l);
  return x;
}

static bool same_bits(double a, double b) { return memcmp(&a, &b, sizeof a) == 0; }
static bool same_float_bits(float a, float b) { return memcmp(&a, &b, sizeof a) == 0; }

/* Whether both are the same number, signs of zero included, or both NaN. Which NaN does not matter. */
static bool same(double a, double b) { return same_bits(a, b) || (isnan(a) && isnan(b)); }
static bool same_float(float a, float b) { return same_float_bits(a, b) || (isnan(a) && isnan(b)); }

static void lanes_are_placed(void **state)
{
  (void)state;
  enum { STRIDE = 5 };
  double grid[STRIDE * LANES], back[STRIDE * LANES];
  for (int n = 0; n < VALUES; n++) {
    for (int k = 0; k < STRIDE * LANES; k++) grid[k] = first_value(n + k), back[k] = 7;
    const lanes all = lanes_all(first_value(n));
    lanes four[4];
    lanes_load4(grid, STRIDE, &four[0], &four[1], &four[2], &four[3]);
    lanes_store4(four[0], four[1], four[2], four[3], back, STRIDE);
    const float_lanes float_all = float_lanes_all((float)first_value(n));
    lanes packets[PACKETS];
    for (int h = 0; h < PACKETS; h++) packets[h] = row(first_value, n + h * LANES);
    const float_lanes joined = float_lanes_join(packets);
    for (int l = 0; l < LANES; l++) {
      assert_true(same_bits(all[l], first_value(n)));
      for (int k = 0; k < 4; k++) assert_true(same_bits(four[k][l], grid[STRIDE * l + k]));
      for (int k = 0; k < 4; k++) assert_true(same_bits(back[STRIDE * l + k], grid[STRIDE * l + k]));
      assert_true(back[STRIDE * l + 4] == 7);
    }
    for (int l = 0; l < FLOAT_LANES; l++) {
      assert_true(same_float_bits(float_all[l], (float)first_value(n)));
      assert_true(same_float_bits(joined[l], (float)first_value(n + l)));
    }
  }
}

/* Lane l: bit l of the number. */
static void masks_are_bits(void **state)
{
  (void)state;
  const unsigned all = (1u << LANES) - 1;
  for (unsigned bits = 0; bits <= 4 * all; bits++) {
    const lane_mask mask = lanes_mask(bits);
    for (int l = 0; l < LANES; l++) assert_true(mask[l] == (bits >> l & 1 ? -1 : 0));
    assert_int_equal(lanes_bits(mask), bits & all);
    assert_int_equal(lanes_any(mask) != 0, (bits & all) != 0);
  }
  for (unsigned bits = 0; bits < 1u << FLOAT_LANES; bits++) {
    float_mask mask;
    for (int l = 0; l < FLOAT_LANES; l++) mask[l] = bits >> l & 1 ? -1 : 0;
    assert_int_equal(float_lanes_bits(mask), bits);
  }
}

/* What the compiler makes of operators: arithmetic, and comparisons, whose bits are a mask. */
static void operators_are_scalar(void **state)
{
  (void)state;
  for (int n = 0; n < PAIRS; n++) {
    const lanes a = row(first_value, n), b = row(second_value, n), sum = a + b, product = a * b, ratio = a / b,
                minus = -a;
    const unsigned less = lanes_bits(a < b), most = lanes_bits(a <= b), equal = lanes_bits(a == b),
                   no_less = lanes_bits(~(a < b));
    for (int l = 0; l < LANES; l++) {
      const double x = first_value(n + l), y = second_value(n + l);
      assert_true(same(sum[l], x + y) && same(product[l], x * y) && same(ratio[l], x / y) && same_bits(minus[l], -x));
      assert_true((less >> l & 1) == (x < y) && (most >> l & 1) == (x <= y) && (equal >> l & 1) == (x == y));
      assert_true((no_less >> l & 1) == !(x < y));
    }
    const float_lanes c = float_row(first_value, n), d = float_row(second_value, n), difference = c - d,
                      quotient = c / d;
    const unsigned below = float_lanes_bits(c <= d);
    for (int l = 0; l < FLOAT_LANES; l++) {
      const float x = (float)first_value(n + l), y = (float)second_value(n + l);
      assert_true(same_float(difference[l], x - y) && same_float(quotient[l], x / y) && (below >> l & 1) == (x <= y));
    }
  }
}

static void choices_are_scalar(void **state)
{
  (void)state;
  for (int n = 0; n < PAIRS; n++) {
    const lanes a = row(first_value, n), b = row(second_value, n);
    const lanes least = lanes_min(a, b), most = lanes_max(a, b), size = lanes_abs(a), root = lanes_sqrt(a);
    const unsigned chosen = (unsigned)n * 2654435761u >> 16;
    const lanes select = lanes_select(lanes_mask(chosen), a, b), other = lanes_select(a < b, b, a);
    for (int l = 0; l < LANES; l++) {
      const double x = first_value(n + l), y = second_value(n + l);
      assert_true(same_bits(least[l], x < y ? x : y) && same_bits(most[l], x > y ? x : y));
      assert_true(same_bits(size[l], fabs(x)) && same(root[l], sqrt(x)));
      assert_true(same_bits(select[l], chosen >> l & 1 ? x : y) && same_bits(other[l], x < y ? y : x));
    }
  }
}

static void float_choices_are_scalar(void **state)
{
  (void)state;
  for (int n = 0; n < PAIRS; n++) {
    const float_lanes a = float_row(first_value, n), b = float_row(second_value, n);
    const float_lanes least = float_lanes_min(a, b), most = float_lanes_max(a, b), size = float_lanes_abs(a);
    const unsigned chosen = (unsigned)n * 2654435761u >> 16;
    float_mask mask;
    for (int l = 0; l < FLOAT_LANES; l++) mask[l] = chosen >> l & 1 ? -1 : 0;
    const float_lanes select = float_lanes_select(mask, a, b), other = float_lanes_select(a < b, b, a);
    for (int l = 0; l < FLOAT_LANES; l++) {
      const float x = (float)first_value(n + l), y = (float)second_value(n + l);
      assert_true(same_float_bits(least[l], x < y ? x : y) && same_float_bits(most[l], x > y ? x : y));
      assert_true(same_float_bits(size[l], fabsf(x)));
      assert_true(same_float_bits(select[l], chosen >> l & 1 ? x : y) && same_float_bits(other[l], x < y ? y : x));
    }
  }
}

static void products_keep_their_error(void **state)
{
  (void)state;
  for (int n = 0; n < TRIPLES; n++) {
    const lanes a = row(first_value, n), b = row(second_value, n), c = row(third_value, n), product = a * b;
    const lanes error = lanes_product_error(a, b, product), sum = lanes_multiply_add(a, b, c);
    for (int l = 0; l < LANES; l++) {
      const double x = first_value(n + l), y = second_value(n + l), z = third_value(n + l), p = x * y;
      assert_true(same(error[l], fma(x, y, -p)));
      assert_true(same(sum[l], fma(x, y, z)) || same(sum[l], p + z));
    }
  }
}

/* Sums and products of doubles are exact. Results of further operations are off by some roundings of the low part, a
 * few 2^-105. */
#define DOUBLE_LANES_ERROR 0x1p-102

static bool near(double hi, double lo, struct double_double want, double size)
{
  return fabs((hi - want.hi) + (lo - want.lo)) <= DOUBLE_LANES_ERROR * size;
}

static double random_value(uint64_t *state)
{
  *state = *state * 6364136223846793005u + 1442695040888963407u;
  return (double)(int64_t)(*state >> 11) * 0x1p-52 - 1;
}

static void double_lanes_are_double_doubles(void **state)
{
  (void)state;
  uint64_t seed = 20240612;
  for (int n = 0; n < 500; n++) {
    struct double_lanes a, b;
    for (int l = 0; l < LANES; l++) {
      a.hi[l] = random_value(&seed), a.lo[l] = 0x1p-54 * a.hi[l] * random_value(&seed);
      b.hi[l] = random_value(&seed), b.lo[l] = 0x1p-54 * b.hi[l] * random_value(&seed);
    }
    const struct double_lanes sum = double_lanes_sum(a.hi, b.lo), product = double_lanes_product(a.hi, b.hi);
    const struct double_lanes times = double_lanes_multiply(a, b), scaled = double_lanes_scale(a, b.hi);
    const struct double_lanes difference = double_lanes_subtract(a, b);
    for (int l = 0; l < LANES; l++) {
      const struct double_double x = {a.hi[l], a.lo[l]}, y = {b.hi[l], b.lo[l]};
      const struct double_double s = dd_two_sum(x.hi, y.lo), p = dd_two_product(x.hi, y.hi);
      assert_true(same_bits(sum.hi[l], s.hi) && same_bits(sum.lo[l], s.lo));
      assert_true(same_bits(product.hi[l], p.hi) && same_bits(product.lo[l], p.lo));
      const double size = fabs(x.hi * y.hi);
      assert_true(near(times.hi[l], times.lo[l], dd_multiply(x, y), size));
      assert_true(near(scaled.hi[l], scaled.lo[l], dd_scale(x, y.hi), size));
      assert_true(near(difference.hi[l], difference.lo[l], dd_add(x, dd_negate(y)), fabs(x.hi) + fabs(y.hi)));
    }
  }
}

/* To whichever lanes they belong. */
static void points_come_and_go(void **state)
{
  (void)state;
#if LANE_POINTS > 0
  static const double coordinates[4] = {1.5, 2.5, 3.5, 4.5};
  lanes s;
  for (int l = 0; l < LANES; l++) s[l] = 10.0 * (l + 1);
  for (unsigned bits = 1; bits < 1u << LANES; bits++) {
    if (__builtin_popcount(bits) > LANE_POINTS) continue;
    const struct lane_points points = lane_points_of(bits);
    const lanes at = lane_points_spread(&points, s) + lane_points_load(coordinates);
    for (int c = 0; c < 3; c++) {
      const lanes x = lane_points_collect(&points, at, c);
      for (unsigned l = 0; l < LANES; l++)
        if (bits >> l & 1) assert_true(x[l] == s[l] + coordinates[c]);
    }
  }
#endif
}

/* Called only where the processor has the instructions, and not part of main, which must run on all. */
__attribute__((noinline)) static int run(void)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(lanes_are_placed),
    cmocka_unit_test(masks_are_bits),
    cmocka_unit_test(operators_are_scalar),
    cmocka_unit_test(choices_are_scalar),
    cmocka_unit_test(float_choices_are_scalar),
    cmocka_unit_test(products_keep_their_error),
    cmocka_unit_test(double_lanes_are_double_doubles),
    cmocka_unit_test(points_come_and_go),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}

int main(void) { return lanes_main(run); }
