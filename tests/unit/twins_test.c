/* Nets that are the same in one of the eight orders, in tables so small that searches wrap round their end. */
#include "geometry/twins.h"
#include "net_order.h"

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
    bool found[2 * NETS];
    for (int k = 0; k < NETS; k++) {
      random_net(&random, P[k]);
      if (trial % 3 == 0) P[k][1][1][0] = 0;
      in_order(P[k], (int)(random_bits(&random) % 8), P[NETS + k]);
      for (int n = 0; n < 48; n++)
        if (P[NETS + k][n / 12][n / 3 % 4][n % 3] == 0) P[NETS + k][n / 12][n / 3 % 4][n % 3] = -0.0;
    }
    assert_int_equal(twins_find(P, sizeof *P, 2 * NETS, found), STATUS_OK);
    for (int k = 0; k < 2 * NETS; k++) assert_int_equal(found[k], k >= NETS);
  }
}

/* One different number, of a border or an inner point, makes no twin. */
TEST(nearly_is_not_the_same)
{
  struct random random = {SEED + 1};
  for (int n = 0; n < 48; n++) {
    net P[2];
    bool found[2];
    random_net(&random, P[0]);
    memcpy(P[1], P[0], sizeof P[1]);
    P[1][n / 12][n / 3 % 4][n % 3] += 0x1p-50;
    assert_int_equal(twins_find(P, sizeof *P, 2, found), STATUS_OK);
    assert_true(!found[0] && !found[1]);
    assert_false(net_twins(P[0], P[1]));
    assert_true(net_twins(P[0], P[0]) && !net_equal(P[0], P[1]));
  }
}

int main(void)
{
  print_message("seed %d\n", SEED);
  return test_run();
}
