/* The certificate at its limits: of all that certificate.h lets pass, what passes just so is tried on the function that
 * turns as fast, and is off by as much, as is allowed. In one dimension, with M = 1 and z = 0, that is the parabola
 *
 *     f(w) = -(step + d) + (1 + k) w - turn w^2 / 2,   |d| <= size, |k| <= 16 size, |turn| <= bend. */
#include "intersect/certificate.h"

#include <math.h>
#include <stdbool.h>

#include "cmocka_test.h"

/* Far more than all that passes, and far less than what is told apart. */
#define LARGEST 0x1p100
enum { HALVINGS = 256 };

/* Roundings of the derivative: the k above is so many sizes. */
enum { SLOPE_ERRORS = 16 };

/* How far the second derivatives of a plane polynomial are off, in errors of a value: 24 and 24, and twice 36. */
enum { SECOND_ERRORS = 120 };

struct turning {
  double bend, size, step;
};

static bool step_passes(const struct turning *f, double step) { return certificate_holds(f->bend, step, f->size); }
static bool size_passes(const struct turning *f, double size) { return certificate_holds(f->bend, f->step, size); }
static bool turn_passes(const struct turning *f, double turn) { return certificate_alone(turn, f->size); }

/* The largest x that passes; negative for none. */
static double limit(bool (*passes)(const struct turning *, double), const struct turning *f)
{
  double low = 0, high = LARGEST;
  if (!passes(f, low)) return -1;
  for (int n = 0; n < HALVINGS; n++) {
    const double middle = low + (high - low) / 2;
    if (passes(f, middle)) low = middle;
    else high = middle;
  }
  return low;
}

/* Whether the parabola has one root within 2 (step + size) of 0, and not too far from where the step went; *away: how far
 * the root is from 0. */
static bool has_one_root(const struct turning *f, long double d, long double k, long double turn, long double *away)
{
  const long double value = f->step + d, slope = 1 + k, square = slope * slope - 2 * turn * value;
  const long double within = 2 * ((long double)f->step + f->size);
  if (square < 0 || slope <= 0) return false;
  const long double first = 2 * value / (slope + sqrtl(square)), second = (slope + sqrtl(square)) / turn;
  *away = fabsl(first);
  return *away <= within && fabsl(second) > within &&
         fabsl(first - f->step) <= certificate_radius((long double)f->bend, f->step, f->size);
}

/* Whether another row, with a bend and a size of its own, is within its radius at a root that is so far away. */
static bool row_is_near(const struct turning *f, long double away, long double row_bend, long double row_size)
{
  const long double off = row_size + SLOPE_ERRORS * row_size * away + row_bend * away * away / 2;
  return off <= certificate_radius(row_bend, (long double)f->step + f->size, row_size);
}

static void try_all(const struct turning *f)
{
  for (int n = 0; n < 18; n++) {
    const int d = n / 6 - 1, k = n / 2 % 3 - 1, turn = n % 2 ? 1 : -1;
    const long double size = f->size, bend = f->bend;
    long double away = 0;
    assert_true(has_one_root(f, d * size, k * SLOPE_ERRORS * size, turn * bend, &away));
    for (int part = 0; part <= 100; part += 50) {
      assert_true(row_is_near(f, away, bend, ldexpl(size, -part)));
      assert_true(row_is_near(f, away, ldexpl(bend, -part), size));
    }
  }
}

/* Nobody asks for longer steps. */
#define LONGEST_STEP (1.0 / 32)

static void what_passes_has_one_root(void **state)
{
  (void)state;
  int tried = 0;
  for (int bend = -30; bend <= 60; bend++) {
    for (int size = -70; size <= 0; size++) {
      struct turning f = {.bend = ldexp(1, bend), .size = ldexp(1, size)};
      f.step = limit(step_passes, &f);
      if (!(f.step >= 0 && f.step <= LONGEST_STEP)) continue;
      try_all(&f), tried++;
    }
    for (int step = -60; step <= -5; step++) {
      struct turning f = {.bend = ldexp(1, bend), .step = ldexp(1, step)};
      f.size = limit(size_passes, &f);
      if (f.size < 0) continue;
      try_all(&f), tried++;
    }
  }
  assert_true(tried > 1000);
}

/* From a root, where the slope is 1 or as little as rounding lets it be, f = w - turn w^2 / 2 is back at 0 at w = 2 / turn: over a leaf of
 * length 1 that is behind its end where turn is below 2. */
static void what_passes_is_alone(void **state)
{
  (void)state;
  int tried = 0;
  for (int size = -70; size <= 0; size++) {
    struct turning f = {.size = ldexp(1, size)};
    const double turn = limit(turn_passes, &f);
    if (!(f.size <= CERTIFICATE_SIZE) || turn < 0) continue;
    assert_true(2 * (1 - SLOPE_ERRORS * f.size) / (turn + SECOND_ERRORS * f.size) > 1);
    tried++;
  }
  assert_true(tried > 50);
}

int main(void)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(what_passes_has_one_root),
                                     cmocka_unit_test(what_passes_is_alone)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
