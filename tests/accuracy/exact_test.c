/* Proves that the exact judge lists each root once, also on the lines where it halves boxes and next to them. */
#include "accuracy/certificate.h"

#include <math.h>
#include <stdbool.h>

#include "accuracy/trial.h"
#include "cmocka_test.h"

/* 3 (x - 1/4) (x - 1/2) (x - 3/4) in Bernstein form. */
static const double cubic[4] = {-9.0 / 32, 13.0 / 32, -13.0 / 32, 9.0 / 32};

/* The net of (cubic(u), cubic(v), bend u v): a ray along z meets it nine times. */
static void make_net(double bend, double P[4][4][3])
{
  for (int i = 0; i < 4; i++)
    for (int j = 0; j < 4; j++) P[i][j][0] = cubic[i], P[i][j][1] = cubic[j], P[i][j][2] = bend * (i * j);
}

static void expect_nine(const double P[4][4][3], double aside_u, double aside_v)
{
  const double origin[3] = {aside_u, aside_v, -5}, direction[3] = {0, 0, 1};
  struct exact_roots roots;
  exact_patch_roots(P, origin, direction, 0, INFINITY, &roots);
  bool seen[3][3] = {{false}};
  for (size_t k = 0; k < roots.count; k++) {
    const struct exact_root *root = &roots.root[k];
    assert_true(root->proven);
    const int i = (int)lround(4 * root->u) - 1, j = (int)lround(4 * root->v) - 1;
    assert_true(i >= 0 && i < 3 && j >= 0 && j < 3 && !seen[i][j]);
    seen[i][j] = true;
  }
  assert_int_equal(roots.count, 9);
}

TEST(roots_are_listed_once)
{
  for (int bent = 0; bent < 2; bent++) {
    double P[4][4][3];
    make_net(bent / 16.0, P);
    expect_nine(P, 0, 0);
    for (int k = 8; k < 120; k++) {
      const double aside = ldexp(1, -k);
      expect_nine(P, aside, 0);
      expect_nine(P, 0, -aside);
      expect_nine(P, aside, -aside);
    }
  }
}

/* Two roots so near that doubles cannot tell them apart. */
TEST(near_roots_are_two)
{
  double P[4][4][3];
  for (int i = 0; i < 4; i++) /* x = (u - 1/2)^2 less a little, y = v - 1/2 */
    for (int j = 0; j < 4; j++)
      P[i][j][0] = (i % 3 == 0 ? 0.75 : -0.25), P[i][j][1] = (2 * j - 3), P[i][j][2] = (i % 2 ? 0.5 : 0);
  for (int k = 20; k < 200; k += 4) {
    const double origin[3] = {ldexp(1, -k), 0, -5}, direction[3] = {0, 0, 1};
    struct exact_roots roots;
    exact_patch_roots((const double(*)[4][3])P, origin, direction, 0, INFINITY, &roots);
    assert_int_equal(roots.count, 2);
    assert_true(roots.root[0].proven && roots.root[1].proven);
  }
}

/* What a hit says of its point is proven and refuted alike at all sizes of doubles. */
TEST(points_of_all_sizes)
{
  for (int k = -960; k <= 1000; k += 40) {
    double P[1][4][4][3];
    struct trial trial;
    struct certifier certifier;
    struct certificate good, bad;
    struct hit hit;
    make_net(1.0 / 16, P[0]);
    for (int n = 0; n < 48; n++) P[0][n / 12][n / 3 % 4][n % 3] = ldexp(P[0][n / 12][n / 3 % 4][n % 3], k);
    const struct ray ray = {{ldexp(3, k - 8), ldexp(5, k - 8), ldexp(-5, k)}, {0, 0, 1}, 0, INFINITY};
    trial_create(&trial, (const double(*)[4][4][3])P, 1, NULL);
    certifier_create(&certifier, &trial.scene, trial.reference);
    tracer_closest(trial.tracer, 1, &ray, &hit);
    certify(&certifier, &ray, &hit, &good);
    hit.point[0] += 1.5 * hit.point_error;
    certify(&certifier, &ray, &hit, &bad);
    certifier_destroy(&certifier);
    trial_destroy(&trial);
    assert_int_equal(good.finding, FINDING_PROVEN);
    assert_int_equal(bad.finding, FINDING_SURFACE);
  }
}

/* A tube meets itself along a seam. Next to it a hit's place may be on either side, and nowhere else. */
TEST(places_at_a_seam)
{
  static const double x[4] = {1, -3, -3, 1}, y[4] = {0, 3, -3, 0};
  double P[1][4][4][3];
  for (int n = 0; n < 16; n++)
    P[0][n / 4][n % 4][0] = x[n / 4], P[0][n / 4][n % 4][1] = y[n / 4], P[0][n / 4][n % 4][2] = n % 4;
  const struct ray ray = {{5, 0x1p-60, 1.25}, {-1, 0, 0}, 0, INFINITY};
  struct trial trial;
  struct certifier certifier;
  struct certificate certificate;
  struct hit hit;
  trial_create(&trial, (const double(*)[4][4][3])P, 1, NULL);
  certifier_create(&certifier, &trial.scene, trial.reference);
  tracer_closest(trial.tracer, 1, &ray, &hit);
  assert_true(hit.patch == 0 && hit.certainty == CERTAINTY_CERTAIN);
  static const struct {
    double u;
    enum finding finding;
  } cases[] = {{0, FINDING_PROVEN}, {1, FINDING_PROVEN}, {0x1p-30, FINDING_SURFACE}, {0.5, FINDING_SURFACE}};
  for (size_t n = 0; n < sizeof cases / sizeof *cases; n++) {
    hit.u = cases[n].u;
    certify(&certifier, &ray, &hit, &certificate);
    assert_int_equal(certificate.finding, cases[n].finding);
  }
  certifier_destroy(&certifier);
  trial_destroy(&trial);
}

int main(void)
{
  const int failed = test_run();
  exact_cleanup();
  return failed;
}
