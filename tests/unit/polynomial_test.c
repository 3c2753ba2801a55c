/* Values, the change of basis, eq 11 and sign counts, against quadruple precision and against enumeration. */
#include "algebra/polynomial.h"

#include <math.h>

#include "algebra/evaluation.h"
#include "base/wide.h"
#include "cmocka_test.h"
#include "random.h"

enum { TRIALS = 3000, LARGEST_COUNTED = 9 };

/* A bound is useful if it is at most this many unit roundoffs of the sum of moduli, per degree. */
#define BOUND_LOOSENESS 40.0

/* sum c[k] u^k v^(n-k), with v = 1 - u or 1, and its derivative in u. */
static void wide_values(const struct polynomial *p, double u, wide *value, wide *slope, wide *size)
{
  const bool bernstein = p->basis == BASIS_BERNSTEIN;
  const wide x = u, v = bernstein ? 1 - x : 1;
  *value = *slope = *size = 0;
  for (int k = 0; k <= p->degree; k++) {
    wide low = 1, high = 1, low_slope = 0, high_slope = 0; /* u^k and v^(n-k) with derivatives */
    for (int i = 0; i < k; i++) {
      low_slope = low_slope * x + low;
      low *= x;
    }
    for (int i = 0; bernstein && i < p->degree - k; i++) {
      high_slope = high_slope * v - high;
      high *= v;
    }
    *value += p->c[k] * low * high;
    *slope += p->c[k] * (low_slope * high + low * high_slope);
    *size += wide_abs(p->c[k] * low * high);
  }
}

static void random_polynomial(struct random *random, struct polynomial *p, double c[], double error[])
{
  p->degree = 1 + (int)(random_bits(random) % 30);
  p->basis = random_bits(random) % 2 == 0 ? BASIS_BERNSTEIN : BASIS_POWER;
  const double spread = random_between(random, 0.0, 20.0);
  for (int k = 0; k <= p->degree; k++) {
    c[k] = random_between(random, -1.0, 1.0) * exp2(random_between(random, -spread, spread));
    error[k] = 0.0;
  }
  p->c = c;
  p->error = error;
}

/* Where a chart is used, |z| <= 1: powers of z, or of 1/x, whose coefficients are reversed. */
static void check_value(struct random *random, const struct polynomial *p, const double moved[])
{
  struct evaluation e;
  double c[POLYNOMIAL_MAX_DEGREE + 1];
  const bool reversed = random_bits(random) % 2 == 0;
  const double z = random_between(random, -1.0, 1.0);
  evaluation_prepare(p->degree, p->basis, p->c, p->error, &e);
  const struct evaluation_real found = evaluation_at_real(&e, z, reversed);
  for (int k = 0; k <= p->degree; k++) c[k] = moved[reversed ? p->degree - k : k];
  const struct polynomial powers = {p->degree, BASIS_POWER, c, NULL};
  wide value, slope, size;
  wide_values(&powers, z, &value, &slope, &size);
  assert_true(wide_abs(found.value - value) <= found.error);
  assert_true(wide_abs(found.slope - slope) <= found.slope_error);
  if (moved == p->c) assert_true(found.error <= BOUND_LOOSENESS * p->degree * 0x1p-53 * (double)size + 0x1p-1000);
}

TEST(values_lie_within_bounds)
{
  struct random random = {11};
  for (int trial = 0; trial < TRIALS; trial++) {
    struct polynomial p;
    double c[POLYNOMIAL_MAX_DEGREE + 1], error[POLYNOMIAL_MAX_DEGREE + 1];
    random_polynomial(&random, &p, c, error);
    check_value(&random, &p, c);
  }
}

/* The bound of a value contains the bounds of the coefficients: a polynomial moved by these stays within it. */
TEST(coefficient_errors_count)
{
  struct random random = {12};
  for (int trial = 0; trial < TRIALS; trial++) {
    struct polynomial p;
    double c[POLYNOMIAL_MAX_DEGREE + 1], error[POLYNOMIAL_MAX_DEGREE + 1], moved[POLYNOMIAL_MAX_DEGREE + 1];
    random_polynomial(&random, &p, c, error);
    for (int k = 0; k <= p.degree; k++) {
      error[k] = 1e-9 * fabs(c[k]);
      moved[k] = c[k] + (k % 2 == 0 ? 1.0 : -1.0) * (1.0 - 1e-6) * error[k];
    }
    check_value(&random, &p, moved);
  }
}

