/* The reference against closed forms and perturbation. (accuracy-certificate compares it with the exact judge.) */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "cmocka_test.h"
#include "effort.h"
#include "random.h"
#include "reference/facts.h"

static struct reference_answer ask(const double P[][4][4][3], size_t count, const double origin[3],
                                   const double direction[3])
{
  struct reference *reference = reference_create(P, count);
  assert_non_null(reference);
  struct reference_answer answer;
  reference_closest(reference, origin, direction, &answer);
  reference_destroy(reference);
  return answer;
}

static struct facts facts_of(double P[1][4][4][3], const double origin[3], const double direction[3],
                             const struct reference_answer *a)
{
  struct facts facts;
  facts_find((const double(*)[4][3])P[0], origin, direction, a->t, a->u, a->v, &facts);
  return facts;
}

/* A unit square of the plane z = height over [x0, x0 + 3] x [0,3]: u is (x - x0) / 3, v is y / 3. */
static void flat_net(double x0, double height, double P[4][4][3])
{
  for (int i = 0; i < 4; i++) {
    for (int j = 0; j < 4; j++) {
      P[i][j][0] = x0 + i;
      P[i][j][1] = j;
      P[i][j][2] = height;
    }
  }
}

/* z = 3 s^2 over s in [-1,1] with x = 3 s, y = 3 v: a trough along y. */
static void trough_net(double P[4][4][3])
{
  static const double x[4] = {-3, -1, 1, 3}, z[4] = {3, -1, -1, 3};
  for (int i = 0; i < 4; i++) {
    for (int j = 0; j < 4; j++) {
      P[i][j][0] = x[i];
      P[i][j][1] = j;
      P[i][j][2] = z[i];
    }
  }
}

/* Squares of the largest and smallest doubles are no doubles. */
TEST(test_lengths_of_all_sizes)
{
  for (int k = -1070; k < 1020; k++) {
    const double size = ldexp(1, k), a[3] = {0, -3 * size, 4 * size}, none[3] = {0};
    const quad square = (quad)a[1] * a[1] + (quad)a[2] * a[2];
    double P[4][4][3];
    assert_true(quad_sqrt(square) == 5 * size);
    assert_true(facts_length(a) == 5 * size);
    for (int n = 0; n < 16; n++) memcpy(P[n / 4][n % 4], a, sizeof a);
    assert_true(facts_residual((const double(*)[4][3])P, none, a, 0, 0.5, 0.5) == 5 * size);
  }
  assert_true(quad_sqrt(0) == 0 && quad_sqrt(-1) == 0 && quad_sqrt((quad)INFINITY) == (quad)INFINITY);
}

TEST(test_flat)
{
  double P[1][4][4][3];
  flat_net(0, 0.5, P[0]);
  const double origin[3] = {1.25, 0.75, 7.25}, direction[3] = {0, 0.25, -3};
  struct reference_answer a = ask(P, 1, origin, direction);
  assert_int_equal(a.verdict, REFERENCE_HIT);
  assert_true(quad_abs(a.t - 2.25) <= a.t_radius && a.t_radius < 1e-28);
  assert_true(quad_abs(a.u - (quad)1.25 / 3) <= a.radius && a.radius < 1e-28);
  assert_true(quad_abs(a.v - ((quad)0.75 + 0.25 * 2.25) / 3) <= a.radius);
  const struct facts facts = facts_of(P, origin, direction, &a);
  assert_true(facts.has_normal && facts.normal[2] == 1 && facts.normal[0] == 0);
  const double away[3] = {0, 0.25, 3};
  assert_int_equal(ask(P, 1, origin, away).verdict, REFERENCE_MISS);
  const double beside[3] = {3.0001, 0.75, 7.25}, down[3] = {0, 0, -1};
  assert_int_equal(ask(P, 1, beside, down).verdict, REFERENCE_MISS);
  const double behind[2][3] = {{1, 1, 0.25}, {1, 1, 0.5}};
  assert_int_equal(ask(P, 1, behind[0], down).verdict, REFERENCE_MISS);
  assert_int_equal(ask(P, 1, behind[1], down).verdict, REFERENCE_GRAZING); /* it starts on the patch */
}

/* Rays across the trough at height h: two hits at s = -+sqrt(h/3), a double one, or none. */
TEST(test_tangent)
{
  double P[1][4][4][3];
  trough_net(P[0]);
  const double direction[3] = {2, 0, 0};
  int decided = 0;
  for (int k = 0; k <= 120; k++) {
    const double height = ldexp(1, -k);
    const double above[3] = {-10, 1.4, height}, below[3] = {-10, 1.4, -height};
    struct reference_answer hit = ask(P, 1, above, direction), miss = ask(P, 1, below, direction);
    if (hit.verdict == REFERENCE_HIT) {
      const quad t = (10 - 3 * quad_sqrt((quad)height / 3)) / 2;
      assert_true(quad_abs(hit.t - t) <= hit.t_radius + 1e-32);
      decided++;
    } else {
      assert_int_equal(hit.verdict, REFERENCE_GRAZING);
      assert_true(hit.t_first <= 5);
    }
    assert_int_not_equal(miss.verdict, REFERENCE_HIT);
    if (height > 1e-24) assert_true(hit.verdict == REFERENCE_HIT && miss.verdict == REFERENCE_MISS);
  }
  assert_true(decided >= 80);
  const double at[3] = {-10, 1.4, 0};
  assert_int_equal(ask(P, 1, at, direction).verdict, REFERENCE_GRAZING);
}

