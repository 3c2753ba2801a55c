/* Control points: beside quadruple precision, anywhere in space, and the same bits by each instruction set. */
#include <math.h>

#include "base/real.h"
#include "geometry/patch.h"

#include "cmocka_test.h"
#include "random.h"
#include "reference/quad.h"

enum { SEED = 20240507, PATCHES = 2000 };

/* A patch of any size up to about 2^20, anywhere within 2^20. */
static void random_patch(struct random *random, double P[4][4][3])
{
  const double size = exp2(random_between(random, -20, 20));
  double middle[3];
  for (int k = 0; k < 3; k++) middle[k] = random_between(random, -0x1p20, 0x1p20);
  for (int n = 0; n < 48; n++) P[n / 12][n / 3 % 4][n % 3] = middle[n % 3] + size * random_between(random, -1, 1);
}

/* The largest difference in coordinate k of neighbours along a row or across rows. */
static double largest_step(double P[4][4][3], int k)
{
  double most = 0;
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 4; j++)
      most = fmax(most, fmax(fabs(P[i + 1][j][k] - P[i][j][k]), fabs(P[j][i + 1][k] - P[j][i][k])));
  return most;
}

/* Errors in roundings: 5 of a weight, 1 each of a difference and a product, 3 of a sum of four; of three differences,
 * whose weights sum to 3 and are off by 3, 3 more: 17 each, 51 in all. */
static void assert_tangents(double P[4][4][3], double u, double v)
{
  double du[3], dv[3];
  points_tangents((const double(*)[4][3])P, u, v, du, dv);
  for (int k = 0; k < 3; k++) {
    struct quad_net net;
    for (int e = 0; e < 16; e++) net.c[e / 4][e % 4] = P[e / 4][e % 4][k];
    const struct quad_jet jet = quad_net_jet(&net, u, v);
    const double bound = 51 * UNIT_ROUNDOFF * largest_step(P, k);
    assert_true(fabs((double)(du[k] - jet.du)) <= bound && fabs((double)(dv[k] - jet.dv)) <= bound);
  }
}

static void assert_same_bits(double P[4][4][3], double u, double v)
{
  double one[6], other[6];
  const double(*points)[4][3] = (const double(*)[4][3])P;
  points_tangents(points, u, v, one, one + 3);
  points_tangents_baseline(points, u, v, other, other + 3);
  assert_memory_equal(one, other, sizeof one);
}

TEST(test_tangents)
{
  struct random random = {SEED};
  for (int n = 0; n < PATCHES; n++) {
    double P[4][4][3];
    random_patch(&random, P);
    const double u = n % 5 == 0 ? n % 2 : random_between(&random, 0, 1),
                 v = n % 7 == 0 ? n % 3 / 2.0 : random_between(&random, 0, 1);
    assert_tangents(P, u, v);
    assert_same_bits(P, u, v);
  }
}

static void assert_range(points_range_function *range, double P[4][4][3])
{
  double lo[3], hi[3];
  range((const double(*)[4][3])P, lo, hi);
  for (int k = 0; k < 3; k++) {
    bool reached[2] = {false, false};
    for (int n = 0; n < 16; n++) {
      const double x = P[n / 4][n % 4][k];
      assert_true(lo[k] <= x && x <= hi[k]);
      reached[0] |= x == lo[k], reached[1] |= x == hi[k];
    }
    assert_true(reached[0] && reached[1]);
  }
}

TEST(test_range)
{
  struct random random = {SEED + 1};
  for (int n = 0; n < PATCHES; n++) {
    double P[4][4][3];
    random_patch(&random, P);
    assert_range(points_range, P), assert_range(points_range_baseline, P);
  }
}

/* Asserts that a coordinate and its rest are exact: nothing is lost between them. */
static bool assert_frame(points_frame_function *frame, double P[4][4][3], const double center[3], double unit)
{
  double x[3][4][4], rest[3][4][4];
  bool rounded = false;
  const bool told = frame((const double(*)[4][3])P, center, unit, x, rest);
  for (int k = 0; k < 3; k++) {
    for (int n = 0; n < 16; n++) {
      const int i = n / 4, j = n % 4;
      assert_true((quad)x[k][i][j] + rest[k][i][j] == ((quad)P[i][j][k] - center[k]) * unit);
      assert_true(x[k][i][j] == (double)((quad)x[k][i][j] + rest[k][i][j]));
      rounded |= rest[k][i][j] != 0;
    }
  }
  assert_int_equal(told, rounded);
  return told;
}

/* Whole numbers leave no rest. One number that is not whole leaves one, wherever it stands. */
TEST(test_frame)
{
  struct random random = {SEED + 2};
  for (int n = 0; n < PATCHES; n++) {
    double P[4][4][3], center[3];
    random_patch(&random, P);
    for (int k = 0; k < 3; k++) center[k] = random_between(&random, -0x1p20, 0x1p20);
    const double unit = exp2(floor(random_between(&random, -20, 20)));
    (void)assert_frame(points_frame, P, center, unit), (void)assert_frame(points_frame_baseline, P, center, unit);
    for (int k = 0; k < 3; k++) center[k] = rint(center[k]);
    for (int e = 0; e < 48; e++) P[e / 12][e / 3 % 4][e % 3] = rint(P[e / 12][e / 3 % 4][e % 3]);
    assert_false(assert_frame(points_frame, P, center, unit) || assert_frame(points_frame_baseline, P, center, unit));
    const int at = n % 48;
    center[at % 3] = 1, P[at / 12][at / 3 % 4][at % 3] = 0x1p-60;
    assert_true(assert_frame(points_frame, P, center, unit) && assert_frame(points_frame_baseline, P, center, unit));
  }
}
