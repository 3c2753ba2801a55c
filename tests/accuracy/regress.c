/* Rays that were once answered wrongly, and many like them. Single ones are in cases/. */
#include <math.h>
#include <string.h>

#include "accuracy/generate.h"
#include "accuracy/trial.h"
#include "cmocka_test.h"

typedef double net[4][4][3];

/* The residuals of the last step are sums in twice the precision, of terms of a few units. */
#define TWICE_PRECISION (64 * DOUBLE_UNIT * DOUBLE_UNIT)

static struct hit closest(const struct trial *trial, const double origin[3], const double direction[3])
{
  struct ray ray;
  struct hit hit;
  ray_along(origin, direction, &ray);
  tracer_closest(trial->tracer, 1, &ray, &hit);
  return hit;
}

/* z = (2u-1)^2 + (2v-1)^2, times 3 so that the control points are whole. */
static void bowl(net P)
{
  static const double square[4] = {3, -1, -1, 3};
  for (int i = 0; i < 4; i++) {
    for (int j = 0; j < 4; j++) {
      const double p[3] = {2 * i - 3, 2 * j - 3, square[i] + square[j]};
      memcpy(P[i][j], p, sizeof p);
    }
  }
}

/* A flat square across z, with sides of 3 `scale`, at height z. The origin is this many thirds of it from the
 * corner. */
static void flat(double scale, double from_x, double from_y, double z, net P)
{
  for (int i = 0; i < 4; i++)
    for (int j = 0; j < 4; j++) P[i][j][0] = scale * (i - from_x), P[i][j][1] = scale * (j - from_y), P[i][j][2] = z;
}

/* A ray that starts next to a flat surface. Whether it meets it depends on less than the error of the leaf's
 * polynomials. */
TEST(test_start)
{
  net P;
  flat(1, 1.5, 1.5, 0, P);
  struct trial trial;
  trial_create(&trial, (const double(*)[4][4][3]) & P, 1, NULL);
  const double direction[3] = {1, 0.25, 0x1p-7};
  for (int k = 40; k < 70; k++) {
    const double below[3] = {0.25, 0.125, -ldexp(1, -k)}, above[3] = {0.25, 0.125, ldexp(1, -k)};
    const struct hit hit = closest(&trial, below, direction), miss = closest(&trial, above, direction);
    assert_int_equal(hit.patch, 0);
    assert_int_equal(hit.certainty, CERTAINTY_CERTAIN);
    assert_true(fabs(hit.t - ldexp(1, 7 - k)) <= 4 * DOUBLE_UNIT * ldexp(1, 7 - k) + TWICE_PRECISION);
    assert_int_equal(miss.patch, HIT_NONE);
    assert_int_equal(miss.certainty, CERTAINTY_CERTAIN);
  }
  const double on[3] = {0.25, 0.125, 0};
  const struct hit start = closest(&trial, on, direction);
  assert_int_equal(start.patch, HIT_NONE);
  assert_int_equal(start.certainty, CERTAINTY_CERTAIN);
  trial_destroy(&trial);
}

/* Exactly tangent: a hit, there. Off by 2^-k, far less than doubles resolve: proven to hit twice or to miss. */
TEST(test_tangent)
{
  net P;
  bowl(P);
  struct trial trial;
  struct ray ray;
  struct hit_list list;
  trial_create(&trial, (const double(*)[4][4][3]) & P, 1, NULL);
  for (int n = 0; n < 32; n++) {
    const double direction[3] = {cos(n), sin(n), 0};
    double origin[3] = {-8 * direction[0], -8 * direction[1], 0};
    const struct hit at = closest(&trial, origin, direction);
    assert_int_equal(at.patch, 0);
    assert_true(fabs(at.t - 8) < 1e-6);
    for (int k = 30; k < 80; k += 7) {
      origin[2] = -ldexp(1, -k);
      const struct hit miss = closest(&trial, origin, direction);
      assert_int_equal(miss.patch, HIT_NONE);
      assert_int_equal(miss.certainty, CERTAINTY_CERTAIN);
      origin[2] = ldexp(1, -k);
      const struct hit hit = closest(&trial, origin, direction);
      assert_int_equal(hit.patch, 0);
      assert_int_equal(hit.certainty, CERTAINTY_CERTAIN);
      ray_along(origin, direction, &ray);
      assert_int_equal(tracer_all(trial.tracer, 1, &ray, &list), STATUS_OK);
      assert_true(list.certainty == CERTAINTY_CERTAIN && list.count == 2);
      /* 3 (s/3)^2 = 2^-k at s from the middle, for x = 3 (2u - 1) */
      assert_true(fabs(hit.t - (8 - sqrt(3 * origin[2]))) < 1e-13);
    }
  }
  trial_destroy(&trial);
}

