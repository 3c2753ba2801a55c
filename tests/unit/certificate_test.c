/* The certificate at its limits: what certificate.h just lets pass is tried on functions that turn as fast, and are off
 * by as much, as is allowed. In one row, with z = 0, that is the parabola
 *
 *     (M f)(w) = -(step + d) + (1 + k) w - turn w^2 / 2,   |d| <= sqrt 2 size, |k| <= 16 sqrt 2 size, |turn| <= bend.
 */
#include "intersect/certificate.h"

#include <math.h>
#include <stdbool.h>

#include "cmocka_test.h"
#include "worse.h"

/* The search starts far above all that passes. It ends, 2^-156 wide, far below all that is told apart. */
#define LARGEST 0x1p100
enum { HALVINGS = 256 };

/* The error of the derivative, k above, in errors of a value. */
enum { SLOPE_ERRORS = 16 };

/* The error of a step, if size is a row's Euclidean length times the error of both values. */
#define SIZES sqrtl(2)

/* The error of the second derivatives of a plane polynomial, in errors of a value: 24 and 24, and twice 36. */
enum { SECOND_ERRORS = 120 };

struct turning {
  double bend, size, step;
};

static bool step_passes(const struct turning *f, double step) { return certificate_holds(f->bend, step, f->size); }
static bool size_passes(const struct turning *f, double size) { return certificate_holds(f->bend, f->step, size); }
static bool turn_passes(const struct turning *f, double turn) { return certificate_alone(turn, f->size); }

/* The largest x that passes; negative if none does. */
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

/* Whether the parabola has exactly one root within 2 (step + size) of 0, and that within its radius of where the step
 * went. *away: its distance from 0. */
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

/* Whether another row, with its own bend and size, is within its radius at a root at this distance. */
static bool row_is_near(const struct turning *f, long double away, long double row_bend, long double row_size)
{
  const long double off = SIZES * (row_size + SLOPE_ERRORS * row_size * away) + row_bend * away * away / 2;
  return off <= certificate_radius(row_bend, (long double)f->step + f->size, row_size);
}

static void try_all(const struct turning *f)
{
  for (int n = 0; n < 18; n++) {
    const int d = n / 6 - 1, k = n / 2 % 3 - 1, turn = n % 2 ? 1 : -1;
    const long double size = SIZES * f->size, bend = f->bend;
    long double away = 0;
    assert_true(has_one_root(f, d * size, k * SLOPE_ERRORS * size, turn * bend, &away));
    for (int part = 0; part <= 100; part += 50) {
      assert_true(row_is_near(f, away, bend, ldexpl(f->size, -part)));
      assert_true(row_is_near(f, away, ldexpl(bend, -part), f->size));
    }
  }
}

TEST(what_passes_has_one_root)
{
  int tried = 0;
  for (int bend = -30; bend <= 60; bend++) {
    for (int size = -70; size <= 0; size++) {
      struct turning f = {.bend = ldexp(1, bend), .size = ldexp(1, size)};
      f.step = limit(step_passes, &f);
      if (!(f.step >= 0)) continue;
      try_all(&f), tried++;
    }
    for (int step = -60; step <= 0; step++) {
      struct turning f = {.bend = ldexp(1, bend), .step = ldexp(1, step)};
      f.size = limit(size_passes, &f);
      if (f.size < 0) continue;
      try_all(&f), tried++;
    }
  }
  assert_true(tried > 1000);
}

/* ---- two rows ---- */

/* (M f)(w) of two parameters. M's rows have the directions `row`, and `length` times the longer one's length. */
struct surface {
  struct turning longer;
  long double row[2][2], length[2], step[2];
  long double error[2], slope[2], form[3]; /* signs of the errors of values and slopes; shares of turn */
};

