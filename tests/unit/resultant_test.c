/* Resultants: Bezout's against Sylvester's, against planted roots, and the error bound that the intersector relies
 * on. */
#include <math.h>
#include <string.h>

#include "algebra/sylvester.h"
#include "base/lanes.h"
#include "intersect/resultant_error.h"

#include "cmocka_test.h"
#include "random.h"
#include "reference/quad.h"

#define BEZOUT_REAL double
#define BEZOUT_NAME(name) bezout_##name
#include "algebra/bezout.h"
#undef BEZOUT_REAL
#undef BEZOUT_NAME
#define BEZOUT_REAL lanes
#define BEZOUT_NAME(name) bezout_lanes_##name
#include "algebra/bezout.h"
#include "worse.h"

enum { SEED = 20240504, CASES = 1000, TERMS = 19 };

static double choose(int n, int k)
{
  double c = 1;
  for (int i = 1; i <= k; i++) c = c * (n - k + i) / i;
  return c;
}

static void random_net(struct random *random, int m, int n, double net[16])
{
  for (int k = 0; k < 16; k++) net[k] = NAN; /* what lies outside the degree may not be read */
  for (int i = 0; i <= m; i++)
    for (int j = 0; j <= n; j++) net[4 * i + j] = random_between(random, -1, 1);
}

static double largest(const double net[16], int m, int n)
{
  double size = 0;
  for (int i = 0; i <= m; i++)
    for (int j = 0; j <= n; j++) size = fmax(size, fabs(net[4 * i + j]));
  return size;
}

/* ---- the resultant in quadruple precision, by another way ---- */

static void quad_minor(int m, int k, int l, const quad A[16], const quad B[16], quad out[TERMS])
{
  for (int e = 0; e < TERMS; e++) out[e] = 0;
  for (int i = 0; i <= m; i++)
    for (int h = 0; h <= m; h++) out[i + h] += A[4 * i + k] * B[4 * h + l] - A[4 * i + l] * B[4 * h + k];
}

static void quad_add_product(quad sign, const quad x[TERMS], const quad y[TERMS], quad out[TERMS])
{
  for (int i = 0; i < TERMS; i++)
    for (int h = 0; i + h < TERMS; h++) out[i + h] += sign * x[i] * y[h];
}

/* The scaled Bernstein coefficients of r for plain Bernstein nets, by Leibniz's formula on the symmetric matrix. */
static void quad_resultant(int m, int n, const quad a[16], const quad b[16], quad c[TERMS])
{
  quad A[16], B[16], M[3][3][TERMS], t[TERMS];
  for (int i = 0; i <= m; i++) {
    for (int j = 0; j <= n; j++) {
      const quad s = (quad)choose(m, i) * choose(n, j);
      A[4 * i + j] = s * a[4 * i + j], B[4 * i + j] = s * b[4 * i + j];
    }
  }
  for (int r = 0; r < n; r++) {
    for (int k = 0; k < n; k++) {
      /* Entry (r,k): the sum of the minors [x y] with x + y = r + k + 1, x <= min(r,k) < y. */
      for (int e = 0; e < TERMS; e++) M[r][k][e] = 0;
      for (int x = 0; x <= (r < k ? r : k); x++) {
        const int y = r + k + 1 - x;
        if (y > n) continue;
        quad_minor(m, x, y, A, B, t);
        for (int e = 0; e < TERMS; e++) M[r][k][e] += t[e];
      }
    }
  }
  static const int permutation[6][3] = {{0, 1, 2}, {1, 0, 2}, {1, 2, 0}, {2, 1, 0}, {2, 0, 1}, {0, 2, 1}};
  for (int e = 0; e < TERMS; e++) c[e] = 0;
  for (int s = 0; s < (n == 1 ? 1 : n == 2 ? 2 : 6); s++) {
    quad product[TERMS] = {s % 2 ? -1 : 1}, next[TERMS];
    for (int r = 0; r < n; r++) {
      memset(next, 0, sizeof next);
      quad_add_product(1, product, M[r][permutation[s][r]], next);
      memcpy(product, next, sizeof product);
    }
    for (int e = 0; e < TERMS; e++) c[e] += product[e];
  }
}

/* ---- */

TEST(bezout_is_sylvester_up_to_sign)
{
  struct random random = {SEED};
  for (int m = 1; m <= 3; m++) {
    for (int n = 1; n <= 3; n++) {
      int sign = 0;
      for (int k = 0; k < CASES / 10; k++) {
        double A[16], B[16], x[TERMS], y[TERMS];
        random_net(&random, m, n, A);
        random_net(&random, m, n, B);
        bezout_determinant(m, n, A, B, x); /* the same convolutions serve scaled Bernstein and power coefficients */
        sylvester_determinant(m, n, A, B, y);
        double size = 0, same = 0, opposite = 0;
        for (int e = 0; e <= 2 * m * n; e++) {
          size = fmax(size, fabs(x[e]));
          same = fmax(same, fabs(x[e] - y[e])), opposite = fmax(opposite, fabs(x[e] + y[e]));
        }
        const int now = same < opposite ? 1 : -1;
        assert_true(size > 0 && fmin(same, opposite) <= 1e-11 * size);
        assert_true(sign == 0 || now == sign); /* one sign for each (m,n), whatever the nets */
        sign = now;
      }
    }
  }
}

