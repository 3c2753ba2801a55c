/* Fixed-point arithmetic against quadruple precision. */
#include "base/fixed.h"

#include <math.h>

#include "cmocka_test.h"
#include "random.h"
#include "reference/quad.h"
#include "worse.h"

enum { CASES = 200000, SEED = 20261122 };

/* A number with all its bits, below 2^`exponent` in size. */
static fixed some(struct random *random, int exponent)
{
  const fixed_bits bits = (fixed_bits)random_bits(random) << 64 | random_bits(random);
  const fixed a = (fixed)(bits >> (128 - FIXED_POINT - exponent));
  return random_bits(random) % 2 ? -a : a;
}

static quad value(fixed a) { return (quad)a * (quad)FIXED_UNIT; }

static void products_are_right_to_two_units(void **state)
{
  (void)state;
  struct random random = {SEED};
  double worst = 0;
  for (int n = 0; n < CASES; n++) {
    /* quadruple precision has all the digits of small ones that count */
    const int i = (int)(random_bits(&random) % 60), j = (int)(random_bits(&random) % 60);
    const fixed a = some(&random, -i - 2), b = some(&random, -j - 2);
    const quad off = value(fixed_product(a, b)) - value(a) * value(b);
    worst = worse(worst, fabs((double)(off / (quad)FIXED_UNIT)));
    assert_true(fixed_product(a, b) == fixed_product(b, a) && fixed_product(-a, b) == -fixed_product(a, b));
  }
  assert_true(worst < 2 && worst > 0.5);
  /* Large ones by powers of two and by whole numbers, which are exact. */
  for (int n = 0; n < CASES; n++) {
    const fixed a = some(&random, 8), half = fixed_from(0.5), three = fixed_from(3);
    assert_true(fixed_product(a, half) == a / 2);
    assert_true(fixed_product(a / 2, three) == 3 * (a / 2));
    assert_true(fixed_product(fixed_from(511), fixed_from(-1)) == fixed_from(-511));
  }
}

static void numbers_come_and_go(void **state)
{
  (void)state;
  struct random random = {SEED + 1};
  for (int n = 0; n < CASES; n++) {
    const double x = ldexp(random_between(&random, -1, 1), (int)(random_bits(&random) % 70) - 61);
    assert_true(fixed_double(fixed_from(x)) == x && fixed_from_wide((wide)x) == fixed_from(x));
    const fixed a = some(&random, -5);
    assert_true(fixed_from_wide(fixed_wide(a)) == a);
  }
  assert_true(fixed_from(1e-300) == 0 && fixed_size(fixed_from(-2)) == fixed_from(2));
}

int main(void)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(products_are_right_to_two_units),
    cmocka_unit_test(numbers_come_and_go),
  };
  return cmocka_run_group_tests_name("fixed", tests, NULL, NULL);
}
