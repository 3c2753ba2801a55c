/* Aberth's method (eq 9 of the paper) on several real polynomials at once, one a lane: all roots, near enough to the
 * interval [0,1] of u for Newton's process to start from.
 *
 * For a caller who proves by himself what he makes of the roots (as with solver_roots): no radii, no error bounds. The
 * paper's iteration as printed, its items, and roots that are to be the answer, are aberth.c's. Against that:
 * - Polynomials in scaled Bernstein form are taken to powers of y = 2u - 1: all that matters has |y| <= 1, and what
 *   rounding does there (1e-11 of a root mostly, 1e-6 at worst) is little for a start.
 * - The polynomials are real: P and P' by division by a real quadratic, half the products of Horner's scheme.
 * - A sweep moves all roots from the same values, so every difference of two roots serves both.
 * - A root is done when it is a good start, or plainly none for [0,1]; then it stays, and pushes the others.
 *
 * Included by sources that are compiled once per instruction set. A lane's roots do not depend on the other lanes,
 * not in the last bit.
 */
#ifndef PSCN_ALGEBRA_ABERTH_LANES_H
#define PSCN_ALGEBRA_ABERTH_LANES_H

#include <math.h>
#include <stdbool.h>
#include <string.h>

#include "algebra/polynomial.h"
#include "base/lanes.h"

enum { ABERTH_LANES_DEGREE = 18 };

/* All lengths here are choices of speed, in y. A step shorter than this leaves a root, after it, off by about its
 * square: near enough for Newton. */
#define ABERTH_SETTLED 0x1p-8
/* A value this far, and this many of its own steps, away from [-1,1] is not on its way there, ... */
#define ABERTH_MARGIN 0.25
#define ABERTH_AWAY 4.0
/* ... where a step is less than this much of the way: in the first sweeps values are anywhere. */
#define ABERTH_CALM 0.0625
/* Values are kept within this; roots beyond are as good as at infinity. */
#define ABERTH_FAR 0x1p20
/* p[k] is off by some roundings of C(n,k) sum |c|. Highest powers below this much of that are noise, and their roots,
 * far away, of nobody's interest. */
#define ABERTH_NOISE 0x1p-48
/* A real value can only move along the real axis: previous roots are taken off it by this much. */
#define ABERTH_LIFT 0x1p-10

struct aberth_lanes {
  int degree;
  lanes p[ABERTH_LANES_DEGREE + 1];                       /* powers of y; the largest is 1 */
  lanes zr[ABERTH_LANES_DEGREE], zi[ABERTH_LANES_DEGREE]; /* the values */
  lane_mask moving[ABERTH_LANES_DEGREE];                  /* not done */
};

/* 1/x to about 20 bits; 0 where x is above 1e38. */
LANES_INLINE lanes aberth_lanes_inverse(lanes x)
{
#if LANES == 8
  return (lanes)_mm512_cvtps_pd(_mm256_div_ps(_mm256_set1_ps(1), _mm512_cvtpd_ps((__m512d)x)));
#elif LANES == 4
  return (lanes)_mm256_cvtps_pd(_mm_div_ps(_mm_set1_ps(1), _mm256_cvtpd_ps((__m256d)x)));
#else
  return 1 / x;
#endif
}

/* p = sum over k of c[k] (1+y)^k (1-y)^(n-k) in powers of y, and choose[j] = C(n,j). Terms k and n-k are together
 * (1-y^2)^k sum over j of C(n-2k,j) y^j (c[n-k] + c[k]), the difference where j is odd; and 1-y^2 is taken out as in
 * Horner's scheme. */
