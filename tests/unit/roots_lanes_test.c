/* Methods on lanes, by themselves: polynomials of known roots, and inputs that a solver must survive. Compiled once
 * per instruction set (CMakeLists.txt); skipped if the processor lacks it. */
#include "algebra/roots_lanes.h"

#include "cmocka_test.h"
#include "lanes_main.h"
#include "random.h"

enum { SEED = 20240522, ROUNDS = 400, SWEEPS = 100 };

/* A start this near is good enough: a step below ROOTS_SETTLED leaves about its square, a few times over. */
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

/* A polynomial with `inside` real roots in [0,1], at least `apart` from each other. Its other roots are real ones
 * outside and pairs, at least as far away. */
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

/* The method under test. */
static enum solver_lanes method;

static lane_mask run_all(struct roots_lanes *a, lane_mask wanted)
{
  return roots_lanes_run(a, wanted, lanes_all(INFINITY), ROOTS_SETTLED, SWEEPS);
}

static bool found(const struct roots_lanes *a, unsigned lane, double u)
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
    const int n = 1 + round % ROOTS_LANES_DEGREE, inside = 1 + (int)(random_bits(&random) % 4);
    const int real = inside < n ? inside : n;
    double root[LANES][4];
    lanes c[ROOTS_LANES_DEGREE + 1];
    for (int lane = 0; lane < LANES; lane++) {
      double one[ROOTS_LANES_DEGREE + 3];
      known_polynomial(&random, n, real, root[lane], one);
      for (int k = 0; k <= n; k++) c[k][lane] = one[k];
    }
    struct roots_lanes a = {.method = method};
    const lane_mask all = roots_lanes_set(&a, n, c);
    assert_int_equal(lanes_bits(all), (1u << LANES) - 1);
    roots_lanes_start(&a, all);
    undone += LANES - __builtin_popcount(lanes_bits(run_all(&a, all)));
    for (unsigned lane = 0; lane < LANES; lane++)
      for (int k = 0; k < real; k++) roots++, lost += !found(&a, lane, root[lane][k]);
  }
  print_message("%d roots, %d lost; %d lanes not done\n", roots, lost, undone);
  assert_true(roots > ROUNDS);
  /* A value may settle too early, which costs its caller time only. */
  assert_true(lost <= roots / 1000);
  assert_true(undone <= ROUNDS * LANES / 1000);
}

/* Quadratics in y, as of nearly bilinear leaves: one root in [-1,1], the other one anywhere, or at infinity. */
static void a_root_of_quadratics_is_found(void **state)
{
  (void)state;
  struct random random = {SEED + 2};
  for (int round = 0; round < ROUNDS; round++) {
    lanes q[3], root = {0};
    for (int lane = 0; lane < LANES; lane++) {
      const double size = exp2(random_between(&random, -300, 300)), y = random_between(&random, -0.99, 0.99);
      const double far = random_between(&random, -0.9, 0.9); /* the inverse of the other root */
      const double one = random_bits(&random) % 4 == 0 ? 0 : far;
      root[lane] = y, q[0][lane] = -size * y, q[1][lane] = size * (1 + one * y), q[2][lane] = -size * one;
    }
    struct roots_lanes a = {.method = method};
    const lane_mask all = roots_lanes_set_quadratic(&a, q[0], q[1], q[2]);
    roots_lanes_start(&a, all);
    assert_int_equal(lanes_bits(roots_lanes_run(&a, all, lanes_all(1), ROOTS_SETTLED, SWEEPS)), (1u << LANES) - 1);
    lane_mask near = {0};
    for (int i = 0; i < 2; i++) near |= ~a.moving[i] & (lanes_abs(a.zr[i] - root) + lanes_abs(a.zi[i]) < NEAR);
    assert_int_equal(lanes_bits(near), (1u << LANES) - 1);
  }
}