/* Finds the root by Newton's method; false if there is none near. */
static bool surface_root(const struct surface *f, long double w[2])
{
  const long double *h = f->form;
  w[0] = w[1] = 0;
  for (int n = 0; n < 20; n++) {
    long double value[2], jacobian[2][2];
    for (int k = 0; k < 2; k++) {
      const long double size = f->longer.size * f->length[k], turn = f->longer.bend * f->length[k];
      const long double rounding[2] = {f->row[k][0] * f->error[0] * size, f->row[k][1] * f->error[1] * size};
      const long double off = SLOPE_ERRORS * (rounding[0] * f->slope[0] + rounding[1] * f->slope[1]) / 2;
      value[k] = w[k] + off * (w[0] + w[1]) - f->step[k] - rounding[0] - rounding[1] -
                 turn * (h[0] * w[0] * w[0] + 2 * h[1] * w[0] * w[1] + h[2] * w[1] * w[1]) / 2;
      jacobian[k][0] = (k == 0) + off - turn * (h[0] * w[0] + h[1] * w[1]);
      jacobian[k][1] = (k == 1) + off - turn * (h[1] * w[0] + h[2] * w[1]);
    }
    const long double d = jacobian[0][0] * jacobian[1][1] - jacobian[0][1] * jacobian[1][0];
    w[0] -= (jacobian[1][1] * value[0] - jacobian[0][1] * value[1]) / d;
    w[1] -= (jacobian[0][0] * value[1] - jacobian[1][0] * value[0]) / d;
  }
  const long double far = 2 * ((long double)f->longer.step + f->longer.size);
  return fabsl(w[0]) <= far && fabsl(w[1]) <= far;
}

/* Takes the last digit off *n, in this base. */
static int digit(int *n, int base)
{
  const int last = *n % base;
  *n /= base;
  return last;
}

static int sign(int *n) { return digit(n, 2) ? 1 : -1; }

enum { SURFACES = 4 * 3 * 4 * 4 * 64 };

/* Surface `number` of the SURFACES whose longer row just passes. */
static struct surface surface_of(const struct turning *longer, int number)
{
  static const long double forms[][3] = {{1, 0, 0}, {0, 0.5L, 0}, {0.25L, 0.25L, 0.25L}, {0.5L, 0, -0.5L}};
  const long double eighth = atanl(1), angle = eighth * digit(&number, 4),
                    other = angle + eighth * (1 + digit(&number, 3));
  const int shorter = digit(&number, 4), form = digit(&number, 4);
  struct surface f = {.longer = *longer,
                      .row = {{cosl(angle), sinl(angle)}, {cosl(other), sinl(other)}},
                      .length = {1, ldexpl(1, -shorter * shorter)}};
  for (int c = 0; c < 3; c++) f.form[c] = forms[form][c];
  for (int k = 0; k < 2; k++)
    f.step[k] = sign(&number) * longer->step, f.error[k] = sign(&number), f.slope[k] = sign(&number);
  return f;
}

/* The largest distance, over all of them, of the root from where the step went, in radii. */
static double try_surfaces(const struct turning *longer)
{
  double most = 0;
  for (int n = 0; n < SURFACES; n++) {
    const struct surface f = surface_of(longer, n);
    long double w[2];
    assert_true(surface_root(&f, w));
    for (int k = 0; k < 2; k++) {
      const long double radius = certificate_radius(longer->bend * f.length[k], longer->step,
                                                    longer->size * f.length[k]);
      most = worse(most, (double)(fabsl(w[k] - f.step[k]) / radius));
    }
  }
  return most;
}

TEST(what_passes_of_two_rows_is_near)
{
  double most = 0;
  for (int bend = -20; bend <= 40; bend += 10) {
    for (int size = -58; size <= -10; size += 8) {
      struct turning f = {.bend = ldexp(1, bend), .size = ldexp(1, size)};
      f.step = limit(step_passes, &f);
      if (f.step >= 0) most = worse(most, try_surfaces(&f));
    }
  }
  assert_true(most <= 1);
  assert_true(most > 0.5); /* the limits are nearly reached */
}

/* ---- no other ---- */

/* From a root, where the slope is 1 or as small as rounding allows, f = w - turn w^2 / 2 returns to 0 at w = 2 / turn.
 * That is beyond a leaf of length 1 if turn is below 2. */
TEST(what_passes_is_alone)
{
  int tried = 0;
  for (int size = -70; size <= 0; size++) {
    struct turning f = {.size = ldexp(1, size)};
    const double turn = limit(turn_passes, &f);
    if (!(f.size <= CERTIFICATE_SIZE) || turn < 0) continue;
    assert_true(2 * (1 - SIZES * SLOPE_ERRORS * f.size) / (turn + SIZES * SECOND_ERRORS * f.size) > 1);
    tried++;
  }
  assert_true(tried > 50);
}
