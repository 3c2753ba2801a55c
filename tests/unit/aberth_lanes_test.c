/* Aberth's method on lanes, by itself: polynomials of known roots, and what a solver must survive. Compiled once per
 * instruction set (CMakeLists.txt); where the processor lacks it the test is skipped. */
#include "algebra/aberth_lanes.h"

#include "cmocka_test.h"
#include "lanes_main.h"
#include "random.h"

enum { SEED = 20240522, ROUNDS = 400, SWEEPS = 100 };

/* Starts this near are good ones: a step below ABERTH_SETTLED leaves about its square, some times over. */
#define NEAR 1e-3

/* Multiplies c[0..*degree], scaled Bernstein form, by e0 (1-u) + e1 u. */
static void times_linear(double c[], int *degree, double e0, double e1)
{
  c[*degree + 1] = 0;
  for (int k = ++*degree; k >= 0; k--) c[k] = c[k] * e0 + (k > 0 ? c[k - 1] * e1 : 0);
}

/* By e0 (1-u)^2 + e1 u (1-u) + e2 u^2. */
static void times_quadratic(double c[], int *degree, double e0, double e1, double e2)
{
  const int n = *degree += 2;
  c[n] = c[n - 1] = 0;
  for (int k = n; k >= 0; k--) c[k] = c[k] * e0 + (k > 0 ? c[k - 1] * e1 : 0) + (k > 1 ? c[k - 2] * e2 : 0);
}

/* A polynomial with `inside` real roots in [0,1], at least `apart` from each other; the others real outside, and pairs
 * at least as far off. */
static void known_polynomial(struct random *random, int n, int inside, double root[], double c[])
{
  int degree = 0;
  c[0] = 1;
  for (int k = 0; k < inside; k++) {
    root[k] = (k + random_between(random, 0.2, 0.8)) / inside;
    times_linear(c, &degree, -root[k], 1 - root[k]);
  }
  while (degree < n) {
    if (n - degree == 1 || random_bits(random) % 4 == 0) {
      const double far = random_between(random, 1.5, 6), u = random_bits(random) % 2 ? far : 1 - far;
      times_linear(c, &degree, -u, 1 - u);
    } else { /* ((u-a)^2 + b^2), 1 = ((1-u) + u)^2 */
      const double a = random_between(random, -1, 2), b = random_between(random, 0.2, 1.5), d = a * a + b * b;
      times_quadratic(c, &degree, d, 2 * (d - a), d - 2 * a + 1);
    }
  }
}

static void start_cold(struct aberth_lanes *a)
{
  for (unsigned lane = 0; lane < LANES; lane++) aberth_lanes_start(a, lane);
}

static bool found(const struct aberth_lanes *a, unsigned lane, double u)
{
  for (int i = 0; i < a->degree; i++)
    if (fabs(0.5 + 0.5 * a->zr[i][lane] - u) + fabs(0.5 * a->zi[i][lane]) < NEAR) return true;
  return false;
}

static void known_roots_are_found(void **state)
{
  (void)state;
  struct random random = {SEED};
  int roots = 0, lost = 0, undone = 0;
  for (int round = 0; round < ROUNDS; round++) {
    const int n = 1 + round % ABERTH_LANES_DEGREE, inside = 1 + (int)(random_bits(&random) % 4);
    const int real = inside < n ? inside : n;
    double root[LANES][4];
    lanes c[ABERTH_LANES_DEGREE + 1];
    for (int lane = 0; lane < LANES; lane++) {
      double one[ABERTH_LANES_DEGREE + 3];
      known_polynomial(&random, n, real, root[lane], one);
      for (int k = 0; k <= n; k++) c[k][lane] = one[k];
    }
    struct aberth_lanes a;
    const lane_mask all = aberth_lanes_set(&a, n, c);
    assert_int_equal(lanes_bits(all), (1u << LANES) - 1);
    start_cold(&a);
    undone += LANES - __builtin_popcount(lanes_bits(aberth_lanes_run(&a, all, ABERTH_SETTLED, SWEEPS)));
    for (unsigned lane = 0; lane < LANES; lane++)
      for (int k = 0; k < real; k++) roots++, lost += !found(&a, lane, root[lane][k]);
  }
  print_message("%d roots, %d lost; %d lanes not done\n", roots, lost, undone);
  assert_true(roots > ROUNDS);
  /* A value may come to rest too early, which costs its caller time only. */
  assert_true(lost <= roots / 1000);
  assert_true(undone <= ROUNDS * LANES / 1000);
}

