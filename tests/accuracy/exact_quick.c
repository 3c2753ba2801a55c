/* See exact_parts.h. The tests are those of exact.c, each with a margin for what the coefficients may be off by. */
#include "accuracy/exact_parts.h"

#include <math.h>

/* The rounding of one operation. */
#define ROUNDING 0x1p-53

/* Bounds are enlarged by this factor for their own rounding, and by this absolute term for underflow: coefficients are
 * at most 1, and products below it are far below every error. */
#define SLACK 1.000001
#define TINY 0x1p-1000

/* A combination whose coefficients are all within this many errors tells nothing. */
#define TELLING 8

/* As in exact.c. */
#define MARGIN 0x1p-30

enum { NEWTON_STEPS = 8 };

static double most_of(const double c[16])
{
  double most = 0;
  for (int n = 0; n < 16; n++) most = fabs(c[n]) > most ? fabs(c[n]) : most;
  return most;
}

static bool one_sign(const double c[16], double error)
{
  double low = c[0], high = c[0];
  for (int n = 1; n < 16; n++) {
    low = c[n] < low ? c[n] : low;
    high = c[n] > high ? c[n] : high;
  }
  return low > error || high < -error;
}

/* x 2^-unit, rounded down or up. */
static double end_of(const fmpz_t x, slong unit, double towards)
{
  slong exponent;
  const double mantissa = fmpz_get_d_2exp(&exponent, x);
  if (mantissa == 0) return 0;
  exponent -= unit;
  const int power = exponent > 3000 ? 3000 : exponent < -3000 ? -3000 : (int)exponent;
  return nextafter(nextafter(ldexp(mantissa, power), towards), towards);
}

/* Starts one net. Its unit is 2 to the power that is returned. */
static slong net_start(const fmpz *exact, double c[16])
{
  slong unit = 0;
  for (int n = 0; n < 16; n++)
    if ((slong)fmpz_bits(&exact[n]) > unit) unit = (slong)fmpz_bits(&exact[n]);
  for (int n = 0; n < 16; n++) {
    slong exponent;
    const double mantissa = fmpz_get_d_2exp(&exponent, &exact[n]); /* truncated to 53 bits */
    c[n] = exponent - unit > -1000 ? ldexp(mantissa, (int)(exponent - unit)) : 0;
  }
  return unit;
}

static double begin_of(const double t[16])
{
  double low = t[0];
  for (int n = 1; n < 16; n++) low = t[n] < low ? t[n] : low;
  return low;
}

slong quick_start(const fmpz (*F)[16], const fmpz *t, const fmpz_t low, const fmpz *high, struct quick *out,
                  double ends[2])
{
  net_start(F[0], out->c[A]), net_start(F[1], out->c[B]);
  const slong unit = net_start(t, out->c[T]);
  for (int f = 0; f < NETS; f++) out->error[f] = 4 * ROUNDING;
  ends[0] = end_of(low, unit, -INFINITY), ends[1] = high ? end_of(high, unit, INFINITY) : INFINITY;
  out->place = (struct place){{0, 0}, {0, 0}};
  out->begin = begin_of(out->c[T]);
  return unit;
}

bool quick_empty(const struct quick *quick, const double ends[2])
{
  if (one_sign(quick->c[A], quick->error[A]) || one_sign(quick->c[B], quick->error[B])) return true;
  double low = INFINITY, high = -INFINITY;
  for (int n = 0; n < 16; n++) {
    low = quick->c[T][n] < low ? quick->c[T][n] : low;
    high = quick->c[T][n] > high ? quick->c[T][n] : high;
  }
  return high + SLACK * quick->error[T] + ROUNDING < ends[0] || low - SLACK * quick->error[T] - ROUNDING > ends[1];
}

/* F = x A - y B, for exact x and y. Returns how far its coefficients may be off. */
static double combine(const struct quick *quick, double x, double y, double F[16])
{
  for (int n = 0; n < 16; n++) F[n] = x * quick->c[A][n] - y * quick->c[B][n];
  return SLACK * (fabs(x) * (quick->error[A] + 4 * ROUNDING * most_of(quick->c[A])) +
                  fabs(y) * (quick->error[B] + 4 * ROUNDING * most_of(quick->c[B]))) +
         TINY;
}

/* See exact.c: |dF/d own| > |dF/d other| on the part and around it. */
static bool dominates(const double F[16], double error, int own_is_v)
{
  double low = INFINITY, high = -INFINITY, other = 0;
  for (int k = 0; k < 12; k++) {
    const int by_u = k, by_v = 4 * (k / 3) + k % 3;
    const double u = F[by_u + 4] - F[by_u], v = F[by_v + 1] - F[by_v], own = own_is_v ? v : u;
    low = own < low ? own : low, high = own > high ? own : high;
    other = fmax(other, fabs(own_is_v ? u : v));
  }
  const double least = low > 0 ? low : -high, largest = fmax(fmax(high, -low), other);
  const double off = SLACK * 2 * error + 4 * ROUNDING * largest; /* of a difference */
  return least - off > SLACK * (other + off + MARGIN * (largest + off));
}

