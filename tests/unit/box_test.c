/* Boxes of the last resort: a proven root is within its radii, however the coefficients are off within their bounds. */
#include "intersect/exact/box.h"

#include <math.h>

#include "base/real.h"
#include "cmocka_test.h"
#include "quad_root.h"
#include "random.h"

enum { SEED = 20261122, CASES = 200000 };

/* The exact polynomials, and the box's, which are off by up to error[k]. */
struct subject {
  struct quad_net truth[2];
  double error[2];
  struct box box;
};

/* Has a second derivative by v and little else near v = c. There a surface seen edge-on along v is nearly parallel to
 * the ray. */
static double curved(int i, int j, double c, double bend)
{
  const double square[4] = {c * c, c * c - 2 * c / 3, c * c - 4 * c / 3 + 1.0 / 3, (1 - c) * (1 - c)};
  return i / 3.0 + bend * square[j];
}

/* Makes b a small part of what it could be, where the box is seen edge-on. */
static void make(struct random *random, struct subject *s)
{
  const double bend = random_between(random, -1, 1), c = random_between(random, 0.1, 0.9);
  const double tilt = pow(10, -random_between(random, 0, 12)), wild = pow(10, -random_between(random, 0, 12));
  const int signs = (int)(random_bits(random) % 3); /* errors upwards, downwards, of random signs */
  s->box = (struct box){.size_u = 1, .size_v = 1};
  for (int k = 0; k < 2; k++) {
    s->error[k] = pow(2, random_between(random, -52, -40));
    for (int n = 0; n < 16; n++) {
      const int i = n / 4, j = n % 4;
      const double off = signs == 0 ? 1 : signs == 1 ? -1 : random_between(random, -1, 1);
      double x = k ? tilt * (j / 3.0 - c) : curved(i, j, c, bend) - 0.5;
      x += (k ? tilt : 1) * wild * random_between(random, -1, 1);
      s->truth[k].c[i][j] = x;
      s->box.net[k][i][j] = x + 0.99 * off * s->error[k];
    }
  }
}

static void a_proven_root_is_within_its_radii(void **state)
{
  (void)state;
  struct random random = {SEED};
  int proven = 0, edge_on = 0, wrong = 0;
  for (int n = 0; n < CASES; n++) {
    struct subject s;
    double root[2] = {0.5, 0.5}, radius[2];
    make(&random, &s);
    if (!box_solve(&s.box, s.error, false, root, radius)) continue;
    quad truth[2] = {root[0], root[1]};
    const bool found = quad_root(s.truth, &truth[0], &truth[1]);
    proven++, edge_on += radius[1] > 1e-6;
    for (int k = 0; k < 2; k++) {
      const double off = (double)quad_abs(truth[k] - root[k]);
      if (found && off <= radius[k] + 4 * UNIT_ROUNDOFF) continue;
      if (wrong++ < 4)
        print_message("case %d, parameter %d: off by %g, radius %g beside %g\n", n, k, off, radius[k], radius[!k]);
    }
  }
  print_message("%d proven, %d of them edge-on\n", proven, edge_on);
  assert_true(proven > CASES / 8 && edge_on > CASES / 100);
  assert_int_equal(wrong, 0);
}

/* Polynomials u - c and v - c, with c as far beside the box as a root may be proven. Their errors have the signs that
 * move the values there farthest. */
static void a_root_beside_its_box_is_within_its_radii(void **state)
{
  (void)state;
  int proven = 0;
  for (int n = 0; n < 400; n++) {
    const bool high = n & 1;
    const double e = pow(2, -10 - n / 10), c = high ? 1.0604 : -0.0604, error[2] = {e, e};
    struct subject s = {.box = {.size_u = 1, .size_v = 1}};
    double root[2] = {0.5, 0.5}, radius[2];
    for (int m = 0; m < 32; m++) {
      const int k = m / 16, i = m / 4 % 4, j = m % 4;
      s.box.net[k][i][j] = (k ? j : i) / 3.0 - c;
      s.truth[k].c[i][j] = s.box.net[k][i][j] + (quad)((i + j + n / 2) & 1 ? -0.999 : 0.999) * e;
    }
    if (!box_solve(&s.box, error, true, root, radius)) continue;
    quad truth[2] = {root[0], root[1]};
    proven++;
    assert_true(quad_root(s.truth, &truth[0], &truth[1]));
    for (int k = 0; k < 2; k++) assert_true((double)quad_abs(truth[k] - root[k]) <= radius[k]);
  }
  assert_true(proven > 350);
}

int main(void)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(a_proven_root_is_within_its_radii),
                                     cmocka_unit_test(a_root_beside_its_box_is_within_its_radii)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
