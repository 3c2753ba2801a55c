/* Sylvester's determinant with polynomial entries, by Laplace expansion along the rows of the first polynomial. */
#include "algebra/sylvester.h"

#include <string.h>

enum { MAX_N = 3, MAX_MINOR_DEGREE = 9 };

/* The entry of row r (of n), column c (of 2n) of one half: coefficient v^(n - (c - r)), as a polynomial in u; NULL
 * for 0. */
static const double *entry(int n, int r, int c, const double *A)
{
  const int j = n - (c - r);
  return j < 0 || j > n ? NULL : A + j;
}

/* out[0..mn] = the n x n minor of one half on the given columns. */
static void minor(int m, int n, const double *A, const int column[MAX_N], double out[MAX_MINOR_DEGREE + 1])
{
  static const int permutation[6][MAX_N] = {{0, 1, 2}, {1, 0, 2}, {1, 2, 0}, {2, 1, 0}, {2, 0, 1}, {0, 2, 1}};
  memset(out, 0, sizeof(double) * (MAX_MINOR_DEGREE + 1));
  const int factorial = n == 1 ? 1 : n == 2 ? 2 : 6;
  for (int s = 0; s < factorial; s++) {
    double product[MAX_MINOR_DEGREE + 1] = {s % 2 ? -1.0 : 1.0};
    int degree = 0;
    for (int r = 0; r < n; r++) {
      const double *e = entry(n, r, column[permutation[s][r]], A);
      double next[MAX_MINOR_DEGREE + 1] = {0};
      if (e)
        for (int x = 0; x <= degree; x++)
          for (int i = 0; i <= m; i++) next[x + i] += product[x] * e[4 * i];
      degree += m;
      memcpy(product, next, sizeof product);
    }
    for (int x = 0; x <= degree; x++) out[x] += product[x];
  }
}

void sylvester_determinant(int m, int n, const double A[16], const double B[16], double c[19])
{
  memset(c, 0, sizeof(double) * (size_t)(2 * m * n + 1));
  for (unsigned set = 0; set < 1u << (2 * n); set++) {
    if (__builtin_popcount(set) != n) continue;
    int upper[MAX_N], lower[MAX_N], u = 0, l = 0, sum = 0;
    for (int k = 0; k < 2 * n; k++)
      if (set >> k & 1) upper[u++] = k, sum += k;
      else lower[l++] = k;
    double p[MAX_MINOR_DEGREE + 1], q[MAX_MINOR_DEGREE + 1];
    minor(m, n, A, upper, p);
    minor(m, n, B, lower, q);
    const double sign = (sum - n * (n - 1) / 2) % 2 ? -1 : 1;
    for (int x = 0; x <= m * n; x++)
      for (int y = 0; y <= m * n; y++) c[x + y] += sign * p[x] * q[y];
  }
}