/* From the roots of a polynomial near by, one of which has become a pair, or the other way round. */
static void previous_roots_part_and_meet(void **state)
{
  (void)state;
  for (int way = 0; way < 2; way++) {
    lanes c[ABERTH_LANES_DEGREE + 1];
    struct aberth_lanes a;
    for (int turn = 0; turn < 2; turn++) {
      double one[ABERTH_LANES_DEGREE + 3] = {1};
      int degree = 0;
      const double square = turn == way ? 4e-4 : -4e-4, d = 0.25 + square; /* (u - 1/2)^2 + square */
      times_quadratic(one, &degree, d, 2 * d - 1, d);
      times_quadratic(one, &degree, 2, 3, 2.5);
      times_linear(one, &degree, 3, 2);
      for (int k = 0; k <= degree; k++) c[k] = lanes_all(one[k]);
      const lane_mask all = aberth_lanes_set(&a, degree, c);
      if (turn == 0) start_cold(&a);
      else
        for (int i = 0; i < degree; i++)
          if (fabs(a.zi[i][0]) < ABERTH_LIFT) a.zi[i] += i % 2 ? ABERTH_LIFT : -ABERTH_LIFT;
      assert_int_equal(lanes_bits(aberth_lanes_run(&a, all, ABERTH_SETTLED, SWEEPS)), lanes_bits(all));
      int real = 0, pair = 0;
      for (int i = 0; i < degree; i++) {
        const double re = 0.5 * a.zr[i][0], im = 0.5 * a.zi[i][0];
        real += hypot(fabs(re) - 0.02, im) < NEAR, pair += hypot(re, fabs(im) - 0.02) < NEAR;
      }
      assert_int_equal(real, square > 0 ? 0 : 2);
      assert_int_equal(pair, square > 0 ? 2 : 0);
    }
  }
}

/* Coefficients that vanish at either end of the powers of y, all, or are not numbers: no hang, and the lanes beside
 * them are not disturbed. */
static void neighbours_do_not_matter(void **state)
{
  (void)state;
  struct random random = {SEED + 1};
  for (int round = 0; round < ROUNDS; round++) {
    const int n = 2 + round % (ABERTH_LANES_DEGREE - 1);
    double root[4], one[ABERTH_LANES_DEGREE + 3];
    known_polynomial(&random, n, n < 3 ? n : 3, root, one);
    const unsigned subject = (unsigned)(random_bits(&random) % LANES);
    struct aberth_lanes a, b;
    lanes c[ABERTH_LANES_DEGREE + 1];
    for (int k = 0; k <= n; k++) c[k] = lanes_all(one[k]);
    const lane_mask all = aberth_lanes_set(&a, n, c);
    start_cold(&a);
    aberth_lanes_run(&a, all & lanes_mask(1u << subject), ABERTH_SETTLED, SWEEPS);
    for (unsigned lane = 0; lane < LANES; lane++) {
      if (lane == subject) continue;
      double other[ABERTH_LANES_DEGREE + 3] = {1};
      int degree = 0;
      while (degree < n) {
        const int kind = (int)(random_bits(&random) % 4);
        if (kind == 0) times_linear(other, &degree, 1, 1);       /* 1: a root at infinity */
        else if (kind == 1) times_linear(other, &degree, -1, 1); /* y = 0 */
        else times_linear(other, &degree, 1, random_between(&random, -2, 2));
      }
      const int bad = (int)(random_bits(&random) % 8);
      for (int k = 0; k <= n; k++) c[k][lane] = bad == 0 ? 0 : bad == 1 ? NAN : bad == 2 ? INFINITY : other[k];
    }
    const lane_mask able = aberth_lanes_set(&b, n, c);
    start_cold(&b);
    aberth_lanes_run(&b, able, ABERTH_SETTLED, SWEEPS);
    assert_true(able[subject] != 0);
    for (int i = 0; i < n; i++) {
      assert_true(a.zr[i][subject] == b.zr[i][subject]);
      assert_true(a.zi[i][subject] == b.zi[i][subject]);
    }
  }
}

/* Called only where the processor has the instructions, and not part of main, which must run on all. */
__attribute__((noinline)) static int run(void)
{
  print_message("seed %d, %d lanes\n", SEED, LANES);
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(known_roots_are_found),
    cmocka_unit_test(previous_roots_part_and_meet),
    cmocka_unit_test(neighbours_do_not_matter),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}

int main(void) { return lanes_main(run); }
