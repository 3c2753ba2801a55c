/* The sRGB transfer function. */
#include "base/srgb.h"

#include <math.h>

#include "cmocka_test.h"

TEST(known_values)
{
  /* IEC 61966-2-1: the ends, the linear part, and middle grey within the standard's own precision. */
  assert_true(srgb_encode(0) == 0 && fabs(srgb_encode(1) - 1) < 1e-15);
  assert_true(fabs(srgb_encode(0.001) - 0.01292) < 1e-15);
  assert_true(fabs(srgb_encode(0.5) - 0.735356983052) < 1e-11);
  assert_true(fabs(srgb_decode(0.5) - 0.214041140482) < 1e-11);
  assert_true(fabs(srgb_decode(srgb_encode(7.5)) - 7.5) < 1e-14);
}

TEST(outside_is_clipped)
{
  struct srgb_table table;
  srgb_table_fill(&table);
  const float low[] = {-1.0f, -INFINITY, NAN, -0.0f}, high[] = {1.5f, INFINITY};
  for (size_t k = 0; k < sizeof low / sizeof low[0]; k++) {
    assert_int_equal(srgb_encode8(&table, low[k]), 0);
    assert_int_equal(srgb_encode16(low[k]), 0);
    assert_int_equal(srgb_code8(low[k]), 0);
    assert_int_equal(srgb_code16(low[k]), 0);
  }
  for (size_t k = 0; k < sizeof high / sizeof high[0]; k++) {
    assert_int_equal(srgb_encode8(&table, high[k]), 255);
    assert_int_equal(srgb_encode16(high[k]), 65535);
    assert_int_equal(srgb_code8(high[k]), 255);
    assert_int_equal(srgb_code16(high[k]), 65535);
  }
}

TEST(every_code_survives)
{
  struct srgb_table table;
  srgb_table_fill(&table);
  for (int k = 0; k <= 255; k++) {
    assert_int_equal(srgb_encode8(&table, (float)srgb_decode(k / 255.0)), k);
    assert_int_equal(srgb_code8((float)(k / 255.0)), k);
  }
  for (int k = 0; k <= 65535; k++) {
    assert_int_equal(srgb_encode16((float)srgb_decode(k / 65535.0)), k);
    assert_int_equal(srgb_code16((float)(k / 65535.0)), k);
  }
}

/* The table returns the formula's rounded value, except that a code half way between two is rounded up although the float
 * that holds its light may be a little less. */
TEST(table_is_the_formula)
{
  struct srgb_table table;
  srgb_table_fill(&table);
  for (int k = 0; k < 255; k++) {
    const float bound = table.bound[k];
    const float samples[] = {nextafterf(bound, 0.0f), bound, nextafterf(bound, 1.0f), bound * 1.003f};
    const int expected[] = {k, k + 1, k + 1, (int)floor(srgb_encode((double)samples[3]) * 255 + 0.5)};
    assert_true(fabs(srgb_encode((double)bound) * 255 - (k + 0.5)) < 1e-4);
    for (int s = 0; s < 4; s++) assert_int_equal(srgb_encode8(&table, samples[s]), expected[s]);
  }
}
