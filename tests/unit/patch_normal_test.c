/* Normals, where Su x Sv has a direction and where only its limit has. */
#include <math.h>
#include <string.h>

#include "geometry/patch.h"
#include "geometry/vector.h"

#include "cmocka_test.h"
#include "random.h"
#include "reference/quad.h"

enum { SEED = 20240506 };

static void random_surface(struct random *random, double x[3][4][4])
{
  for (int k = 0; k < 48; k++) x[k / 16][k / 4 % 4][k % 4] = random_between(random, -1, 1);
}

/* Su x Sv in quadruple precision, scaled to length 1. Returns whether it has a length. */
static bool exact_normal(double x[3][4][4], quad u, quad v, double out[3])
{
  quad du[3], dv[3], n[3];
  for (int k = 0; k < 3; k++) {
    struct quad_net net;
    for (int e = 0; e < 16; e++) net.c[e / 4][e % 4] = x[k][e / 4][e % 4];
    const struct quad_jet jet = quad_net_jet(&net, u, v);
    du[k] = jet.du, dv[k] = jet.dv;
  }
  for (int k = 0; k < 3; k++) n[k] = du[(k + 1) % 3] * dv[(k + 2) % 3] - du[(k + 2) % 3] * dv[(k + 1) % 3];
  const quad length = quad_sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
  for (int k = 0; k < 3; k++) out[k] = length > 0 ? (double)(n[k] / length) : 0;
  return length > 0;
}

/* Su x Sv at a point inside, `away` from (u,v) towards the middle along u, v or both (bits 0 and 1 of `along`). */
static void limit_normal(double x[3][4][4], double u, double v, double away, int along, double out[3])
{
  const quad du = u > 0.5 ? -away : away, dv = v > 0.5 ? -away : away;
  assert_true(exact_normal(x, u + (along & 1 ? du : 0), v + (along & 2 ? dv : 0), out));
}

static double distance(const double a[3], const double b[3])
{
  double d[3];
  vector_subtract(a, b, d);
  return vector_length(d);
}

/* Asserts that the normal is that limit. */
static void assert_limit(double x[3][4][4], double u, double v, double away, int along)
{
  double got[3], want[3];
  assert_true(patch_normal(x, u, v, 0, got));
  limit_normal(x, u, v, away, along, want);
  assert_true(distance(got, want) < 1e-6);
}

static void collapse_row(double x[3][4][4], int i)
{
  for (int k = 0; k < 3; k++)
    for (int j = 1; j < 4; j++) x[k][i][j] = x[k][i][0];
}

static void collapse_column(double x[3][4][4], int j)
{
  for (int k = 0; k < 3; k++)
    for (int i = 1; i < 4; i++) x[k][i][j] = x[k][0][j];
}

TEST(regular_points)
{
  struct random random = {SEED};
  for (int n = 0; n < 3000; n++) {
    double x[3][4][4], got[3], want[3];
    random_surface(&random, x);
    const double u = random_unit(&random), v = random_unit(&random);
    assert_true(patch_normal(x, u, v, 0, got));
    assert_true(exact_normal(x, u, v, want));
    assert_true(fabs(vector_length(got) - 1) < 4 * 0x1p-53);
    assert_true(distance(got, want) < 1e-10);
  }
}

/* A whole border is one point. The normal is the limit on the way to it, a different one at each parameter of the
 * border. */
TEST(collapsed_edges)
{
  struct random random = {SEED + 1};
  for (int n = 0; n < 400; n++) {
    double x[3][4][4];
    random_surface(&random, x);
    const int border = n % 4;
    if (border < 2) collapse_row(x, border * 3);
    else collapse_column(x, (border - 2) * 3);
    const double t = random_between(&random, 0.05, 0.95), u = border < 2 ? border : t, v = border < 2 ? t : border - 2;
    assert_limit(x, u, v, 0x1p-30, border < 2 ? 1 : 2);
  }
}

