/* Nets of one surface: the same in one of the eight orders, or in one plane; in tables so small that searches wrap round
 * their end. */
#include "geometry/edges.h"
#include "net_order.h"

#include <math.h>
#include <stdbool.h>
#include <string.h>

#include "cmocka_test.h"
#include "random.h"

enum { SEED = 20261126, TRIALS = 2000, NETS = 3 };

typedef double net[4][4][3];

static void random_net(struct random *random, net P)
{
  for (int n = 0; n < 48; n++) P[n / 12][n / 3 % 4][n % 3] = random_between(random, -1, 1);
}

/* Nets, followed by a twin of each. */
TEST(every_twin_is_found)
{
  struct random random = {SEED};
  for (int trial = 0; trial < TRIALS; trial++) {
    net P[2 * NETS];
    uint32_t found[2 * NETS];
    for (int k = 0; k < NETS; k++) {
      random_net(&random, P[k]);
      if (trial % 3 == 0) P[k][1][1][0] = 0;
      in_order(P[k], (int)(random_bits(&random) % 8), P[NETS + k]);
      for (int n = 0; n < 48; n++)
        if (P[NETS + k][n / 12][n / 3 % 4][n % 3] == 0) P[NETS + k][n / 12][n / 3 % 4][n % 3] = -0.0;
    }
    assert_int_equal(surfaces_find(P, sizeof *P, 2 * NETS, found), STATUS_OK);
    for (uint32_t k = 0; k < NETS; k++) {
      assert_int_equal(found[k], k + 1);
      assert_int_equal(found[NETS + k], (k + 1) | SURFACE_AGAIN);
    }
  }
}

/* One different number, of a border or an inner point, makes no twin. */
TEST(nearly_is_not_the_same)
{
  struct random random = {SEED + 1};
  for (int n = 0; n < 48; n++) {
    net P[2];
    uint32_t found[2];
    random_net(&random, P[0]);
    memcpy(P[1], P[0], sizeof P[1]);
    P[1][n / 12][n / 3 % 4][n % 3] += 0x1p-50;
    assert_int_equal(surfaces_find(P, sizeof *P, 2, found), STATUS_OK);
    assert_true(found[0] == 0 && found[1] == 0);
  }
}

static void flat_net(struct random *random, int axis, double value, net P)
{
  random_net(random, P);
  for (int n = 0; n < 16; n++) P[n / 4][n % 4][axis] = value == 0 && n % 2 ? -0.0 : value;
}

TEST(planes_are_found)
{
  struct random random = {SEED + 2};
  net P[7];
  uint32_t found[7];
  flat_net(&random, 0, 0.5, P[0]);
  flat_net(&random, 1, 0.5, P[1]);
  flat_net(&random, 1, nextafter(0.5, 1), P[2]);
  flat_net(&random, 2, 0, P[3]);
  flat_net(&random, 1, 0.5, P[4]);
  flat_net(&random, 2, 0, P[5]);
  in_order(P[4], 3, P[6]);
  assert_int_equal(surfaces_find(P, sizeof *P, 7, found), STATUS_OK);
  static const int axis[7] = {0, 1, 1, 2, 1, 2, 1};
  for (int p = 0; p < 7; p++) {
    assert_int_equal(SURFACE_AXIS(found[p]), axis[p]);
    assert_int_equal((found[p] & SURFACE_AGAIN) != 0, p == 6);
    for (int q = 0; q < p; q++) {
      const bool one = axis[p] == axis[q] && P[p][0][0][axis[p]] == P[q][0][0][axis[p]];
      assert_int_equal(((found[p] ^ found[q]) & ~SURFACE_AGAIN) == 0, one);
    }
  }
  P[4][3][3][1] = nextafter(0.5, 1);
  assert_int_equal(surfaces_find(P, sizeof *P, 6, found), STATUS_OK);
  assert_true(SURFACE_AXIS(found[1]) == 1 && found[4] == 0);
}