/* Starts from the roots of a nearby polynomial, of which two real ones have become a pair, or the reverse. */
static void previous_roots_part_and_meet(void **state)
{
  (void)state;
  for (int way = 0; way < 2; way++) {
    lanes c[ROOTS_LANES_DEGREE + 1];
    struct roots_lanes a = {.method = method};
    for (int turn = 0; turn < 2; turn++) {
      double one[ROOTS_LANES_DEGREE + 3] = {1};
      int degree = 0;
      const double square = turn == way ? 4e-4 : -4e-4, d = 0.25 + square; /* (u - 1/2)^2 + square */
      times_quadratic(one, &degree, d, 2 * d - 1, d);
      times_quadratic(one, &degree, 2, 3, 2.5);
      times_linear(one, &degree, 3, 2);
      for (int k = 0; k <= degree; k++) c[k] = lanes_all(one[k]);
      const lane_mask all = roots_lanes_set(&a, degree, c);
      if (turn == 0) roots_lanes_start(&a, all);
      else
        for (int i = 0; i < degree; i++)
          if (fabs(a.zi[i][0]) < ROOTS_LIFT) a.zi[i] += i % 2 ? ROOTS_LIFT : -ROOTS_LIFT;
      assert_int_equal(lanes_bits(run_all(&a, all)), lanes_bits(all));
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

/* Coefficients that vanish at either end of the powers of y, or all, or are NaN: no lane hangs, and the lanes beside
 * them are not disturbed. */
static void neighbours_do_not_matter(void **state)
{
  (void)state;
  struct random random = {SEED + 1};
  for (int round = 0; round < ROUNDS; round++) {
    const int n = 2 + round % (ROOTS_LANES_DEGREE - 1);
    double root[4], one[ROOTS_LANES_DEGREE + 3];
    known_polynomial(&random, n, n < 3 ? n : 3, root, one);
    const unsigned subject = (unsigned)(random_bits(&random) % LANES);
    struct roots_lanes a = {.method = method}, b = a;
    lanes c[ROOTS_LANES_DEGREE + 1];
    for (int k = 0; k <= n; k++) c[k] = lanes_all(one[k]);
    const lane_mask all = roots_lanes_set(&a, n, c);
    roots_lanes_start(&a, all);
    run_all(&a, all & lanes_mask(1u << subject));
    for (unsigned lane = 0; lane < LANES; lane++) {
      if (lane == subject) continue;
      double other[ROOTS_LANES_DEGREE + 3] = {1};
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
    const lane_mask able = roots_lanes_set(&b, n, c);
    roots_lanes_start(&b, able);
    run_all(&b, able);
    assert_true(able[subject] != 0);
    assert_true(a.sweeps[subject] == b.sweeps[subject]);
    for (int i = 0; i < n; i++) {
      assert_true(a.zr[i][subject] == b.zr[i][subject]);
      assert_true(a.zi[i][subject] == b.zi[i][subject]);
    }
  }
}

/* At least one step of each root, or of one of each pair, on the lanes that seek roots. */
static void what_is_done_is_counted(void **state)
{
  (void)state;
  struct random random = {SEED + 3};
  for (int n = 2; n <= ROOTS_LANES_DEGREE; n++) {
    double root[4], one[ROOTS_LANES_DEGREE + 3];
    lanes c[ROOTS_LANES_DEGREE + 1];
    struct roots_lanes a = {.method = method};
    known_polynomial(&random, n, n < 3 ? n : 3, root, one);
    for (int k = 0; k <= n; k++) c[k] = lanes_all(one[k]);
    roots_lanes_start(&a, roots_lanes_set(&a, n, c));
    run_all(&a, lanes_mask(1));
    for (int lane = 0; lane < LANES; lane++)
      if (lane == 0) assert_in_range((size_t)a.sweeps[lane], n * n / 2, SWEEPS * 2 * n * n);
      else assert_true(a.sweeps[lane] == 0);
  }
}

/* Called only where the processor has the instructions, and not part of main, which must run on all. */
__attribute__((noinline)) static int run(void)
{
  static const struct {
    enum solver_lanes method;
    const char *name;
  } methods[] = {{SOLVER_LANES_ABERTH, "aberth"},
                 {SOLVER_LANES_NEWTON, "newton"},
                 {SOLVER_LANES_LAGUERRE, "laguerre"},
                 {SOLVER_LANES_DURAND_KERNER, "durand_kerner"}};
  print_message("seed %d, %d lanes\n", SEED, LANES);
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(known_roots_are_found),        cmocka_unit_test(a_root_of_quadratics_is_found),
    cmocka_unit_test(previous_roots_part_and_meet), cmocka_unit_test(neighbours_do_not_matter),
    cmocka_unit_test(what_is_done_is_counted),
  };
  int failed = 0;
  for (size_t n = 0; n < sizeof methods / sizeof methods[0]; n++) {
    method = methods[n].method;
    failed += cmocka_run_group_tests_name(methods[n].name, tests, NULL, NULL);
  }
  return failed;
}

int main(void) { return lanes_main(run); }