/* The nets of a case: plain random ones, and some that strain a bound: signs that add up, entries of very different
 * size, a and b nearly proportional, nets of a flat patch seen edge-on. */
static void strained_nets(struct random *random, int kind, int m, int n, double a[16], double b[16])
{
  random_net(random, m, n, a);
  random_net(random, m, n, b);
  for (int i = 0; i <= m; i++) {
    for (int j = 0; j <= n; j++) {
      double *x = &a[4 * i + j], *y = &b[4 * i + j];
      if (kind == 1) *x = copysign(1, *x), *y = copysign(1, *y);
      if (kind == 2) *x = copysign(1, *x) * (1 - 0x1p-52 * (double)(random_bits(random) % 999));
      if (kind == 2) *y = copysign(1, *y) * (1 - 0x1p-52 * (double)(random_bits(random) % 999));
      if (kind == 3) *x = ldexp(*x, -(int)(random_bits(random) % 40)), *y = ldexp(*y, -(int)(random_bits(random) % 40));
      if (kind == 4) *y = *x * (1 + 1e-3 * *y);
      if (kind == 5) *x = (i - 0.5 * m) + 1e-6 * *x, *y = (i - 0.4 * m) + 1e-6 * *y;
      if (kind == 6) *x = (j % 2 ? 1 : -1) * (1 - 1e-3 * fabs(*x)), *y = (j / 2 % 2 ? 1 : -1) * (1 - 1e-3 * fabs(*y));
      if (kind == 7) *x = j == 0 ? 1 : j == n ? -1 : *x, *y = j == 0 || j == n ? 1 : *y;
    }
  }
}
enum { KINDS = 8 };

/* resultant_error.h: a Bernstein coefficient of r is at most RESULTANT_WEIGHT (alpha beta)^n, and its error at most
 * that times the roundings and the nets' own error. Both must hold. The largest ratios are printed: a bound a million
 * times too large would be true and useless. */
TEST(the_bound_of_r_holds)
{
  struct random random = {SEED + 2};
  for (int n = 1; n <= 3; n++) {
    double size_ratio = 0, error_ratio = 0, blurred_ratio = 0;
    for (int m = 1; m <= 3; m++) {
      for (int k = 0; k < CASES; k++) {
        double a[16], b[16], c[TERMS];
        strained_nets(&random, k % KINDS, m, n, a, b);
        const double alpha = largest(a, m, n), beta = largest(b, m, n);
        const double weight = RESULTANT_WEIGHT[n] * pow(alpha * beta, n);
        bezout_resultant(m, n, a, b, c);
        quad qa[16], qb[16], exact[TERMS], blurred[TERMS];
        const double error = 0x1p-44; /* of the given nets, at most */
        for (int e = 0; e < 16; e++) qa[e] = a[e], qb[e] = b[e];
        quad_resultant(m, n, qa, qb, exact);
        for (int e = 0; e < 16; e++) {
          qa[e] += random_bits(&random) % 2 ? (quad)error : -(quad)error;
          qb[e] += random_bits(&random) % 2 ? (quad)error : -(quad)error;
        }
        quad_resultant(m, n, qa, qb, blurred);
        for (int e = 0; e <= 2 * m * n; e++) {
          const double binomial = choose(2 * m * n, e);
          const double rounding = weight * RESULTANT_ROUNDINGS * UNIT_ROUNDOFF;
          const double all = RESULTANT_ERROR(n, pow(alpha * beta, n), alpha, beta, error);
          size_ratio = worse(size_ratio, fabs((double)exact[e]) / binomial / weight);
          error_ratio = worse(error_ratio, fabs((double)(exact[e] - (quad)c[e])) / binomial / rounding);
          blurred_ratio = worse(blurred_ratio, fabs((double)(blurred[e] - (quad)c[e])) / binomial / all);
        }
      }
    }
    print_message("n = %d: coefficient / bound %.3g, rounding / bound %.3g, with nets off %.3g\n", n, size_ratio,
                  error_ratio, blurred_ratio);
    assert_true(size_ratio <= 1 && error_ratio <= 1 && blurred_ratio <= 1);
    assert_true(size_ratio > 1e-3); /* not vacuous: some net comes near */
    assert_true(error_ratio > 1e-5);
  }
}

/* Subtracts from the net a multiple of the weights so that it vanishes at (u,v), in quadruple precision rounded
 * once. */
