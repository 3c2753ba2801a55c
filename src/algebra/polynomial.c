/* Polynomials in two bases: values with bounds, change of basis, Descartes' count of sign changes.
 *
 * The scaled Bernstein form and its charts x = u/(1-u), 1/x = (1-u)/u: see evaluation.h.
 */
#include "algebra/polynomial.h"

#include <math.h>
#include <stddef.h>
#include <string.h>

#include "algebra/evaluation.h"
#include "base/wide.h"

double polynomial_binomial(int n, int k)
{
  if (k < 0 || k > n) {
    return 0.0;
  }
  k = k < n - k ? k : n - k;
  /* Every division is exact; C(64,32) * 64 passes 64 bits. */
  unsigned __int128 value = 1;
  for (int i = 1; i <= k; i++) {
    value = value * (unsigned)(n - k + i) / (unsigned)i;
  }
  return (double)value;
}

/* Both changes of basis are sums over i <= k of c[i] C(n-i, k-i), to the power basis with alternating signs: the first
 * from 1 = u + (1-u), the second from (1-u)^m multiplied out. */
static void change_basis(const struct polynomial *p, bool alternate, double out_c[], double out_error[])
{
  const int n = p->degree;
  for (int k = 0; k <= n; k++) {
    double sum = 0.0, size = 0.0, given = 0.0;
    for (int i = 0; i <= k; i++) {
      const double weight = polynomial_binomial(n - i, k - i);
      const double term = p->c[i] * weight;
      sum += alternate && (k - i) % 2 != 0 ? -term : term;
      size += fabs(term);
      given += p->error == NULL ? 0.0 : p->error[i] * weight;
    }
    /* One rounding in the binomial, one in the product, k in the sum, and room for the bound's own. A single exact term
     * has none. */
    out_c[k] = sum;
    out_error[k] =
      (k == 0 ? 0.0 : size * (k + 3) * UNIT_ROUNDOFF) + given * (1.0 + 4 * POLYNOMIAL_MAX_DEGREE * UNIT_ROUNDOFF);
  }
}

static void copy_polynomial(const struct polynomial *p, double out_c[], double out_error[])
{
  const size_t count = (size_t)p->degree + 1;
  memcpy(out_c, p->c, count * sizeof out_c[0]);
  if (p->error != NULL) {
    memcpy(out_error, p->error, count * sizeof out_error[0]);
  } else {
    memset(out_error, 0, count * sizeof out_error[0]);
  }
}

void polynomial_to_bernstein(const struct polynomial *p, double out_c[], double out_error[])
{
  if (p->basis == BASIS_BERNSTEIN) {
    copy_polynomial(p, out_c, out_error);
  } else {
    change_basis(p, false, out_c, out_error);
  }
}

void polynomial_to_power(const struct polynomial *p, double out_c[], double out_error[])
{
  if (p->basis == BASIS_POWER) {
    copy_polynomial(p, out_c, out_error);
  } else {
    change_basis(p, true, out_c, out_error);
  }
}

/* base^exponent by squaring: at most 2 exponent roundings. */
static double integer_power(double base, int exponent)
{
  double result = 1.0;
  for (; exponent > 0; exponent /= 2) {
    if (exponent % 2 != 0) {
      result *= base;
    }
    base *= base;
  }
  return result;
}

/* The value in the power basis needs no chart: plain Horner in u, which may overflow to an infinite bound. */
static struct polynomial_value evaluate_power(const struct evaluation *e, double u)
{
  const struct evaluation_real q = evaluation_at_real(e, u, false);
  return (struct polynomial_value){q.value, q.error, q.slope, q.slope_error};
}

/* p(u) = w^n q(z), and p'(u) = w^(n-2) (+- q'(z) +- n w q(z)), where (w,z) = (1-u, u/w) or (u, (1-u)/w), |z| <= 1. */
static struct polynomial_value evaluate_bernstein(const struct evaluation *e, double u)
{
  const int n = e->degree;
  const double v = 1.0 - u;
  const bool reversed = fabs(u) > fabs(v);
  const double w = reversed ? u : v;
  const double z = (reversed ? v : u) / w;
  const struct evaluation_real q = evaluation_at_real(e, z, reversed);
  const double scale = integer_power(w, n);
  const double slope_scale = scale / (w * w);
  const double slope = reversed ? n * w * q.value - q.slope : q.slope - n * w * q.value;

  /* z is off by 2 roundings and w^n by 3 n. The bound polynomial has 2 U |c| |z|^k (2 k + 1), so that 3 of it cover z's
   * share (2 k U |c| |z|^k, and as much for the derivative), its own included; w's is relative. */
  const double relative = (3 * n + 8) * UNIT_ROUNDOFF;
  const double value_error = 3.0 * q.error;
  const double slope_error = 3.0 * (q.slope_error + n * fabs(w) * q.error) +
                             4 * UNIT_ROUNDOFF * (fabs(q.slope) + n * fabs(w * q.value));
  return (struct polynomial_value){
    .value = scale * q.value,
    .value_error = fabs(scale) * (value_error + relative * fabs(q.value)) * BOUND_ROOM,
    .slope = slope_scale * slope,
    .slope_error = fabs(slope_scale) * (slope_error + relative * fabs(slope)) * BOUND_ROOM,
  };
}

struct polynomial_value polynomial_evaluate(const struct polynomial *p, double u)
{
  struct evaluation e;
  evaluation_prepare(p->degree, p->basis, p->c, p->error, &e);
  struct polynomial_value out = p->basis == BASIS_POWER ? evaluate_power(&e, u) : evaluate_bernstein(&e, u);
  if (!isfinite(out.value) || !isfinite(out.value_error)) {
    out.value_error = INFINITY;
  }
  if (!isfinite(out.slope) || !isfinite(out.slope_error)) {
    out.slope_error = INFINITY;
  }
  return out;
}

/* "unit" of eq 11: beta^-(s-1). */
#define PAPER_UNIT 0x1p-52

/* |P| and the largest term in double cannot be told from their own rounding where it matters, near 1: so in `wide`. */
double polynomial_eq11(const struct polynomial *p, double re, double im)
{
  /* As in evaluation.h: the variable of the terms is z = top/low, or low/top where that is smaller; the common factor
   * of all terms cancels. */
  const int n = p->degree;
  const bool power = p->basis == BASIS_POWER;
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

/* `gap` uncertain signs between two certain ones can hide at most gap + 1 changes: an even number of them where the two
 * are equal, an odd number where they differ. At either end of the sequence they can hide gap. */
struct sign_variations polynomial_sign_variations(int degree, const double c[], const double error[])
{
  struct sign_variations out = {0, 0};
  int last = 0, gap = 0;
  for (int k = 0; k <= degree; k++) {
    const double bound = error == NULL ? 0.0 : error[k];
    if (c[k] == 0.0 && bound == 0.0) {
      continue; /* a true zero is no sign */
    }
    if (!(fabs(c[k]) > bound)) {
      gap++;
      continue;
    }
    const int sign = c[k] > 0.0 ? 1 : -1;
    if (last == 0) {
      out.most += gap;
    } else if (sign == last) {
      out.most += gap + gap % 2;
    } else {
      out.fewest++;
      out.most += gap % 2 == 0 ? gap + 1 : gap;
    }
    last = sign;
    gap = 0;
  }
  out.most += last == 0 ? (gap > 0 ? gap - 1 : 0) : gap;
  return out;
}