TEST(bernstein_form_within_bounds)
{
  struct random random = {13};
  for (int trial = 0; trial < TRIALS; trial++) {
    struct polynomial p;
    double c[POLYNOMIAL_MAX_DEGREE + 1], error[POLYNOMIAL_MAX_DEGREE + 1];
    double other_c[POLYNOMIAL_MAX_DEGREE + 1], other_error[POLYNOMIAL_MAX_DEGREE + 1];
    random_polynomial(&random, &p, c, error);
    polynomial_to_bernstein(&p, other_c, other_error);
    /* At a point both agree within what the bounds of the coefficients allow there. */
    const struct polynomial other = {p.degree, BASIS_BERNSTEIN, other_c, NULL};
    const double u = random_unit(&random);
    wide value, other_value, slope, size, allowed = 0;
    wide_values(&p, u, &value, &slope, &size);
    wide_values(&other, u, &other_value, &slope, &size);
    struct polynomial bounds = other;
    bounds.c = other_error;
    wide_values(&bounds, u, &allowed, &slope, &size);
    assert_true(wide_abs(value - other_value) <= allowed);
  }
}

/* Eq 11 at a point next to a root, where no digit of |P| is right in doubles: (x - 1)^3 (x - 2^40), and in x =
 * u/(1-u). */
TEST(eq11_is_measured_in_higher_precision)
{
  const double large = 0x1p40, c[] = {large, -1 - 3 * large, 3 + 3 * large, -3 - large, 1};
  const struct polynomial p = {4, BASIS_POWER, c, NULL};
  const double x = 1 + 0x1p-14, d = 0x1p-14;
  const double expected = d * d * d * (large - x) / (4 * 0x1p-52 * ((3 + 3 * large) * x * x));
  assert_true(fabs(polynomial_eq11(&p, x, 0) / expected - 1) < 1e-14);
  assert_true(polynomial_eq11(&p, 1, 0) == 0 && polynomial_eq11(&p, large, 0) == 0);
  const double far = nextafter(large, INFINITY); /* one place farther: |x - 1|^3 times that place */
  const double place = far - large, terms = (3 + large) * far * far * far;
  assert_true(fabs(polynomial_eq11(&p, far, 0) / ((far - 1) * (far - 1) * (far - 1) * place / (4 * 0x1p-52 * terms)) -
                   1) < 1e-14);
}

/* Tries all ways of giving the unknown signs a value. A zero counts as no change. */
static int count_by_enumeration(int degree, const double c[], const double error[])
{
  int open[LARGEST_COUNTED + 1], open_count = 0;
  double sign[LARGEST_COUNTED + 1];
  for (int k = 0; k <= degree; k++) {
    sign[k] = c[k];
    if (fabs(c[k]) <= error[k] && error[k] > 0.0) open[open_count++] = k;
  }
  int most = 0;
  for (int choice = 0; choice < 1 << open_count; choice++) {
    for (int i = 0; i < open_count; i++) sign[open[i]] = (choice >> i & 1) != 0 ? 1.0 : -1.0;
    int changes = 0;
    double last = 0.0;
    for (int k = 0; k <= degree; k++) {
      if (sign[k] != 0.0) {
        changes += last * sign[k] < 0.0;
        last = sign[k];
      }
    }
    most = changes > most ? changes : most;
  }
  return most;
}

TEST(sign_counts_are_sharp)
{
  struct random random = {14};
  for (int trial = 0; trial < TRIALS; trial++) {
    const int degree = 1 + (int)(random_bits(&random) % LARGEST_COUNTED);
    double c[LARGEST_COUNTED + 1], error[LARGEST_COUNTED + 1];
    for (int k = 0; k <= degree; k++) {
      c[k] = (double)(random_bits(&random) % 3) - 1.0;
      error[k] = random_bits(&random) % 3 == 0 ? 2.0 : 0.0;
    }
    assert_int_equal(polynomial_sign_variations(degree, c, error), count_by_enumeration(degree, c, error));
  }
}

TEST(binomials)
{
  for (int n = 0; n <= POLYNOMIAL_MAX_DEGREE; n++) {
    wide row = 0;
    for (int k = 0; k <= n; k++) row += polynomial_binomial(n, k);
    assert_true(wide_abs(row - exp2(n)) <= exp2(n - 52));
  }
  assert_true(polynomial_binomial(18, 9) == 48620.0);
  assert_true(polynomial_binomial(5, 6) == 0.0);
}
