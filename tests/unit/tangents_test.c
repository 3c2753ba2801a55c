/* dS/du and dS/dv: beside quadruple precision, anywhere in space, and the same bits by each instruction set. */
#include <math.h>

#include "base/real.h"
#include "geometry/tangents.h"

#include "cmocka_test.h"
#include "random.h"
#include "reference/quad.h"

enum { SEED = 20240507, PATCHES = 2000 };

/* A patch of any size up to some 2^20, anywhere within 2^20. */
static void random_patch(struct random *random, double P[4][4][3])
{
  const double size = exp2(random_between(random, -20, 20));
  double middle[3];
  for (int k = 0; k < 3; k++) middle[k] = random_between(random, -0x1p20, 0x1p20);
  for (int n = 0; n < 48; n++) P[n / 12][n / 3 % 4][n % 3] = middle[n % 3] + size * random_between(random, -1, 1);
}

/* The largest difference of neighbours in coordinate k, of the three along a row or across. */
static double largest_step(double P[4][4][3], int k)
{
  double most = 0;
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 4; j++)
      most = fmax(most, fmax(fabs(P[i + 1][j][k] - P[i][j][k]), fabs(P[j][i + 1][k] - P[j][i][k])));
  return most;
}

/* Weights are off by 5 roundings, differences and products by one each, sums of four by 3; of three differences, whose
 * weights are 3 in sum and off by 3, by 3 more: 17 each, 51 in all. */
static void assert_tangents(double P[4][4][3], double u, double v)
{
  double du[3], dv[3];
  patch_tangents((const double(*)[4][3])P, u, v, du, dv);
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
  patch_tangents(points, u, v, one, one + 3);
  patch_tangents_baseline(points, u, v, other, other + 3);
  assert_memory_equal(one, other, sizeof one);
}

static void test_tangents(void **state)
{
  (void)state;
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

int main(void)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(test_tangents)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