/* Two octants of a ball whose pole is the origin. */
static void ball_top(net P[2])
{
  static const double k = 0.55228474983079356;
  const double profile[4][2] = {{0, 0}, {k, 0}, {1, k - 1}, {1, -1}}, turn[4][2] = {{1, 0}, {1, k}, {k, 1}, {0, 1}};
  for (int i = 0; i < 4; i++) {
    for (int j = 0; j < 4; j++) {
      const double x = -profile[i][0] * turn[j][0], z = profile[i][0] * turn[j][1];
      const double octants[2][3] = {{x, profile[i][1], z}, {x, profile[i][1], -z}};
      memcpy(P[0][i][j], octants[0], sizeof octants[0]), memcpy(P[1][i][j], octants[1], sizeof octants[1]);
    }
  }
}

/* Rays that pass a pole of a ball, at 2^-112 of it, and nearly along the tangent plane there, meet the ball once more
 * before it: by 1e-10 of the ball, or by 1e-16. That is hit first, although a wall stands between the two; a wall before
 * both is hit first. */
TEST(test_beside_met_pole)
{
  static const struct {
    double slope, aside, back, wall;
    uint32_t patch;
  } cases[] = {{0x1p-33, 0x1p-80, 0x1p-30, -0x1.9p-43, 1},
               {0x1p-53, 0x1p-112, 0x1p-30, -0x1.9p-63, 1},
               {0x1p-33, 0x1p-80, 1, -0x1p-20, 2}};
  for (size_t n = 0; n < sizeof cases / sizeof cases[0]; n++) {
    net P[3];
    ball_top(P);
    flat(0x1p-18, 1.25, 1.75, cases[n].wall, P[2]);
    struct trial trial;
    trial_create(&trial, (const double(*)[4][4][3])P, 3, NULL);
    const double direction[3] = {0x1.753eap+0, cases[n].slope, 0x1.934f82p-1}, back = cases[n].back;
    const double origin[3] = {-back * direction[0], cases[n].aside - back * direction[1], -back * direction[2]};
    const struct hit hit = closest(&trial, origin, direction);
    assert_int_equal(hit.patch, cases[n].patch);
    assert_int_equal(hit.certainty, CERTAINTY_CERTAIN);
    trial_destroy(&trial);
  }
}

/* A ray that starts next to the pole, nearer than 113 bits tell, and meets the ball at 4e-15 of its size: that hit is
 * not lost. */
TEST(test_from_met_pole)
{
  static const double origin[3] = {-0x1p-81, 0x1p-84, -0x1p-82}, direction[3] = {-1, -0x1p-36, -0.5};
  net P[2];
  struct trial trial;
  ball_top(P);
  trial_create(&trial, (const double(*)[4][4][3])P, 2, NULL);
  const struct hit hit = closest(&trial, origin, direction);
  assert_int_equal(hit.patch, 1);
  assert_true(hit.t > 3.5e-15 && hit.t < 3.6e-15);
  trial_destroy(&trial);
}

/* The ray meets the surface between its start and its end, and no double lies there: t is the end. Otherwise, whoever
 * asks for the next hit would get the same one again. */
TEST(test_between_doubles)
{
  net P;
  flat(1, 1.25, 1.75, 0, P);
  struct trial trial;
  trial_create(&trial, (const double(*)[4][4][3]) & P, 1, NULL);
  const struct ray ray = {{0, 0, -4}, {0, 0, 1 - DOUBLE_UNIT}, 4, nextafter(4, INFINITY)};
  struct hit hit;
  tracer_closest(trial.tracer, 1, &ray, &hit);
  assert_int_equal(hit.patch, 0);
  assert_true(hit.t == ray.t_max);
  trial_destroy(&trial);
}