LANES_INLINE void aberth_lanes_powers(int n, const lanes c[], lanes p[], double choose[])
{
  for (int j = 0; j <= n; j++) p[j] = lanes_all(0), choose[j] = 0;
  choose[0] = 1;
  if (n % 2 == 0) p[0] = c[n / 2];
#pragma GCC unroll 10
  for (int k = (n - 1) / 2; k >= 0; k--) {
    const int m = n - 2 * k;
    const lanes even = c[n - k] + c[k], odd = c[n - k] - c[k];
#pragma GCC unroll 20
    for (int j = m; j > 0; j--) choose[j] += (m > 1 ? 2 : 1) * choose[j - 1] + (m > 1 && j > 1 ? choose[j - 2] : 0);
#pragma GCC unroll 20
    for (int j = m; j > 1; j--) p[j] -= p[j - 2];
#pragma GCC unroll 20
    for (int j = 0; j <= m; j++) p[j] += choose[j] * (j % 2 ? odd : even);
  }
}

/* sum c[k] u^k (1-u)^(n-k) times 2^n in powers of y, scaled. Lanes where that can be done. */
static lane_mask aberth_lanes_set(struct aberth_lanes *a, int n, const lanes c[])
{
  lanes *p = a->p, largest = {0}, sum = {0};
  double choose[ABERTH_LANES_DEGREE + 1];
  a->degree = n;
  if (n == ABERTH_LANES_DEGREE) aberth_lanes_powers(ABERTH_LANES_DEGREE, c, p, choose); /* constants then */
  else aberth_lanes_powers(n, c, p, choose);
  for (int k = 0; k <= n; k++) sum += lanes_abs(c[k]), largest = lanes_max(lanes_abs(p[k]), largest);
  lane_mask noise = ~(lane_mask){0};
  for (int k = n; k > 0 && lanes_any(noise); k--) {
    noise &= lanes_abs(p[k]) <= ABERTH_NOISE * choose[k] * sum;
    p[k] = lanes_select(noise, lanes_all(0), p[k]);
  }
  const lane_mask able = (largest > 0x1p-500) & (largest < 0x1p500);
  const lanes scale = 1 / lanes_select(able, largest, lanes_all(1));
  for (int k = 0; k <= n; k++) p[k] *= scale;
  return able;
}

/* Directions of the start values, turned by the golden angle from one to the next: no two are conjugate, and any few
 * in a row are well spread. */
static const double ABERTH_DIRECTION[ABERTH_LANES_DEGREE][2] = {
  {0.82534080538904664, 0.56463488641755022},   {-0.98998600927849123, 0.14116551077670156},
  {0.63462894056078134, -0.77281699502708934},  {0.054074749483818782, 0.99853689038926463},
  {-0.71437501527928071, -0.69976305814520356}, {0.99944105760351309, 0.033430111821099527},
  {-0.75953844742174226, 0.65046241005008842},  {0.12067896806192339, -0.99269158688260739},
  {0.58156861684679995, 0.81349735334474205},   {-0.97834016512169597, -0.20700367462838129},
  {0.86122656302268608, -0.50822121870710124},  {-0.29174316397287403, 0.95649669433568707},
  {-0.43098190401129188, -0.90236057006875114}, {0.92732845003860065, 0.37424850801173076},
  {-0.93658437361885116, 0.35044216511856013},  {0.45388788756343207, -0.89105880026135498},
  {0.2672187687668745, 0.96363589058249366},    {-0.84796549501763319, -0.53005143076827954},
};

/* Start values on one lane: on circles by Newton's polygon (start.c), with log2 to a tenth. */
static void aberth_lanes_start(struct aberth_lanes *a, unsigned lane)
{
  const int n = a->degree;
  double height[ABERTH_LANES_DEGREE + 1];
  int corner[ABERTH_LANES_DEGREE + 1], corners = 0, i = 0;
  for (int k = 0; k <= n; k++) {
    const double size = fabs(a->p[k][lane]);
    if (!(size > 0x1p-900)) continue;
    uint64_t bits;
    memcpy(&bits, &size, sizeof bits);
    height[k] = (double)bits * 0x1p-52;
    corners = polynomial_add_corner(height, corner, corners, k);
  }
  for (int edge = -1; edge < corners; edge++) {
    const int low = edge < 0 ? 0 : corner[edge], high = edge + 1 < corners ? corner[edge + 1] : n;
    /* roots at 0, and at infinity, where coefficients at the ends vanish */
    double radius = edge < 0 ? 1 / ABERTH_FAR : ABERTH_FAR;
    if (edge >= 0 && edge + 1 < corners) radius = exp2((height[low] - height[high]) / (high - low));
    radius = fmin(fmax(radius, 1 / ABERTH_FAR), ABERTH_FAR);
    for (; i < high; i++) {
      a->zr[i][lane] = radius * ABERTH_DIRECTION[i][0];
      a->zi[i][lane] = radius * ABERTH_DIRECTION[i][1];
    }
  }
}

