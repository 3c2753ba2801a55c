/* Transforms: sines and cosines against quadruple precision, and every instruction set's arithmetic bit for bit. */
#include "geometry/transform.h"

#include <math.h>

#include "cmocka_test.h"
#include "random.h"
#include "reference/quad.h"
#include "worse.h"

enum { CASES = 20000, SEED = 20240607 };

static struct transform_angles angles; /* known to all tests */

/* Relative error of a sine or a cosine: a few units of double-double. */
#define MOST_ERROR 0x1p-102

static quad value(struct double_double a) { return (quad)a.hi + (quad)a.lo; }

/* The sine of at most 90 degrees, by its series. */
static quad sine(double degrees)
{
  const quad pi = (quad)0x1.921fb54442d18p+1 + (quad)0x1.1a62633145c07p-53 + (quad)-0x1.f1976b7ed8fbcp-109;
  const quad x = (quad)degrees * (pi / 180);
  quad term = x, sum = x;
  for (int n = 2; n < 60; n += 2) sum += term *= -x * x / (quad)(n * (n + 1));
  return sum;
}

/* A whole number of degrees, any number, or a small one. */
static double some_angle(struct random *random)
{
  switch (random_bits(random) % 3) {
  case 0: return floor(random_between(random, -90, 91));
  case 1: return random_between(random, -90, 90);
  default: return ldexp(random_between(random, -1, 1), -(int)(random_bits(random) % 100));
  }
}

TEST(sines_and_cosines_are_right_to_their_bound)
{
  struct random random = {SEED};
  double worst = 0;
  for (int n = 0; n < CASES; n++) {
    const double degrees = some_angle(&random), rest = 90 - fabs(degrees);
    if (degrees == 0) continue;
    struct transform t;
    transform_rotation((double[]){0, 0, degrees}, &angles, &t);
    const double error = (double)quad_abs(value(t.A[0][1]) / sine(degrees) - 1);
    worst = worse(worst, error);
    assert_true(value(t.A[1][0]) == -value(t.A[0][1]) && value(t.A[0][0]) == value(t.A[1][1]));
    const bool rounded = rest + fabs(degrees) != 90 || 90 - rest != fabs(degrees);
    if (rest == 0 || rounded) continue;
    const double other = (double)quad_abs(value(t.A[0][0]) / sine(rest) - 1);
    worst = worse(worst, other);
  }
  print_message("worst error of a sine or cosine: %.2f x 2^-104\n", worst * 0x1p104);
  assert_true(worst > 0 && worst < MOST_ERROR);
}

TEST(quarters_are_exact)
{
  for (int quarters = -8; quarters <= 8; quarters++) {
    struct transform t;
    transform_rotation((double[]){90.0 * quarters, 0, 0}, &angles, &t);
    const int sines[4] = {0, 1, 0, -1}, turned = quarters & 3;
    assert_true(value(t.A[1][2]) == sines[turned] && value(t.A[1][1]) == sines[(turned + 1) & 3]);
  }
}

/* Angles that are kept already, or kept a quarter turn more or less, change nothing. */
TEST(whole_degrees_are_what_they_are_alone)
{
  for (int degrees = -1000; degrees <= 1000; degrees++) {
    struct transform_angles none = {0};
    struct transform kept, alone;
    transform_rotation((double[]){degrees, 0, 0}, &angles, &kept);
    transform_rotation((double[]){degrees, 0, 0}, &none, &alone);
    assert_memory_equal(kept.A, alone.A, sizeof kept.A);
  }
}

/* Rotations, sometimes by quarter turns only, and translations. */
static struct transform some(struct random *random)
{
  struct transform t;
  transform_rotation((double[]){some_angle(random), some_angle(random), 90.0 * (double)(random_bits(random) % 4)},
                     &angles, &t);
  for (int j = 0; j < 3; j++)
    if (random_bits(random) % 3)
      t.A[3][j] = dd_two_sum(random_between(random, -9, 9), random_between(random, -0x1p-55, 0x1p-55));
  t.identity = t.moves = false;
  return t;
}

TEST(all_instruction_sets_round_alike)
{
  struct random random = {SEED + 1};
  const struct transform_kernel *plain = &transform_kernel_baseline;
  for (int n = 0; n < CASES; n++) {
    const struct transform a = some(&random), b = some(&random), both = transform_then(&a, &b);
    struct transform same;
    plain->compose(&a, &b, &same);
    assert_memory_equal(both.A, same.A, sizeof same.A);
    const double turns[3] = {some_angle(&random), some_angle(&random), some_angle(&random)};
    struct transform_angles none = {0};
    struct transform turned;
    plain->rotation(turns, &none, &same), transform_rotation(turns, &angles, &turned);
    assert_memory_equal(turned.A, same.A, sizeof same.A);
    transform_rotation((double[]){turns[1], turns[0], turns[2]}, &angles, &turned);
    transform_rotation(turns, &angles, &turned); /* kept by now */
    assert_memory_equal(turned.A, same.A, sizeof same.A);
    transform_row p, q, r;
    for (int k = 0; k < 12; k++) p[k / 3][k % 3] = random_between(&random, -9, 9);
    plain->apply(&both, p, q), transform_points(&both, p, r);
    assert_memory_equal(q, r, sizeof r);
  }
}

/* A point is the double nearest to the result in quadruple precision, which is practically never a tie. */
TEST(points_are_rounded_once)
{
  struct random random = {SEED + 2};
  for (int n = 0; n < CASES; n++) {
    const struct transform t = some(&random);
    transform_row p;
    for (int k = 0; k < 12; k++) p[k / 3][k % 3] = random_between(&random, -9, 9);
    transform_row out;
    transform_points(&t, p, out);
    for (int k = 0; k < 12; k++) {
      quad sum = value(t.A[3][k % 3]);
      for (int i = 0; i < 3; i++) sum += (quad)p[k / 3][i] * value(t.A[i][k % 3]);
      assert_true(out[k / 3][k % 3] == (double)sum);
    }
  }
}

/* If the sum of two translations is no double, neither is lost: no point is moved by the rounded sum. */
TEST(ways_are_added_exactly)
{
  struct transform one = transform_identity(), two = transform_identity();
  one.identity = two.identity = false;
  one.A[3][0].hi = 1, two.A[3][0].hi = 0x1p-53;
  const struct transform both = transform_then(&one, &two);
  double point[3] = {0x1p-53, 0, 0};
  transform_point(&both, point, point);
  assert_true(point[0] == 1 + 0x1p-52);
}
