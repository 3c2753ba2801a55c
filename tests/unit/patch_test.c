/* The bicubic patch: subdivision and evaluation against quadruple precision; degrees. */
#include "geometry/patch.h"

#include <math.h>
#include <string.h>

#include "cmocka_test.h"
#include "random.h"
#include "reference/quad.h"
#include "worse.h"

enum { SEED = 20240505, CASES = 3000 };

#define UNIT 0x1p-53

/* Roundings that separate a result from the truth, in units of UNIT times the largest |net| L. Values: weights carry
 * 4 relative roundings each, a product and a sum per term; sums of sizes of Bernstein terms are at most L: 2 x 4 + 2
 * x 5, and the same for subnets by blossoming, six steps of a + t (b - a) with b - a up to 2 L: 6 x (2 x 2 + 1).
 * Derivatives are 3 times a value's. */
#define VALUE_ROUNDINGS 18
#define SLOPE_ROUNDINGS (3 * 2 * VALUE_ROUNDINGS)
#define SUBNET_ROUNDINGS 30

static void random_net(struct random *random, double net[4][4])
{
  for (int k = 0; k < 16; k++) net[k / 4][k % 4] = random_between(random, -1, 1);
}

static double largest(double net[4][4])
{
  double size = 0;
  for (int k = 0; k < 16; k++) size = fmax(size, fabs(net[k / 4][k % 4]));
  return size;
}

static void to_quad(double net[4][4], struct quad_net *out)
{
  for (int k = 0; k < 16; k++) out->c[k / 4][k % 4] = net[k / 4][k % 4];
}

TEST(evaluation_is_right_to_its_roundings)
{
  struct random random = {SEED};
  double worst[3] = {0};
  for (int n = 0; n < CASES * 5; n++) {
    double net[4][4];
    random_net(&random, net);
    const double u = n % 11 == 0   ? 0
                     : n % 11 == 1 ? 1
                     : n % 11 == 2 ? 1e-9
                                   : random_unit(&random),
                 v = random_unit(&random);
    struct quad_net exact;
    to_quad(net, &exact);
    const struct patch_jet got = patch_evaluate(net, u, v);
    const struct quad_jet want = quad_net_jet(&exact, u, v);
    const double off[3] = {(double)quad_abs(got.value - want.value), (double)quad_abs(got.du - want.du),
                           (double)quad_abs(got.dv - want.dv)};
    for (int k = 0; k < 3; k++) worst[k] = worse(worst[k], off[k] / (UNIT * largest(net)));
  }
  print_message("evaluation off by %.3g, %.3g, %.3g roundings\n", worst[0], worst[1], worst[2]);
  assert_true(worst[0] <= VALUE_ROUNDINGS && worst[1] <= SLOPE_ROUNDINGS && worst[2] <= SLOPE_ROUNDINGS);
  assert_true(worst[0] > 0.5 && worst[1] > 0.5 && worst[2] > 0.5);
}

TEST(corners_are_exact)
{
  struct random random = {SEED + 1};
  for (int n = 0; n < 100; n++) {
    double net[4][4];
    random_net(&random, net);
    for (int c = 0; c < 4; c++) assert_true(patch_evaluate(net, c / 2, c % 2).value == net[c / 2 * 3][c % 2 * 3]);
  }
}

/* A subnet is the same polynomial: each control value is that of the restriction in quadruple precision. */
TEST(subnets_are_right_to_their_roundings)
{
  struct random random = {SEED + 2};
  double worst = 0;
  for (int n = 0; n < CASES; n++) {
    double net[4][4], cut[4][4];
    random_net(&random, net);
    double range[4];
    for (int k = 0; k < 4; k++) range[k] = random_unit(&random);
    for (int k = 0; k < 4; k += 2) {
      if (range[k] > range[k + 1]) {
        const double swap = range[k];
        range[k] = range[k + 1], range[k + 1] = swap;
      }
      if (n % 5 == 0) range[k] = 0;
      if (n % 7 == 0) range[k + 1] = 1;
      /* The restriction in quadruple precision is given a width, which must be exact. */
      range[k] = rint(range[k] * 0x1p40) * 0x1p-40, range[k + 1] = rint(range[k + 1] * 0x1p40) * 0x1p-40;
    }
    patch_subnet(net, range[0], range[1], range[2], range[3], cut);
    struct quad_net exact, part;
    to_quad(net, &exact);
    quad_net_restrict(&exact, range[0], range[1] - range[0], range[2], range[3] - range[2], &part);
    for (int k = 0; k < 16; k++)
      worst = worse(worst, (double)quad_abs(part.c[k / 4][k % 4] - cut[k / 4][k % 4]) / (UNIT * largest(net)));
    patch_subnet(net, range[0], range[1], range[2], range[3], net); /* out may be net */
    assert_memory_equal(net, cut, sizeof net);
  }
  print_message("subnets off by %.3g roundings\n", worst);
  assert_true(worst <= SUBNET_ROUNDINGS && worst > 0.5);
}