static void plant(int m, int n, double u, double v, double net[16])
{
  quad value = 0, norm = 0;
  quad w[16] = {0};
  for (int i = 0; i <= m; i++) {
    for (int j = 0; j <= n; j++) {
      quad x = (quad)choose(m, i) * choose(n, j);
      for (int k = 0; k < m; k++) x *= k < i ? (quad)u : 1 - (quad)u;
      for (int k = 0; k < n; k++) x *= k < j ? (quad)v : 1 - (quad)v;
      w[4 * i + j] = x;
      value += x * net[4 * i + j], norm += x * x;
    }
  }
  for (int k = 0; k < 16; k++)
    if (w[k] != 0) net[k] = (double)(net[k] - value / norm * w[k]);
}

/* Nets with a common root (u,v): r(u) is 0 within the bound, and the null vector at u gives v. */
TEST(a_common_root_is_a_root_of_r)
{
  struct random random = {SEED + 3};
  for (int n = 1; n <= 3; n++) {
    double worst_r = 0, worst_v = 0, typical_v = 0;
    int counted = 0;
    for (int k = 0; k < CASES; k++) {
      const int m = 1 + k % 3;
      double a[16], b[16], c[TERMS];
      random_net(&random, m, n, a);
      random_net(&random, m, n, b);
      const double u = k % 7 == 0   ? 0
                       : k % 7 == 1 ? 1
                                    : random_unit(&random),
                   v = k % 5 == 0 ? 0 : random_unit(&random);
      plant(m, n, u, v, a);
      plant(m, n, u, v, b);
      const double alpha = largest(a, m, n), beta = largest(b, m, n);
      bezout_resultant(m, n, a, b, c);
      quad value = 0;
      for (int e = 0; e <= 2 * m * n; e++) {
        quad term = c[e];
        for (int f = 0; f < 2 * m * n; f++) term *= f < e ? (quad)u : 1 - (quad)u;
        value += term;
      }
      /* Planting rounds each coefficient once. The weights sum to 1, so a coefficient's bound also bounds the value. */
      const double error = fmax(alpha, beta) * UNIT_ROUNDOFF;
      const double bound = RESULTANT_ERROR(n, pow(alpha * beta, n), alpha, beta, error);
      worst_r = worse(worst_r, fabs((double)value) / bound);
      double p[4] = {0}, q[4] = {0}, num[2], den[2], better;
      for (int i = 0; i <= m; i++)
        for (int j = 0; j <= n; j++) {
          const double w = choose(m, i) * pow(u, i) * pow(1 - u, m - i);
          p[j] += w * a[4 * i + j], q[j] += w * b[4 * i + j];
        }
      bezout_null_vector(n, p, q, num, den, &better);
      const int row = better > 0 ? 0 : 1;
      const double off = fabs(num[row] / den[row] - v);
      worst_v = fmax(worst_v, off), typical_v += off < 1e-11, counted++;
      /* Both ways give the same root, unless a denominator nearly vanishes. */
      if (fabs(den[0]) > 0.1 && fabs(den[1]) > 0.1) assert_true(fabs(num[0] / den[0] - num[1] / den[1]) < 1e-10);
    }
    print_message("n = %d: r(u) / bound %.3g; null vector off %.3g at worst, below 1e-11 on %.2f %%\n", n, worst_r,
                  worst_v, 100 * typical_v / counted);
    assert_true(worst_r <= 1);
    assert_true(typical_v > 0.98 * counted);
  }
}

TEST(lanes_equal_doubles)
{
  struct random random = {SEED + 4};
  for (int m = 1; m <= 3; m++) {
    for (int n = 1; n <= 3; n++) {
      for (int k = 0; k < 50; k++) {
        double a[LANES][16], b[LANES][16], c[TERMS], num[2], den[2], better;
        lanes la[16], lb[16], lc[TERMS], p[4], q[4], lnum[2], lden[2], lbetter;
        for (int l = 0; l < LANES; l++) {
          random_net(&random, m, n, a[l]);
          random_net(&random, m, n, b[l]);
          for (int e = 0; e < 16; e++) la[e][l] = a[l][e], lb[e][l] = b[l][e];
        }
        bezout_lanes_resultant(m, n, la, lb, lc);
        for (int j = 0; j <= n; j++) p[j] = la[j], q[j] = lb[j];
        bezout_lanes_null_vector(n, p, q, lnum, lden, &lbetter);
        for (int l = 0; l < LANES; l++) {
          bezout_resultant(m, n, a[l], b[l], c);
          for (int e = 0; e <= 2 * m * n; e++) assert_true(c[e] == lc[e][l]);
          bezout_null_vector(n, a[l], b[l], num, den, &better);
          for (int r = 0; r < 2; r++) assert_true(num[r] == lnum[r][l] && den[r] == lden[r][l]);
          assert_true(better == lbetter[l]);
        }
      }
    }
  }
}