TEST(test_border)
{
  double P[2][4][4][3];
  flat_net(0, 0, P[0]);
  flat_net(3, 0, P[1]);
  const double down[3] = {0, 0, -1}, slanted[3] = {0.5, 0.25, -1};
  const double edge[3] = {3, 1.3, 2}, corner[3] = {3, 0, 2}, rim[3] = {6, 1.3, 2}, oblique[3] = {2, 0.8, 2};
  struct reference_answer a = ask(P, 2, edge, down);
  assert_true(a.verdict == REFERENCE_HIT && a.shared && a.t == 2);
  a = ask(P, 2, oblique, slanted);
  assert_true(a.verdict == REFERENCE_HIT && a.shared && quad_abs(a.t - 2) <= a.t_radius);
  assert_int_equal(ask(P, 1, edge, down).verdict, REFERENCE_GRAZING);
  assert_int_equal(ask(P, 2, rim, down).verdict, REFERENCE_GRAZING);
  a = ask(P, 2, corner, down);
  assert_true(a.verdict == REFERENCE_HIT && a.shared);
  const double inside[3] = {nextafter(6, 0) - 1e-12, 1.3, 2}, outside[3] = {6 + 1e-12, 1.3, 2};
  assert_int_equal(ask(P, 2, inside, down).verdict, REFERENCE_HIT);
  assert_int_equal(ask(P, 2, outside, down).verdict, REFERENCE_MISS);
}

/* A ray in the plane of a patch, one along a ruling, and patches collapsed to a line and to a point: work is bounded,
 * and nothing is claimed. */
TEST(test_degenerate)
{
  double P[1][4][4][3];
  flat_net(0, 0.5, P[0]);
  const double in_plane[3] = {-2, 1.1, 0.5}, along[3] = {1, 0.125, 0};
  struct reference_answer a = ask(P, 1, in_plane, along);
  assert_true(a.verdict == REFERENCE_GRAZING && a.t_first <= 2);
  trough_net(P[0]);
  const double ruling[3] = {0, -4, 0}, y[3] = {0, 1, 0};
  a = ask(P, 1, ruling, y);
  assert_true(a.verdict == REFERENCE_GRAZING && a.t_first <= 4);
  for (int k = 0; k < 16; k++) P[0][k / 4][k % 4][0] = P[0][k / 4][k % 4][2] = 0;
  assert_int_equal(ask(P, 1, ruling, y).verdict, REFERENCE_GRAZING);
  const double beside[3] = {0.001, -4, 0};
  assert_int_equal(ask(P, 1, beside, y).verdict, REFERENCE_MISS);
  memset(P, 0, sizeof P);
  assert_int_equal(ask(P, 1, ruling, y).verdict, REFERENCE_GRAZING);
}

static void random_net(struct random *random, double wildness, double P[4][4][3])
{
  for (int i = 0; i < 4; i++) {
    for (int j = 0; j < 4; j++) {
      const double regular[3] = {i - 1.5, j - 1.5, 0};
      for (int axis = 0; axis < 3; axis++) P[i][j][axis] = regular[axis] + wildness * random_between(random, -1, 1);
    }
  }
}

static void random_ray(struct random *random, double origin[3], double direction[3])
{
  for (int axis = 0; axis < 3; axis++) {
    origin[axis] = random_between(random, -5, 5);
    direction[axis] = random_between(random, -2, 2) - origin[axis];
  }
}

/* Moving every input coordinate by one rounding moves the hit by no more than the floor, to first order. */
TEST(test_floor)
{
  size_t rays = effort_count(20000, 300), hits = 0;
  double share = 0;
  struct random random = {.state = 77};
  for (size_t n = 0; n < rays; n++) {
    double P[1][4][4][3], origin[3], direction[3];
    random_net(&random, n % 2 ? 0.4 : 2, P[0]);
    random_ray(&random, origin, direction);
    struct reference_answer a = ask(P, 1, origin, direction);
    if (a.verdict != REFERENCE_HIT) continue;
    const struct facts facts = facts_of(P, origin, direction, &a);
    if (facts.incidence < 1e-4) continue;
    double *numbers = &P[0][0][0][0];
    for (int k = 0; k < 48; k++) numbers[k] += numbers[k] * (random_bits(&random) & 1 ? 0x1p-53 : -0x1p-53) * 1.5;
    for (int k = 0; k < 3; k++) origin[k] += origin[k] * (random_bits(&random) & 1 ? 0x1p-53 : -0x1p-53) * 1.5;
    struct reference_answer b = ask(P, 1, origin, direction);
    if (b.verdict != REFERENCE_HIT) continue;
    hits++;
    /* The moves are up to two units: 1.5 units of the number rounded to a neighbour. */
    const double t = (double)quad_abs(a.t - b.t) / (2 * facts.data.t),
                 u = (double)quad_abs(a.u - b.u) / (2 * facts.data.u);
    assert_true(t <= 1.01 && u <= 1.01 && (double)quad_abs(a.v - b.v) <= 2.02 * facts.data.v);
    share = fmax(share, fmax(t, u));
  }
  printf("floor: %zu hits, worst move %.3f of the bound\n", hits, share);
  assert_true(hits > rays / 10 && share > 0.05); /* the bound is not vacuous */
}
