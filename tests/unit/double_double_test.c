/* Double-double arithmetic against quadruple precision. */
#include "base/double_double.h"

#include "cmocka_test.h"
#include "random.h"
#include "reference/quad.h"
#include "worse.h"

enum { CASES = 200000, SEED = 20240501 };

/* Relative error of a result, "a few 2^-104" in the header. */
#define FEW 8
#define DD_UNIT 0x1p-104

static quad value(struct double_double a) { return (quad)a.hi + (quad)a.lo; }

/* A number of either sign between 2^-40 and 2^40, sometimes a power of two. */
static double some(struct random *random)
{
  const int exponent = (int)(random_bits(random) % 81) - 40;
  const double mantissa = random_bits(random) % 8 ? 1 + random_unit(random) : 1;
  return ldexp(random_bits(random) % 2 ? -mantissa : mantissa, exponent);
}

static struct double_double some_pair(struct random *random)
{
  const double hi = some(random);
  return dd_two_sum(hi, hi * 0x1p-53 * random_between(random, -1, 1));
}

static int normal(struct double_double a) { return a.hi + a.lo == a.hi; }

TEST(sums_and_products_of_two_are_exact)
{
  struct random random = {SEED};
  for (int n = 0; n < CASES; n++) {
    const double a = some(&random), b = n % 3 ? some(&random) : -a * (1 + 0x1p-52 * (double)(random_bits(&random) % 4));
    const struct double_double sum = dd_two_sum(a, b), product = dd_two_product(a, b);
    /* The sum fits 113 bits only if the exponents are near each other (they are up to 80 apart), the product always
     * does. */
    if (fabs(a) < 0x1p55 * fabs(b) && fabs(b) < 0x1p55 * fabs(a)) assert_true(value(sum) == (quad)a + (quad)b);
    assert_true(sum.hi == a + b && normal(sum));
    assert_true(value(product) == (quad)a * (quad)b && normal(product));
  }
}

/* If operands cancel, the error is relative to the sum of their sizes, not to the result's: the low parts are added in
 * one double. */
TEST(operations_are_right_to_their_bound)
{
  struct random random = {SEED + 1};
  double worst[3] = {0};
  for (int n = 0; n < CASES; n++) {
    const struct double_double a = some_pair(&random), b = some_pair(&random);
    const double c = some(&random);
    const struct double_double got[3] = {dd_add(a, b), dd_multiply(a, b), dd_scale(a, c)};
    const quad want[3] = {value(a) + value(b), value(a) * value(b), value(a) * (quad)c};
    for (int k = 0; k < 3; k++) {
      const double error = (double)(quad_abs(value(got[k]) - want[k]) / quad_abs(want[k]));
      assert_true(normal(got[k]));
      worst[k] = worse(worst[k], error / DD_UNIT);
    }
  }
  print_message("worst relative error in 2^-104: sum %.3g, product %.3g, scaled %.3g\n", worst[0], worst[1], worst[2]);
  for (int k = 0; k < 3; k++) assert_true(worst[k] <= FEW);
}

/* Two pairs that cancel down to their low parts' last bits: the leading doubles differ by one unit in the last place,
 * and the low parts, each nearly half of it, take that away. */
static void cancelling_pairs(struct random *random, struct double_double *a, struct double_double *b)
{
  const double hi = some(random), next = nextafter(hi, copysign(INFINITY, hi)), half = (next - hi) / 2;
  *a = (struct double_double){next, half * (-1 + 0x1p-20 * random_unit(random))};
  *b = (struct double_double){-hi, half * (-1 + 0x1p-20 * random_unit(random))};
}

/* Sums that cancel have a small relative error too (the accurate sum of two pairs). */
TEST(cancelling_sums_are_right)
{
  struct random random = {SEED + 2};
  double worst = 0;
  for (int n = 0; n < CASES; n++) {
    struct double_double a = some_pair(&random), b = dd_negate(a);
    b.hi *= 1 + 0x1p-52 * (double)(random_bits(&random) % 3);
    b = dd_add(b, (struct double_double){a.lo * random_unit(&random), 0});
    if (n % 2) cancelling_pairs(&random, &a, &b);
    /* A pair may need more bits than quadruple precision has. Its halves, cancelled first, do not. */
    const quad want = ((quad)a.hi + b.hi) + ((quad)a.lo + b.lo);
    const struct double_double got = dd_add(a, b);
    if (want == 0) assert_true(got.hi == 0 && got.lo == 0);
    else worst = worse(worst, (double)(quad_abs(value(got) - want) / quad_abs(want)) / DD_UNIT);
  }
  print_message("worst relative error of a cancelling sum in 2^-104: %.3g\n", worst);
  assert_true(worst <= FEW);
}

TEST(negation_and_normal_form)
{
  const struct double_double a = dd_negate(dd_two_sum(1, 0x1p-60)), b = dd_normal(1, 0x1p-30);
  assert_true(a.hi == -1 && a.lo == -0x1p-60);
  assert_true(b.hi == 1 + 0x1p-30 && b.lo == 0);
}