TEST(the_whole_is_copied_and_cuts_agree)
{
  struct random random = {SEED + 3};
  for (int n = 0; n < CASES; n++) {
    double net[4][4], a[4][4], b[4][4];
    random_net(&random, net);
    if (n % 2)
      for (int k = 0; k < 16; k++) net[k / 4][k % 4] = ldexp(net[k / 4][k % 4], (int)(random_bits(&random) % 60) - 30);
    patch_subnet(net, 0, 1, 0, 1, a);
    assert_memory_equal(a, net, sizeof net);
    const double t = random_unit(&random);
    patch_subnet(net, 0, t, 0, 1, a);
    patch_subnet(net, t, 1, 0, 1, b);
    for (int j = 0; j < 4; j++) assert_true(a[0][j] == net[0][j] && a[3][j] == b[0][j] && b[3][j] == net[3][j]);
    patch_subnet(net, 0, 1, 0, t, a);
    patch_subnet(net, 0, 1, t, 1, b);
    for (int i = 0; i < 4; i++) assert_true(a[i][0] == net[i][0] && a[i][3] == b[i][0] && b[i][3] == net[i][3]);
  }
  /* A border that is one point stays that point in every part. */
  double net[4][4], cut[4][4];
  random_net(&random, net);
  for (int j = 0; j < 4; j++) net[0][j] = 0.1;
  patch_subnet(net, 0, 0.7, 0.1, 0.3, cut);
  for (int j = 0; j < 4; j++) assert_true(cut[0][j] == 0.1);
}

/* ---- degrees ---- */

/* The net of bidegree (m,n) raised to (3,3), scaled and moved, and rounded once at the end. */
static void elevated(const double low[4][4], int m, int n, double scale, double offset, double out[4][4])
{
  quad rows[4][4], cubic[4][4];
  for (int i = 0; i <= m; i++) {
    quad c[4];
    for (int j = 0; j <= n; j++) c[j] = low[i][j];
    for (int d = n; d < 3; d++)
      for (int j = d + 1; j >= 0; j--) c[j] = ((j ? j * c[j - 1] : 0) + (j <= d ? (d + 1 - j) * c[j] : 0)) / (d + 1);
    memcpy(rows[i], c, sizeof c);
  }
  for (int j = 0; j < 4; j++) {
    quad c[4];
    for (int i = 0; i <= m; i++) c[i] = rows[i][j];
    for (int d = m; d < 3; d++)
      for (int i = d + 1; i >= 0; i--) c[i] = ((i ? i * c[i - 1] : 0) + (i <= d ? (d + 1 - i) * c[i] : 0)) / (d + 1);
    for (int i = 0; i < 4; i++) cubic[i][j] = c[i];
  }
  for (int k = 0; k < 16; k++) out[k / 4][k % 4] = (double)((quad)offset + (quad)scale * cubic[k / 4][k % 4]);
}

/* All nine bidegrees at several scales and offsets, within the slack for one rounding of the coordinates. */
TEST(true_bidegrees_are_found)
{
  struct random random = {SEED + 7};
  static const struct {
    double scale, offset;
  } places[] = {{1, 0}, {1e-6, 0}, {1e6, 0}, {1, 1e6}, {1e-3, -1e6}, {3e-200, 0}, {3e200, 1e200}};
  for (size_t p = 0; p < sizeof places / sizeof *places; p++) {
    for (int m = 1; m <= 3; m++) {
      for (int n = 1; n <= 3; n++) {
        for (int k = 0; k < 60; k++) {
          double low[3][4][4], x[3][4][4];
          const int which = k % 4; /* 3: all coordinates have this degree; otherwise one has, the others a lower one */
          double size = 0;
          for (int c = 0; c < 3; c++) {
            random_net(&random, low[c]);
            const bool full = which == 3 || which == c;
            elevated((const double(*)[4])low[c], full ? m : 1, full ? n : 1, places[p].scale, places[p].offset, x[c]);
            size = fmax(size, largest(x[c]));
          }
          int got_m, got_n;
          patch_bidegree(x, 8 * UNIT * size, &got_m, &got_n);
          assert_int_equal(got_m, m);
          assert_int_equal(got_n, n);
        }
      }
    }
  }
}

TEST(a_change_beyond_the_slack_is_seen)
{
  struct random random = {SEED + 8};
  for (int k = 0; k < 2000; k++) {
    double low[4][4], x[3][4][4];
    const int m = 1 + k % 2, n = 1 + k / 2 % 2;
    for (int c = 0; c < 3; c++) {
      random_net(&random, low);
      elevated((const double(*)[4])low, m, n, 1, 0, x[c]);
    }
    int got_m, got_n;
    const double slack = 8 * UNIT, push = 0x1p-45;
    x[k % 3][random_bits(&random) % 4][random_bits(&random) % 4] += push;
    patch_bidegree(x, slack, &got_m, &got_n);
    assert_true(got_m == 3 && got_n == 3); /* a control value that is moved makes both its row and its column cubic */
  }
}

TEST(reduced_nets_are_the_nets_that_were_raised)
{
  struct random random = {SEED + 9};
  double worst = 0;
  for (int m = 1; m <= 3; m++) {
    for (int n = 1; n <= 3; n++) {
      for (int k = 0; k < 200; k++) {
        double low[4][4], x[4][4], out[4][4];
        random_net(&random, low);
        elevated((const double(*)[4])low, m, n, 1, 0, x);
        patch_reduce(x, m, n, out);
        for (int i = 0; i <= m; i++)
          for (int j = 0; j <= n; j++) worst = worse(worst, fabs(out[i][j] - low[i][j]) / UNIT);
        for (int c = 0; c < 4; c++) assert_true(out[c / 2 * m][c % 2 * n] == x[c / 2 * 3][c % 2 * 3]);
        patch_reduce(x, m, n, x);
        assert_memory_equal(x, out, sizeof x);
      }
    }
  }
  print_message("reduced nets off by %.3g roundings\n", worst);
  /* One rounding of each cubic coefficient, with weights 1/4 (3 + 3 + 1 + 1) = 2 a direction, and four of the value's
   * own. */
  assert_true(worst <= 16 && worst > 0.5);
}