enum quick_verdict quick_depth(const struct quick *quick)
{
  const int *halved = quick->place.halved;
  return halved[0] == QUICK_HALVINGS || halved[1] == QUICK_HALVINGS ? QUICK_SPENT : QUICK_OPEN;
}

enum quick_verdict quick_look(const struct quick *quick, double at[2])
{
  double J[2][2] = {{0}}, F[2][16], error[2];
  for (int f = A; f <= B; f++) {
    const double *c = quick->c[f];
    for (int k = 0; k < 4; k++) J[f][0] += c[12 + k] - c[k], J[f][1] += c[4 * k + 3] - c[4 * k];
  }
  error[0] = combine(quick, J[B][1], J[A][1], F[0]);
  error[1] = combine(quick, J[B][0], J[A][0], F[1]);
  if (one_sign(F[0], error[0]) || one_sign(F[1], error[1])) return QUICK_EMPTY;
  if (dominates(F[0], error[0], 0) && dominates(F[1], error[1], 1)) {
    quick_newton((const double(*)[16])F, at);
    return QUICK_ONE;
  }
  const bool spent = most_of(F[0]) <= TELLING * error[0] || most_of(F[1]) <= TELLING * error[1];
  return spent ? QUICK_SPENT : quick_depth(quick);
}

/* The cubic c[0], c[stride] ... over both halves. */
static void halve(const double *c, int stride, double *low, double *high)
{
  const double c0 = c[0], c1 = c[stride], c2 = c[2 * stride], c3 = c[3 * stride];
  const double p0 = 0.5 * (c0 + c1), p1 = 0.5 * (c1 + c2), p2 = 0.5 * (c2 + c3), q0 = 0.5 * (p0 + p1),
               q1 = 0.5 * (p1 + p2), r = 0.5 * (q0 + q1);
  low[0] = c0, low[stride] = p0, low[2 * stride] = q0, low[3 * stride] = r;
  high[0] = r, high[stride] = q1, high[2 * stride] = p2, high[3 * stride] = c3;
}

void quick_halve(const struct quick *quick, struct quick halves[2])
{
  double change[2] = {0, 0};
  for (int f = A; f <= B; f++) {
    for (int n = 0; n < 12; n++) {
      const int by_v = 4 * (n / 3) + n % 3;
      change[0] = fmax(change[0], fabs(quick->c[f][n + 4] - quick->c[f][n]));
      change[1] = fmax(change[1], fabs(quick->c[f][by_v + 1] - quick->c[f][by_v]));
    }
  }
  const int across_v = change[1] > change[0];
  for (int f = 0; f < NETS; f++) {
    for (int n = 0; n < 4; n++) {
      const int at = across_v ? 4 * n : n;
      halve(&quick->c[f][at], across_v ? 1 : 4, &halves[0].c[f][at], &halves[1].c[f][at]);
    }
    /* three roundings in a row, of numbers no larger than the largest; means of errors are no larger than the errors */
    halves[0].error[f] = halves[1].error[f] = SLACK * quick->error[f] + 4 * ROUNDING * most_of(quick->c[f]);
  }
  for (int k = 0; k < 2; k++) {
    halves[k].begin = begin_of(halves[k].c[T]);
    halves[k].place = quick->place;
    halves[k].place.halved[across_v]++;
    halves[k].place.corner[across_v] = 2 * quick->place.corner[across_v] + (uint64_t)k;
  }
}

/* The bicubic c[16] over [0,1]^2 at x, and its derivatives. */
static void jet(const double c[16], const double x[2], double out[3])
{
  double w[2][4], dw[2][4];
  for (int k = 0; k < 2; k++) {
    const double t = x[k], s = 1 - t;
    w[k][0] = s * s * s, w[k][1] = 3 * s * s * t, w[k][2] = 3 * s * t * t, w[k][3] = t * t * t;
    dw[k][0] = -3 * s * s, dw[k][1] = 3 * s * (s - 2 * t), dw[k][2] = 3 * t * (2 * s - t), dw[k][3] = 3 * t * t;
  }
  out[0] = out[1] = out[2] = 0;
  for (int n = 0; n < 16; n++) {
    out[0] += w[0][n / 4] * w[1][n % 4] * c[n];
    out[1] += dw[0][n / 4] * w[1][n % 4] * c[n], out[2] += w[0][n / 4] * dw[1][n % 4] * c[n];
  }
}

bool quick_newton(const double F[2][16], double at[2])
{
  at[0] = at[1] = 0.5;
  for (int n = 0; n < NEWTON_STEPS; n++) {
    double f[3], g[3];
    jet(F[0], at, f), jet(F[1], at, g);
    const double determinant = f[1] * g[2] - f[2] * g[1];
    at[0] -= (g[2] * f[0] - f[2] * g[0]) / determinant, at[1] -= (f[1] * g[0] - g[1] * f[0]) / determinant;
  }
  return fabs(at[0] - 0.5) <= 1 && fabs(at[1] - 0.5) <= 1;
}
