/* Values, changes of basis and sign counts, against quadruple precision and against enumeration. */
#include "algebra/polynomial.h"

#include <math.h>

#include "cmocka_test.h"
#include "random.h"

typedef _Float128 quad;

enum { TRIALS = 3000, LARGEST_COUNTED = 9 };

/* A bound is worth something if it is not larger than this many unit roundoffs of the sum of moduli, per degree. */
#define BOUND_LOOSENESS 40.0

static quad quad_abs(quad x)
{
  return x < 0 ? -x : x;
}

/* sum c[k] u^k v^(n-k), with v = 1 - u or 1, and its derivative in u. */
static void quad_values(const struct polynomial *p, double u, quad *value, quad *slope, quad *size)
{
  const bool bernstein = p->basis == BASIS_BERNSTEIN;
  const quad x = u, v = bernstein ? 1 - x : 1;
  *value = *slope = *size = 0;
  for (int k = 0; k <= p->degree; k++) {
    quad low = 1, high = 1, low_slope = 0, high_slope = 0; /* u^k and v^(n-k) with derivatives */
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
    *size += quad_abs(p->c[k] * low * high);
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

static void values_lie_within_bounds(void **state)
{
  (void)state;
  struct random random = {11};
  for (int trial = 0; trial < TRIALS; trial++) {
    struct polynomial p;
    double c[POLYNOMIAL_MAX_DEGREE + 1], error[POLYNOMIAL_MAX_DEGREE + 1];
    random_polynomial(&random, &p, c, error);
    const double u = trial % 3 == 0 ? random_between(&random, -4.0, 4.0) : random_unit(&random);
    const struct polynomial_value found = polynomial_evaluate(&p, u);
    quad value, slope, size;
    quad_values(&p, u, &value, &slope, &size);
    assert_true(quad_abs(found.value - value) <= found.value_error);
    assert_true(quad_abs(found.slope - slope) <= found.slope_error);
    assert_true(found.value_error <= BOUND_LOOSENESS * p.degree * 0x1p-53 * (double)size);
  }
}

/* The bounds of the coefficients go into the bound of the value: a polynomial moved by them stays within. */
static void coefficient_errors_count(void **state)
{
  (void)state;
  struct random random = {12};
  for (int trial = 0; trial < TRIALS; trial++) {
    struct polynomial p;
    double c[POLYNOMIAL_MAX_DEGREE + 1], error[POLYNOMIAL_MAX_DEGREE + 1], moved[POLYNOMIAL_MAX_DEGREE + 1];
    random_polynomial(&random, &p, c, error);
    for (int k = 0; k <= p.degree; k++) {
      error[k] = 1e-9 * fabs(c[k]);
      moved[k] = c[k] + (k % 2 == 0 ? 1.0 : -1.0) * (1.0 - 1e-6) * error[k];
    }
    const double u = random_between(&random, -2.0, 0.0); /* the signs of its powers alternate: the worst case */
    const struct polynomial_value found = polynomial_evaluate(&p, u);
    struct polynomial other = p;
    other.c = moved;
    quad value, slope, size;
    quad_values(&other, u, &value, &slope, &size);
    assert_true(quad_abs(found.value - value) <= found.value_error);
    assert_true(quad_abs(found.slope - slope) <= found.slope_error);
  }
}

static void bases_change_within_bounds(void **state)
{
  (void)state;
  struct random random = {13};
  for (int trial = 0; trial < TRIALS; trial++) {
    struct polynomial p;
    double c[POLYNOMIAL_MAX_DEGREE + 1], error[POLYNOMIAL_MAX_DEGREE + 1];
    double other_c[POLYNOMIAL_MAX_DEGREE + 1], other_error[POLYNOMIAL_MAX_DEGREE + 1];
    random_polynomial(&random, &p, c, error);
    const bool to_power = p.basis == BASIS_BERNSTEIN;
    (to_power ? polynomial_to_power : polynomial_to_bernstein)(&p, other_c, other_error);
    /* The two agree at a point up to what the bounds of the coefficients allow there. */
    const struct polynomial other = {p.degree, to_power ? BASIS_POWER : BASIS_BERNSTEIN, other_c, NULL};
    const double u = random_unit(&random);
    quad value, other_value, slope, size, allowed = 0;
    quad_values(&p, u, &value, &slope, &size);
    quad_values(&other, u, &other_value, &slope, &size);
    struct polynomial bounds = other;
    bounds.c = other_error;
    quad_values(&bounds, u, &allowed, &slope, &size);
    assert_true(quad_abs(value - other_value) <= allowed);
  }
}

/* All ways of giving the unknown signs a value: no change is counted at a zero. */
static void count_by_enumeration(int degree, const double c[], const double error[], int *fewest, int *most)
{
  int open[LARGEST_COUNTED + 1], open_count = 0;
  double sign[LARGEST_COUNTED + 1];
  for (int k = 0; k <= degree; k++) {
    sign[k] = c[k];
    if (fabs(c[k]) <= error[k] && error[k] > 0.0) {
      open[open_count++] = k;
    }
  }
  *fewest = degree + 1;
  *most = 0;
  for (int choice = 0; choice < 1 << open_count; choice++) {
    for (int i = 0; i < open_count; i++) {
      sign[open[i]] = (choice >> i & 1) != 0 ? 1.0 : -1.0;
    }
    int changes = 0;
    double last = 0.0;
    for (int k = 0; k <= degree; k++) {
      if (sign[k] != 0.0) {
        changes += last * sign[k] < 0.0;
        last = sign[k];
      }
    }
    *fewest = changes < *fewest ? changes : *fewest;
    *most = changes > *most ? changes : *most;
  }
}

static void sign_counts_are_sharp(void **state)
{
  (void)state;
  struct random random = {14};
  for (int trial = 0; trial < TRIALS; trial++) {
    const int degree = 1 + (int)(random_bits(&random) % LARGEST_COUNTED);
    double c[LARGEST_COUNTED + 1], error[LARGEST_COUNTED + 1];
    for (int k = 0; k <= degree; k++) {
      c[k] = (double)(random_bits(&random) % 3) - 1.0;
      error[k] = random_bits(&random) % 3 == 0 ? 2.0 : 0.0;
    }
    int fewest, most;
    count_by_enumeration(degree, c, error, &fewest, &most);
    const struct sign_variations found = polynomial_sign_variations(degree, c, error);
    assert_int_equal(found.most, most);
    assert_true(found.fewest <= fewest); /* a lower bound; unknown ends may be counted as they like */
  }
}

static void binomials(void **state)
{
  (void)state;
  for (int n = 0; n <= POLYNOMIAL_MAX_DEGREE; n++) {
    quad row = 0;
    for (int k = 0; k <= n; k++) {
      row += polynomial_binomial(n, k);
    }
    assert_true(quad_abs(row - exp2(n)) <= exp2(n - 52));
  }
  assert_true(polynomial_binomial(18, 9) == 48620.0);
  assert_true(polynomial_binomial(5, 6) == 0.0);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(values_lie_within_bounds),
    cmocka_unit_test(coefficient_errors_count),
    cmocka_unit_test(bases_change_within_bounds),
    cmocka_unit_test(sign_counts_are_sharp),
    cmocka_unit_test(binomials),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