struct aberth_lanes_value {
  lanes re, im, slope_re, slope_im;
};

/* P and P' at two values each: with P = (y^2 - s y + t) Q + b1 y + b0, where z is a root of the divisor, P(z) = b1 z +
 * b0 and P'(z) = b1 + (2 z - s) Q(z), 2 z - s = 2 i im z. */
LANES_INLINE void aberth_lanes_evaluate(const struct aberth_lanes *a, const int at[2], struct aberth_lanes_value out[2])
{
  const int n = a->degree;
  lanes s[2], t[2], b1[2], b2[2], d1[2], d2[2];
  for (int h = 0; h < 2; h++) {
    const lanes zr = a->zr[at[h]], zi = a->zi[at[h]];
    s[h] = 2 * zr, t[h] = zr * zr + zi * zi;
    b1[h] = b2[h] = d1[h] = d2[h] = lanes_all(0);
  }
  for (int k = n; k > 2; k--) {
    for (int h = 0; h < 2; h++) {
      const lanes b = s[h] * b1[h] + (a->p[k] - t[h] * b2[h]);
      const lanes d = s[h] * d1[h] + (b - t[h] * d2[h]);
      b2[h] = b1[h], b1[h] = b, d2[h] = d1[h], d1[h] = d;
    }
  }
  for (int h = 0; h < 2; h++) {
    const lanes zr = a->zr[at[h]], zi = a->zi[at[h]];
    lanes q = {0}, last = b1[h], before = b2[h];
    if (n >= 2) {
      const lanes b = s[h] * last + (a->p[2] - t[h] * before);
      q = b - t[h] * d2[h]; /* Q(z) = d1 z + q */
      before = last, last = b;
    }
    const lanes first = s[h] * last + (a->p[1] - t[h] * before), rest = a->p[0] - t[h] * last;
    out[h].re = first * zr + rest, out[h].im = first * zi;
    const lanes qr = d1[h] * zr + q, qi = d1[h] * zi, twice = 2 * zi;
    out[h].slope_re = first - twice * qi, out[h].slope_im = twice * qr;
  }
}

/* 1/(z_i - z_j) is (dx - i dy) push; values that fall together do not push. */
LANES_INLINE lanes aberth_lanes_push(lanes dx, lanes dy)
{
  return aberth_lanes_inverse(lanes_max(dx * dx + dy * dy, lanes_all(0x1p-100)));
}

/* sum over j != i of 1/(z_i - z_j) for the roots i of `active`, the terms always in order of j: so a lane's sums do
 * not depend on which roots other lanes still move. */
LANES_INLINE void aberth_lanes_sums(const struct aberth_lanes *a, const int active[], int count,
                                    lanes re[ABERTH_LANES_DEGREE], lanes im[ABERTH_LANES_DEGREE])
{
  const int n = a->degree;
  for (int i = 0; i < n; i++) re[i] = im[i] = lanes_all(0);
  if (2 * count > n) { /* every difference serves both of its roots */
    for (int i = 0; i < n; i++) {
      const lanes zr = a->zr[i], zi = a->zi[i];
      lanes sum_re = re[i], sum_im = im[i];
      for (int j = i + 1; j < n; j++) {
        const lanes dx = zr - a->zr[j], dy = zi - a->zi[j], push = aberth_lanes_push(dx, dy);
        sum_re += dx * push, sum_im -= dy * push;
        re[j] -= dx * push, im[j] += dy * push;
      }
      re[i] = sum_re, im[i] = sum_im;
    }
    return;
  }
  for (int k = 0; k < count; k++) {
    const int i = active[k];
    const lanes zr = a->zr[i], zi = a->zi[i];
    lanes sum_re = {0}, sum_im = {0};
    for (int j = 0; j < n; j++) {
      if (j == i) continue;
      const lanes dx = zr - a->zr[j], dy = zi - a->zi[j], push = aberth_lanes_push(dx, dy);
      sum_re += dx * push, sum_im -= dy * push;
    }
    re[i] = sum_re, im[i] = sum_im;
  }
}

