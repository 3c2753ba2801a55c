/* Polynomials in two bases: change of basis, eq 11, and Descartes' count of sign changes. */
#include "algebra/polynomial.h"

#include <math.h>
#include <stddef.h>

#include "algebra/evaluation.h"
#include "base/wide.h"

double polynomial_binomial(int n, int k)
{
  if (k < 0 || k > n) return 0.0;
  k = k < n - k ? k : n - k;
  /* Every division is exact. C(64,32) * 64 exceeds 64 bits. */
  unsigned __int128 value = 1;
  for (int i = 1; i <= k; i++) value = value * (unsigned)(n - k + i) / (unsigned)i;
  return (double)value;
}

/* From 1 = u + (1-u): sums over i <= k of c[i] C(n-i, k-i). */
void polynomial_to_bernstein(const struct polynomial *p, double out_c[], double out_error[])
{
  const int n = p->degree;
  for (int k = 0; k <= n; k++) {
    out_c[k] = p->c[k];
    out_error[k] = p->error == NULL ? 0.0 : p->error[k];
    if (p->basis == BASIS_BERNSTEIN) continue;
    double sum = 0.0, size = 0.0, given = 0.0;
    for (int i = 0; i <= k; i++) {
      const double weight = polynomial_binomial(n - i, k - i);
      sum += p->c[i] * weight;
      size += fabs(p->c[i] * weight);
      given += p->error == NULL ? 0.0 : p->error[i] * weight;
    }
    /* One rounding in the binomial, one in the product, k in the sum, and room for the bound's own. A single exact term
     * has none. */
    out_c[k] = sum;
    out_error[k] = (k == 0 ? 0.0 : size * (k + 3) * UNIT_ROUNDOFF) +
                   given * (1.0 + 4 * POLYNOMIAL_MAX_DEGREE * UNIT_ROUNDOFF);
  }
}

/* "unit" of eq 11: beta^-(s-1). */
#define PAPER_UNIT 0x1p-52

/* In `wide`: where the ratio matters, near 1, |P| in double would be lost in its own rounding. */
double polynomial_eq11(const struct polynomial *p, double re, double im)
{
  /* As in evaluation.h, the variable of the terms is z = top/low, or low/top where that is smaller. The common factor
   * of all terms cancels. */
  const bool power = p->basis == BASIS_POWER;
  int n = p->degree;
  while (power && n > 1 && p->c[n] == 0) n--;
  const bool reversed = hypot(re, im) > (power ? 1.0 : hypot(1.0 - re, im));
  const double size = exp2(-ilogb(fmax(1.0, fmax(fabs(re), fabs(im))))); /* keeps the squares in range */
  const wide top_r = (wide)re * size, top_i = (wide)im * size;
  const wide low_r = (power ? (wide)1 : 1 - (wide)re) * size, low_i = power ? (wide)0 : -top_i;
  const wide a = reversed ? low_r : top_r, b = reversed ? low_i : top_i;
  const wide c = reversed ? top_r : low_r, d = reversed ? top_i : low_i;
  const wide square = c * c + d * d;
  const wide zr = (a * c + b * d) / square, zi = (b * c - a * d) / square;
  wide value_r = 0, value_i = 0;
  for (int k = n; k >= 0; k--) {
    const wide next = value_r * zr - value_i * zi + p->c[reversed ? n - k : k];
    value_i = value_r * zi + value_i * zr;
    value_r = next;
  }
  const double modulus = hypot((double)zr, (double)zi);
  wide largest = 0, term = 1;
  for (int k = 0; k <= n; k++, term *= modulus) {
    const wide size_k = term * fabs(p->c[reversed ? n - k : k]);
    largest = size_k > largest ? size_k : largest;
  }
  if (value_r == 0 && value_i == 0) return 0.0; /* even where all terms vanish */
  const double ratio = hypot((double)(value_r / largest), (double)(value_i / largest)) / (n * PAPER_UNIT);
  return isnan(ratio) ? INFINITY : ratio;
}

/* `gap` uncertain signs between two certain ones hide at most gap + 1 changes: an even number if the two are equal, an
 * odd number if they differ. At either end of the sequence they hide at most gap. */
int polynomial_sign_variations(int degree, const double c[], const double error[])
{
  int most = 0, last = 0, gap = 0;
  for (int k = 0; k <= degree; k++) {
    const double bound = error == NULL ? 0.0 : error[k];
    if (c[k] == 0.0 && bound == 0.0) continue; /* a true zero is no sign */
    if (!(fabs(c[k]) > bound)) {
      gap++;
      continue;
    }
    const int sign = c[k] > 0.0 ? 1 : -1;
    if (last == 0) most += gap;
    else if (sign == last) most += gap + gap % 2;
    else most += gap % 2 == 0 ? gap + 1 : gap;
    last = sign;
    gap = 0;
  }
  return most + (last == 0 ? (gap > 0 ? gap - 1 : 0) : gap);
}