/* Next to such a border Su x Sv is nearly lost. The normal continues there without jump or noise. */
TEST(near_collapsed_edges)
{
  struct random random = {SEED + 2};
  for (int n = 0; n < 200; n++) {
    double x[3][4][4], got[3], want[3];
    random_surface(&random, x);
    collapse_row(x, 0);
    const double v = random_between(&random, 0.1, 0.9);
    for (int k = 1; k <= 60; k++) {
      const double u = ldexp(1, -k);
      assert_true(patch_normal(x, u, v, 0, got));
      assert_true(exact_normal(x, u, v, want));
      assert_true(distance(got, want) < 1e-6);
    }
  }
}

/* Two control points coincide at a corner: Su or Sv vanishes there alone; or both do, if the corner coincides with its
 * three neighbours (two of them on the borders). */
TEST(collapsed_corners)
{
  struct random random = {SEED + 3};
  for (int n = 0; n < 600; n++) {
    double x[3][4][4];
    random_surface(&random, x);
    const int corner = n % 4, i = corner / 2 * 3, j = corner % 2 * 3, kind = n / 4 % 3;
    for (int k = 0; k < 3; k++) {
      if (kind != 0) x[k][i == 0 ? 1 : 2][j] = x[k][i][j];
      if (kind != 1) x[k][i][j == 0 ? 1 : 2] = x[k][i][j];
    }
    assert_limit(x, corner / 2, corner % 2, 0x1p-40, 3);
  }
}

/* Two borders that are points meet at a corner. */
TEST(two_collapsed_edges_in_a_corner)
{
  struct random random = {SEED + 5};
  for (int n = 0; n < 400; n++) {
    double x[3][4][4], got[3], want[3];
    random_surface(&random, x);
    const int corner = n % 4, i = corner / 2 * 3, j = corner % 2 * 3;
    collapse_row(x, i);
    for (int k = 0; k < 3; k++)
      for (int r = 0; r < 4; r++) x[k][r][j] = x[k][i][j];
    /* S - corner is of order st: Su x Sv of order s t (..), the limit along the diagonal. */
    limit_normal(x, corner / 2, corner % 2, 0x1p-40, 3, want);
    if (patch_normal(x, corner / 2, corner % 2, 0, got)) assert_true(distance(got, want) < 1e-6);
    else assert_true(got[0] == 0 && got[1] == 0 && got[2] == 0);
  }
}

TEST(no_normal_where_there_is_no_surface)
{
  struct random random = {SEED + 6};
  for (int n = 0; n < 300; n++) {
    double x[3][4][4], got[3] = {1, 1, 1};
    random_surface(&random, x);
    if (n % 3 == 0) { /* a point */
      for (int k = 0; k < 48; k++) x[k / 16][k / 4 % 4][k % 4] = 0.3 * (k / 16);
    } else if (n % 3 == 1) { /* a curve: no row differs from another */
      for (int k = 0; k < 3; k++)
        for (int i = 1; i < 4; i++) memcpy(x[k][i], x[k][0], sizeof x[k][0]);
    } else { /* a line, traversed unevenly in both parameters */
      for (int k = 0; k < 16; k++)
        x[1][k / 4][k % 4] = 0.5 * x[0][k / 4][k % 4], x[2][k / 4][k % 4] = 0.25 * x[0][k / 4][k % 4];
    }
    assert_false(patch_normal(x, n % 5 / 4.0, random_unit(&random), 0, got));
    assert_true(got[0] == 0 && got[1] == 0 && got[2] == 0);
  }
}

/* Scaling and moving change nothing: the noise threshold is relative to the extent. */
TEST(size_does_not_matter)
{
  struct random random = {SEED + 7};
  for (int n = 0; n < 200; n++) {
    double x[3][4][4], y[3][4][4], a[3], b[3];
    random_surface(&random, x);
    if (n % 2) collapse_row(x, 0);
    const int exponent = n % 3 == 0 ? -200 : n % 3 == 1 ? 200 : 20;
    for (int k = 0; k < 48; k++) y[k / 16][k / 4 % 4][k % 4] = ldexp(x[k / 16][k / 4 % 4][k % 4], exponent);
    const double u = n % 4 ? 0 : 0.3, v = random_unit(&random);
    assert_true(patch_normal(x, u, v, 0, a) && patch_normal(y, u, v, 0, b));
    assert_memory_equal(a, b, sizeof a);
  }
}
