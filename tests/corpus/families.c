/* The families. If roots are chosen, the coefficients are products in double, and the polynomial meant is the rounded
 * one. */
#include "corpus/families.h"

#include <math.h>
#include <stdbool.h>
#include <string.h>

const char *family_name(enum family family)
{
  static const char *const names[FAMILIES + 1] = {"0 decades", "10 decades", "20 decades", "60 decades",
                                                  "clusters",  "multiple",   "chebyshev",  "mignotte",
                                                  "wilkinson", "sparse",     "corpus"};
  return names[family];
}

/* 0, ..., count - 1 */
static int pick(struct random *random, int count) { return (int)(random_bits(random) % (uint64_t)count); }

static int draw_decades(struct random *random, double decades, double c[])
{
  const int degree = 1 + pick(random, 24);
  for (int k = 0; k <= degree; k++)
    c[k] = random_between(random, -1, 1) * pow(10, random_between(random, -decades / 2, decades / 2));
  return degree;
}

/* Multiplies c of degree n by x - root. */
static int times_linear(int n, double c[], double root)
{
  c[n + 1] = c[n];
  for (int k = n; k > 0; k--) c[k] = c[k - 1] - root * c[k];
  c[0] *= -root;
  return n + 1;
}

/* Multiplies c of degree n by x^2 - sum x + product. */
static int times_quadratic(int n, double c[], double sum, double product)
{
  c[n + 1] = c[n + 2] = 0;
  for (int k = n + 2; k >= 0; k--) c[k] = product * c[k] - (k > 0 ? sum * c[k - 1] : 0) + (k > 1 ? c[k - 2] : 0);
  return n + 2;
}

static int draw_clusters(struct random *random, double c[])
{
  const int most = 4 + pick(random, 15);
  int n = 0;
  c[0] = 1;
  while (n < most) {
    const double size = pow(10, random_between(random, -3, 3)), spread = pow(10, random_between(random, -12, -1));
    const double re = random_between(random, -1, 1) * size, im = random_between(random, -1, 1) * size;
    const bool real = pick(random, 2) == 0;
    for (int k = 1 + pick(random, 4); k > 0 && n < most; k--) {
      const double x = re + size * spread * random_between(random, -1, 1);
      const double y = im + size * spread * random_between(random, -1, 1);
      n = real ? times_linear(n, c, x) : times_quadratic(n, c, 2 * x, x * x + y * y);
    }
  }
  return n;
}

static int draw_multiple(struct random *random, double c[])
{
  const int most = 3 + pick(random, 10);
  int n = 0;
  c[0] = 1;
  while (n < most) {
    const double root = (pick(random, 17) - 8) / 8.0;
    const bool real = pick(random, 4) != 0;
    for (int k = 1 + pick(random, 4); k > 0 && n < most; k--)
      n = real ? times_linear(n, c, root) : times_quadratic(n, c, 2 * root, root * root + 0.25);
  }
  return n;
}

static int draw_chebyshev(struct random *random, double c[])
{
  const int degree = 2 + pick(random, 29);
  const double a = pow(2, pick(random, 5) - 2), b = pick(random, 2) ? 0 : random_between(random, -1, 1);
  double before[POLYNOMIAL_MAX_DEGREE + 1] = {1}, now[POLYNOMIAL_MAX_DEGREE + 1] = {b, a};
  for (int n = 1; n < degree; n++) { /* T[n+1] = 2 (a x + b) T[n] - T[n-1] */
    double next[POLYNOMIAL_MAX_DEGREE + 1] = {0};
    for (int k = 0; k <= n + 1; k++)
      next[k] = 2 * b * (k <= n ? now[k] : 0) + (k > 0 ? 2 * a * now[k - 1] : 0) - (k < n ? before[k] : 0);
    memcpy(before, now, sizeof before);
    memcpy(now, next, sizeof now);
  }
  memcpy(c, now, sizeof now);
  return degree;
}

static int draw_mignotte(struct random *random, double c[])
{
  const int degree = 3 + pick(random, 22);
  const double a = 2 + pick(random, 999);
  memset(c, 0, sizeof *c * (size_t)(degree + 1));
  c[0] = -2, c[1] = 4 * a, c[2] = -2 * a * a;
  c[degree] += 1;
  return degree;
}

static int draw_wilkinson(struct random *random, double c[])
{
  const int most = 2 + pick(random, 19);
  const double step = pow(10, random_between(random, -2, 2));
  const double from = pick(random, 2) ? 0 : random_between(random, -9, 9);
  int n = 0;
  c[0] = 1;
  while (n < most) n = times_linear(n, c, step * (from + n + 1));
  return n;
}

static int draw_sparse(struct random *random, double c[])
{
  const int degree = 1 + pick(random, POLYNOMIAL_MAX_DEGREE);
  memset(c, 0, sizeof *c * (size_t)(degree + 1));
  for (int term = 2 + pick(random, 4); term > 0; term--)
    c[pick(random, degree + 1)] = random_between(random, -1, 1) * pow(10, random_between(random, -9, 9));
  c[1 + pick(random, degree)] = 1;
  return degree;
}

int family_draw(enum family family, struct random *random, double c[POLYNOMIAL_MAX_DEGREE + 1])
{
  switch (family) {
  case FAMILY_DECADES_0: return draw_decades(random, 0, c);
  case FAMILY_DECADES_10: return draw_decades(random, 10, c);
  case FAMILY_DECADES_20: return draw_decades(random, 20, c);
  case FAMILY_DECADES_60: return draw_decades(random, 60, c);
  case FAMILY_CLUSTERS: return draw_clusters(random, c);
  case FAMILY_MULTIPLE: return draw_multiple(random, c);
  case FAMILY_CHEBYSHEV: return draw_chebyshev(random, c);
  case FAMILY_MIGNOTTE: return draw_mignotte(random, c);
  case FAMILY_WILKINSON: return draw_wilkinson(random, c);
  default: return draw_sparse(random, c);
  }
}