/* The step of eq 9 for one root, -P / (P' - P sum), on the lanes where it moves; then whether it is done. */
LANES_INLINE void aberth_lanes_move(struct aberth_lanes *a, int i, const struct aberth_lanes_value *value, lanes sum_re,
                                    lanes sum_im, double settled)
{
  const lane_mask moving = a->moving[i];
  const lanes zr = a->zr[i], zi = a->zi[i];
  const lanes br = value->slope_re - (value->re * sum_re - value->im * sum_im);
  const lanes bi = value->slope_im - (value->re * sum_im + value->im * sum_re);
  const lanes inverse = -1 / (br * br + bi * bi);
  lanes dx = (value->re * br + value->im * bi) * inverse, dy = (value->im * br - value->re * bi) * inverse;
  const lanes step = lanes_abs(dx) + lanes_abs(dy);
  const lane_mask usable = step < ABERTH_FAR * ABERTH_FAR;
  /* A value that was sent as far as that by chance is sent back by its next step. */
  const lane_mask far = lanes_max(lanes_abs(zr), lanes_abs(zi)) >= ABERTH_FAR;
  /* the pushes cancel P'/P: go somewhere else nearby */
  dx = lanes_select(usable, dx, 0.25 * zr - 0.125 * zi), dy = lanes_select(usable, dy, 0.25 * zi + 0.125 * zr);
  const lanes xr = lanes_max(lanes_min(zr + dx, lanes_all(ABERTH_FAR)), lanes_all(-ABERTH_FAR));
  const lanes xi = lanes_max(lanes_min(zi + dy, lanes_all(ABERTH_FAR)), lanes_all(-ABERTH_FAR));
  a->zr[i] = lanes_select(moving, xr, zr), a->zi[i] = lanes_select(moving, xi, zi);
  const lanes distance = lanes_max(lanes_abs(xi), lanes_abs(xr) - 1);
  const lane_mask away = (step * ABERTH_AWAY < distance - ABERTH_MARGIN) & (step < ABERTH_CALM * distance);
  const lane_mask gone = far & (~usable | (distance >= ABERTH_FAR - 1));
  a->moving[i] = moving & ~(gone | (usable & ((step < settled) | away)));
}

/* Sweeps until all roots are done on the lanes of `wanted`, or `most` sweeps. Returns the lanes where they are. */
static lane_mask aberth_lanes_run(struct aberth_lanes *a, lane_mask wanted, double settled, int most)
{
  const int n = a->degree;
  int active[ABERTH_LANES_DEGREE], count = n;
  for (int i = 0; i < n; i++) active[i] = i, a->moving[i] = wanted;
  for (int sweep = 0; sweep < most && count > 0; sweep++) {
    struct aberth_lanes_value value[ABERTH_LANES_DEGREE + 1];
    lanes re[ABERTH_LANES_DEGREE], im[ABERTH_LANES_DEGREE];
    for (int k = 0; k < count; k += 2) {
      const int at[2] = {active[k], active[k + 1 < count ? k + 1 : k]};
      aberth_lanes_evaluate(a, at, value + k);
    }
    aberth_lanes_sums(a, active, count, re, im);
    int still = 0;
    for (int k = 0; k < count; k++) {
      const int i = active[k];
      aberth_lanes_move(a, i, &value[k], re[i], im[i], settled);
      if (lanes_any(a->moving[i])) active[still++] = i;
    }
    count = still;
  }
  lane_mask done = wanted;
  for (int k = 0; k < count; k++) done &= ~a->moving[active[k]];
  return done;
}

#endif
