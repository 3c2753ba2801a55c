/* The methods that find all roots (eq 7 to 9 of the paper, and Weierstrass's) on several real polynomials at once, one
 * per lane. They find the roots near enough to the interval [0,1] of u to start Newton's method on something else.
 *
 * For a caller who proves by himself what he makes of the roots (as with solver_roots): there are no radii and no error
 * bounds. The paper's iterations as printed, their items, and roots that are to be the answer, are in aberth.c,
 * deflation.c and durand_kerner.c. The differences to those are:
 * - Polynomials in scaled Bernstein form are converted to powers of y = 2u - 1. All roots that matter have |y| <= 1,
 *   and the rounding there (mostly 1e-11 of a root, 1e-6 at worst) is small for a start value.
 * - The polynomials are real. P, P' and P'' come from division by a real quadratic, with half the products of Horner's
 *   scheme.
 * - A sweep moves all roots from the same values, so every difference of two roots serves both.
 * - A root is done when it is a good start or, where all move at once, plainly not on its way to [0,1]. It then stays,
 *   and pushes the others. All are done when [0,1] has as many roots as the caller says that there can be.
 * - One root after the other is Aberth's iteration with one moving value, pushed by the roots before it. Dividing P by
 *   those subtracts sum over j of 1/(z - z_j) from P'/P (implicit deflation; H. J. Maehly, "Zur iterativen Auflösung
 *   algebraischer Gleichungen", 1954), and no rounding error of a root is passed on.
 *
 * Included by sources that are compiled once per instruction set. A lane's roots do not depend on the other lanes, not
 * even in the last bit.
 */
#ifndef PSCN_ALGEBRA_ROOTS_LANES_H
#define PSCN_ALGEBRA_ROOTS_LANES_H

#include <math.h>

#include "algebra/complex_number.h"
#include "algebra/polynomial.h"
#include "algebra/solver.h"
#include "base/lanes.h"
#include "base/real.h"

enum { ROOTS_LANES_DEGREE = 18 };

/* Values are kept within this; roots beyond count as infinite. */
#define ROOTS_FAR 0x1p20
/* p[k] is off by some roundings of C(n,k) sum |c|. Highest powers below this fraction of that are noise, and their far
 * roots are of no interest. */
#define ROOTS_NOISE 0x1p-48

/* All lengths here are choices of speed, in y. A step shorter than this leaves a root with an error of about the step's
 * square: near enough for Newton's method. */
#define ROOTS_SETTLED 0x1p-8
/* A value farther than this, plus this many of its own steps, from [-1,1] is not on its way there, ... */
#define ROOTS_MARGIN 0.25
#define ROOTS_AWAY 4.0
/* ... if a step is less than this fraction of the way: in the first sweeps values are anywhere. */
#define ROOTS_CALM 0.0625
/* A real value can only move along the real axis, so previous roots are moved off it by this much. A value that has
 * come as near to it by itself is real. */
#define ROOTS_LIFT 0x1p-10
/* One root after the other: no step is longer than this many times 1 + |z|. Where P' nearly vanishes, the way back
 * would take hundreds of steps. */
#define ROOTS_LONGEST 2.0
/* A value that has not come to rest after so many steps goes round in a circle. It is turned about 0 by one radian. */
enum { ROOTS_PATIENCE = 24 };
/* All at once, roots are mostly found after some ten sweeps. If after this many they are not, some are multiple, and
 * boxes and the last resort are done sooner. */
enum { ROOTS_SWEEPS = 48 };

/* ---- polynomials and start values ---- */

struct roots_lanes {
  enum solver_lanes method;
  int degree;
  lanes p[ROOTS_LANES_DEGREE + 1];                      /* powers of y; the largest is 1 */
  lanes zr[ROOTS_LANES_DEGREE], zi[ROOTS_LANES_DEGREE]; /* the values */
  lane_mask moving[ROOTS_LANES_DEGREE];                 /* not found */
  lane_mask seeking;                                    /* lanes that are not done */
  lanes enough;                                         /* real roots in [-1,1] that are not found, at most */
  lanes sweeps;                                         /* work so far; a sweep over all roots counts degree^2 */
};

/* p = sum over k of c[k] (1+y)^k (1-y)^(n-k) in powers of y, and choose[j] = C(n,j). Terms k and n-k together are
 * (1-y^2)^k sum over j of C(n-2k,j) y^j (c[n-k] + c[k]), with the difference where j is odd. 1-y^2 is taken out as in
 * Horner's scheme. */
LANES_INLINE void roots_lanes_powers(int n, const lanes c[], lanes p[], double choose[])
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

/* Scales p[0..n], each of which is off by some roundings of choose[k] sum. Returns the lanes where that is possible. */
LANES_INLINE lane_mask roots_lanes_scale(struct roots_lanes *a, int n, const double choose[], lanes sum)
{
  lanes *p = a->p, largest = {0};
  lane_mask noise = ~(lane_mask){0};
  a->degree = n;
  for (int k = 0; k <= n; k++) largest = lanes_max(lanes_abs(p[k]), largest);
  for (int k = n; k > 0 && lanes_any(noise); k--) {
    noise &= lanes_abs(p[k]) <= ROOTS_NOISE * choose[k] * sum;
    p[k] = lanes_select(noise, lanes_all(0), p[k]);
  }
  const lane_mask able = (largest > 0x1p-500) & (largest < 0x1p500);
  const lanes scale = 1 / lanes_select(able, largest, lanes_all(1));
  for (int k = 0; k <= n; k++) p[k] *= scale;
  return able;
}

/* Sets p to sum c[k] u^k (1-u)^(n-k) times 2^n in powers of y, scaled. Returns the lanes where that is possible. */
static lane_mask roots_lanes_set(struct roots_lanes *a, int n, const lanes c[])
{
  lanes sum = {0};
  double choose[ROOTS_LANES_DEGREE + 1];
  if (n == ROOTS_LANES_DEGREE) roots_lanes_powers(ROOTS_LANES_DEGREE, c, a->p, choose); /* with constant bounds */
  else roots_lanes_powers(n, c, a->p, choose);
  for (int k = 0; k <= n; k++) sum += lanes_abs(c[k]);
  return roots_lanes_scale(a, n, choose, sum);
}

/* Sets p to q0 + q1 y + q2 y^2, scaled. Returns the lanes where that is possible. */
static lane_mask roots_lanes_set_quadratic(struct roots_lanes *a, lanes q0, lanes q1, lanes q2)
{
  a->p[0] = q0, a->p[1] = q1, a->p[2] = q2;
  return roots_lanes_scale(a, 2, (double[3]){1, 1, 1}, lanes_abs(q0) + (lanes_abs(q1) + lanes_abs(q2)));
}

/* Directions of the start values, each turned from the one before by the golden angle: no two are conjugate, and any
 * few in a row are well spread. */
static const double ROOTS_DIRECTION[ROOTS_LANES_DEGREE][2] = {
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

/* Start values on one lane, on circles by Newton's polygon (start.c), with log2 to a tenth. */
static void roots_lanes_start_lane(struct roots_lanes *a, unsigned lane)
{
  const int n = a->degree;
  double height[ROOTS_LANES_DEGREE + 1];
  int corner[ROOTS_LANES_DEGREE + 1], corners = 0, i = 0;
  for (int k = 0; k <= n; k++) {
    const double size = fabs(a->p[k][lane]);
    if (!(size > 0x1p-900)) continue;
    height[k] = (double)real_bits(size) * 0x1p-52;
    corners = polynomial_add_corner(height, corner, corners, k);
  }
  for (int edge = -1; edge < corners; edge++) {
    const int low = edge < 0 ? 0 : corner[edge], high = edge + 1 < corners ? corner[edge + 1] : n;
    /* roots at 0 and at infinity, where coefficients at the ends vanish */
    double radius = edge < 0 ? 1 / ROOTS_FAR : ROOTS_FAR;
    if (edge >= 0 && edge + 1 < corners) radius = exp2((height[low] - height[high]) / (high - low));
    radius = fmin(fmax(radius, 1 / ROOTS_FAR), ROOTS_FAR);
    for (; i < high; i++) {
      a->zr[i][lane] = radius * ROOTS_DIRECTION[i][0];
      a->zi[i][lane] = radius * ROOTS_DIRECTION[i][1];
    }
  }
}

/* Start values of degree 2, on all lanes. Where the corner of Newton's polygon is so sharp that both roots are real,
 * they are the real roots of its edges; otherwise they are on the polygon's only circle. */
static void roots_lanes_start_quadratic(struct roots_lanes *a)
{
  const lanes *p = a->p, mean = lanes_sqrt(lanes_abs(p[0] / p[2]));
  const lane_mask real = p[1] * p[1] > 4 * lanes_abs(p[0] * p[2]);
  for (int k = 0; k < 2; k++) {
    const lanes edge = lanes_clamp(-p[k] / p[k + 1], -ROOTS_FAR, ROOTS_FAR);
    const lanes radius = lanes_clamp(mean, 1 / ROOTS_FAR, ROOTS_FAR);
    a->zr[k] = lanes_select(real, edge, radius * ROOTS_DIRECTION[k][0]);
    a->zi[k] = lanes_select(real, lanes_all(0), radius * ROOTS_DIRECTION[k][1]);
  }
}

/* Sets start values on the lanes of `wanted`. */
static void roots_lanes_start(struct roots_lanes *a, lane_mask wanted)
{
  if (a->degree == 2) {
    roots_lanes_start_quadratic(a);
    return;
  }
  for (int k = 0; k < a->degree; k++) a->zr[k] = a->zi[k] = lanes_all(1);
  for (unsigned bits = lanes_bits(wanted); bits; bits &= bits - 1)
    roots_lanes_start_lane(a, (unsigned)__builtin_ctz(bits));
}

/* ---- the iterations ---- */

/* 1/x to about 20 bits; 0 where x is above 1e38. */
LANES_INLINE lanes roots_lanes_inverse(lanes x)
{
#if LANES == 8
  return (lanes)_mm512_cvtps_pd(_mm256_div_ps(_mm256_set1_ps(1), _mm512_cvtpd_ps((__m512d)x)));
#elif LANES == 4
  return (lanes)_mm256_cvtps_pd(_mm_div_ps(_mm_set1_ps(1), _mm256_cvtpd_ps((__m256d)x)));
#else
  return 1 / x;
#endif
}

struct roots_lanes_value {
  lanes re, im, slope_re, slope_im, half_re, half_im; /* P, P', and if asked for P''/2 */
};

/* P and its derivatives at `number` values, so that one is computed while another waits. Let P = D Q + b1 y + b0, D =
 * y^2 - s y + t, and z a root of D. Then P(z) = b1 z + b0, P'(z) = b1 + D'(z) Q(z) and P''(z)/2 = Q(z) + D'(z) Q'(z),
 * with D'(z) = 2 z - s = 2 i im z. Q' comes from the same division of Q. `number` and `curved` are constants at every
 * call. */
LANES_INLINE void roots_lanes_evaluate(const struct roots_lanes *a, int n, const int at[], int number, bool curved,
                                       struct roots_lanes_value out[])
{
  lanes s[2], t[2], b1[2], b2[2], d1[2], d2[2], e1[2], e2[2];
  for (int h = 0; h < number; h++) {
    const lanes zr = a->zr[at[h]], zi = a->zi[at[h]];
    s[h] = 2 * zr, t[h] = zr * zr + zi * zi;
    b1[h] = b2[h] = d1[h] = d2[h] = e1[h] = e2[h] = lanes_all(0);
  }
  for (int k = n; k > 2; k--) {
    for (int h = 0; h < number; h++) {
      const lanes b = s[h] * b1[h] + (a->p[k] - t[h] * b2[h]);
      const lanes d = s[h] * d1[h] + (b - t[h] * d2[h]);
      if (curved && k > 4) {
        const lanes e = s[h] * e1[h] + (d - t[h] * e2[h]);
        e2[h] = e1[h], e1[h] = e;
      }
      b2[h] = b1[h], b1[h] = b, d2[h] = d1[h], d1[h] = d;
    }
  }
  for (int h = 0; h < number; h++) {
    const lanes zr = a->zr[at[h]], zi = a->zi[at[h]], twice = 2 * zi;
    lanes q = {0}, last = b1[h], before = b2[h];
    if (n >= 2) {
      const lanes b = s[h] * last + (a->p[2] - t[h] * before);
      q = b - t[h] * d2[h]; /* Q(z) = d1 z + q */
      before = last, last = b;
    }
    const lanes first = s[h] * last + (a->p[1] - t[h] * before), rest = a->p[0] - t[h] * last;
    out[h].re = first * zr + rest, out[h].im = first * zi;
    const lanes qr = d1[h] * zr + q, qi = d1[h] * zi;
    out[h].slope_re = first - twice * qi, out[h].slope_im = twice * qr;
    if (!curved) continue;
    const lanes bend = d2[h] - t[h] * e2[h]; /* of Q's quotient, e1 z + bend */
    out[h].half_re = qr - twice * (twice * (e1[h] * zr + bend));
    out[h].half_im = qi + twice * (d1[h] - twice * (e1[h] * zi));
  }
}

/* 1/(z_i - z_j) is (dx - i dy) push. Values that coincide do not push each other. */
LANES_INLINE lanes roots_lanes_push(lanes dx, lanes dy)
{
  return roots_lanes_inverse(lanes_max(dx * dx + dy * dy, lanes_all(0x1p-100)));
}

/* A complex number per lane. */
struct roots_lanes_complex {
  lanes re, im;
};

LANES_INLINE struct roots_lanes_complex roots_lanes_times(struct roots_lanes_complex x, struct roots_lanes_complex y)
{
  return (struct roots_lanes_complex){x.re * y.re - x.im * y.im, x.re * y.im + x.im * y.re};
}

/* sum over j != i of 1/(z_i - z_j) for the roots i of `active`. The terms are always in order of j, so a lane's sums do
 * not depend on which roots other lanes still move. */
LANES_INLINE void roots_lanes_sums(const struct roots_lanes *a, int n, const int active[], int count,
                                   struct roots_lanes_complex sum[ROOTS_LANES_DEGREE])
{
  for (int i = 0; i < n; i++) sum[i].re = sum[i].im = lanes_all(0);
  if (2 * count > n) { /* every difference serves both of its roots */
    for (int i = 0; i < n; i++) {
      const lanes zr = a->zr[i], zi = a->zi[i];
      struct roots_lanes_complex own = sum[i];
      for (int j = i + 1; j < n; j++) {
        const lanes dx = zr - a->zr[j], dy = zi - a->zi[j], push = roots_lanes_push(dx, dy);
        own.re += dx * push, own.im -= dy * push;
        sum[j].re -= dx * push, sum[j].im += dy * push;
      }
      sum[i] = own;
    }
    return;
  }
  for (int k = 0; k < count; k++) {
    const int i = active[k];
    const lanes zr = a->zr[i], zi = a->zi[i];
    struct roots_lanes_complex own = {{0}, {0}};
    for (int j = 0; j < n; j++) {
      if (j == i) continue;
      const lanes dx = zr - a->zr[j], dy = zi - a->zi[j], push = roots_lanes_push(dx, dy);
      own.re += dx * push, own.im -= dy * push;
    }
    sum[i] = own;
  }
}

/* The divisor of -P in a step. In eq 7 and 9 it is P' - P sum. */
LANES_INLINE struct roots_lanes_complex roots_lanes_pushed(const struct roots_lanes_value *value,
                                                           struct roots_lanes_complex sum)
{
  return (struct roots_lanes_complex){value->slope_re - (value->re * sum.re - value->im * sum.im),
                                      value->slope_im - (value->re * sum.im + value->im * sum.re)};
}

/* In eq 8, for the m roots that are left, with G = P'/P - sum and H = (P'/P)^2 - P''/P - sum of squares, it is (G +-
 * sqrt((m-1) (m H - G^2))) P/m. The sign is the one that makes it larger. */
LANES_INLINE struct roots_lanes_complex roots_lanes_laguerre(const struct roots_lanes_value *value, int m,
                                                             struct roots_lanes_complex sum,
                                                             struct roots_lanes_complex squares)
{
  const struct roots_lanes_complex p = {value->re, value->im}, slope = {value->slope_re, value->slope_im};
  const struct roots_lanes_complex half = {value->half_re, value->half_im}, g = roots_lanes_pushed(value, sum);
  const struct roots_lanes_complex slope2 = roots_lanes_times(slope, slope), bend = roots_lanes_times(p, half);
  const struct roots_lanes_complex away = roots_lanes_times(roots_lanes_times(p, p), squares);
  const struct roots_lanes_complex g2 = roots_lanes_times(g, g);
  const lanes x = (m - 1.0) * (m * (slope2.re - 2 * bend.re - away.re) - g2.re);
  const lanes y = (m - 1.0) * (m * (slope2.im - 2 * bend.im - away.im) - g2.im);
  /* the square root of x + i y */
  const lanes large = lanes_sqrt(0.5 * (lanes_sqrt(x * x + y * y) + lanes_abs(x)));
  const lanes small = lanes_select(large > 0, 0.5 * y / large, lanes_all(0));
  lanes re = lanes_select(x < 0, lanes_abs(small), large);
  lanes im = lanes_select(x < 0, lanes_select(y < 0, -large, large), small);
  const lane_mask other = g.re * re + g.im * im < 0;
  re = lanes_select(other, -re, re), im = lanes_select(other, -im, im);
  return (struct roots_lanes_complex){(g.re + re) * (1.0 / m), (g.im + im) * (1.0 / m)};
}

/* In Weierstrass's method it is c_n product over j != i of (z_i - z_j), where other roots that are at the limit stand
 * for roots at infinity. */
LANES_INLINE struct roots_lanes_complex roots_lanes_product(const struct roots_lanes *a, int i)
{
  struct roots_lanes_complex product = {lanes_all(1), {0}};
  lanes finite = lanes_all(a->degree), lead = a->p[0];
  for (int j = 0; j < a->degree; j++) {
    if (j == i) continue;
    const lane_mask far = lanes_max(lanes_abs(a->zr[j]), lanes_abs(a->zi[j])) >= ROOTS_FAR;
    finite -= lanes_select(far, lanes_all(1), lanes_all(0));
    const struct roots_lanes_complex way = {a->zr[i] - a->zr[j], a->zi[i] - a->zi[j]};
    const struct roots_lanes_complex next = roots_lanes_times(product, way);
    product.re = lanes_select(far, product.re, next.re), product.im = lanes_select(far, product.im, next.im);
  }
  for (int k = 1; k <= a->degree; k++) lead = lanes_select(finite == k, a->p[k], lead);
  return (struct roots_lanes_complex){lead * product.re, lead * product.im};
}

/* Takes the step -P/by of one root on the lanes where it moves, and then checks whether it is done. Returns the lanes
 * where it now is. `in_order` is a constant. */
LANES_INLINE lane_mask roots_lanes_move(struct roots_lanes *a, int i, const struct roots_lanes_value *value,
                                        struct roots_lanes_complex by, bool in_order, double settled)
{
  const lane_mask moving = a->moving[i] & a->seeking;
  const lanes zr = a->zr[i], zi = a->zi[i];
  const lanes inverse = -1 / (by.re * by.re + by.im * by.im);
  lanes dx = (value->re * by.re + value->im * by.im) * inverse, dy = (value->im * by.re - value->re * by.im) * inverse;
  const lanes step = lanes_abs(dx) + lanes_abs(dy);
  const lane_mask usable = step < ROOTS_FAR * ROOTS_FAR;
  if (in_order) {
    const lanes longest = ROOTS_LONGEST * (1 + (lanes_abs(zr) + lanes_abs(zi)));
    const lanes part = lanes_select(step > longest, longest / step, lanes_all(1));
    dx *= part, dy *= part;
  }
  /* A value that was sent this far by chance is sent back by its next step. */
  const lane_mask far = lanes_max(lanes_abs(zr), lanes_abs(zi)) >= ROOTS_FAR;
  /* where the pushes cancel P'/P, go somewhere else nearby */
  dx = lanes_select(usable, dx, 0.25 * zr - 0.125 * zi), dy = lanes_select(usable, dy, 0.25 * zi + 0.125 * zr);
  const lanes xr = lanes_max(lanes_min(zr + dx, lanes_all(ROOTS_FAR)), lanes_all(-ROOTS_FAR));
  const lanes xi = lanes_max(lanes_min(zi + dy, lanes_all(ROOTS_FAR)), lanes_all(-ROOTS_FAR));
  a->zr[i] = lanes_select(moving, xr, zr), a->zi[i] = lanes_select(moving, xi, zi);
  const lanes distance = lanes_max(lanes_abs(xi), lanes_abs(xr) - 1);
  lane_mask near = step < settled;
  if (in_order || a->method == SOLVER_LANES_DURAND_KERNER) near = step < settled * lanes_max(distance, lanes_all(1));
  else near |= (step * ROOTS_AWAY < distance - ROOTS_MARGIN) & (step < ROOTS_CALM * distance);
  const lane_mask gone = far & (~usable | (distance >= ROOTS_FAR - 1)), found = moving & (gone | (usable & near));
  a->moving[i] &= ~found;
  return found;
}

/* Lanes where root number i, already found, is real. */
LANES_INLINE lane_mask roots_lanes_real(const struct roots_lanes *a, int i)
{
  return lanes_abs(a->zi[i]) <= ROOTS_LIFT * lanes_max(lanes_abs(a->zr[i]), lanes_all(1));
}

/* Counts root number i, found on these lanes. */
LANES_INLINE void roots_lanes_count(struct roots_lanes *a, int i, lane_mask found)
{
  const lane_mask inside = found & roots_lanes_real(a, i) & (lanes_abs(a->zr[i]) <= 1);
  a->enough -= lanes_select(inside, lanes_all(1), lanes_all(0));
}

/* Moves all roots at once, in at most `most` sweeps. Removes lanes that are done from `seeking`. Inlined, so that
 * degree 2 has loops of its own. */
LANES_INLINE void roots_lanes_at_once(struct roots_lanes *a, int n, double settled, int most)
{
  int active[ROOTS_LANES_DEGREE], count = n;
  for (int i = 0; i < n; i++) active[i] = i;
  for (int sweep = 0; sweep < most && lanes_any(a->seeking); sweep++) {
    struct roots_lanes_value value[ROOTS_LANES_DEGREE + 1];
    struct roots_lanes_complex by[ROOTS_LANES_DEGREE];
    lane_mask any = {0};
    a->sweeps += lanes_select(a->seeking, lanes_all(n * n), lanes_all(0));
    for (int k = 0; k < count; k += 2) {
      const int at[2] = {active[k], active[k + 1 < count ? k + 1 : k]};
      roots_lanes_evaluate(a, n, at, 2, false, value + k);
    }
    if (a->method == SOLVER_LANES_ABERTH) {
      roots_lanes_sums(a, n, active, count, by);
      for (int k = 0; k < count; k++) by[active[k]] = roots_lanes_pushed(&value[k], by[active[k]]);
    } else {
      for (int k = 0; k < count; k++) by[active[k]] = roots_lanes_product(a, active[k]);
    }
    for (int k = 0; k < count; k++) {
      const lane_mask found = roots_lanes_move(a, active[k], &value[k], by[active[k]], false, settled);
      if (a->method == SOLVER_LANES_ABERTH) roots_lanes_count(a, active[k], found);
      any |= a->moving[active[k]];
    }
    a->seeking &= any & (a->enough > 0);
    int still = 0;
    for (int k = 0; k < count; k++) {
      const int i = active[k];
      /* Without P', a short step means something only if all others are short too. */
      if (a->method == SOLVER_LANES_DURAND_KERNER) a->moving[i] |= a->seeking;
      if (lanes_any(a->moving[i] & a->seeking)) active[still++] = i;
    }
    count = still;
  }
}

/* Seeks root number i; those before it are known. */
LANES_INLINE void roots_lanes_seek(struct roots_lanes *a, int i, bool curved, double settled, int most)
{
  for (int step = 0; step < most && lanes_any(a->moving[i] & a->seeking); step++) {
    struct roots_lanes_value value;
    struct roots_lanes_complex sum = {{0}, {0}}, squares = {{0}, {0}};
    a->sweeps += lanes_select(a->moving[i] & a->seeking, lanes_all(a->degree + i), lanes_all(0));
    roots_lanes_evaluate(a, a->degree, &i, 1, curved, &value);
    for (int j = 0; j < i; j++) {
      const lanes dx = a->zr[i] - a->zr[j], dy = a->zi[i] - a->zi[j], push = roots_lanes_push(dx, dy);
      const struct roots_lanes_complex one = {dx * push, -dy * push}, square = roots_lanes_times(one, one);
      sum.re += one.re, sum.im += one.im;
      if (curved) squares.re += square.re, squares.im += square.im;
    }
    const struct roots_lanes_complex by = curved ? roots_lanes_laguerre(&value, a->degree - i, sum, squares)
                                                 : roots_lanes_pushed(&value, sum);
    roots_lanes_move(a, i, &value, by, true, settled);
    if (step % ROOTS_PATIENCE != ROOTS_PATIENCE - 1) continue;
    const struct roots_lanes_complex at = {a->zr[i], a->zi[i]},
                                     radian = {lanes_all(COMPLEX_RADIAN_RE), lanes_all(COMPLEX_RADIAN_IM)};
    const struct roots_lanes_complex on = roots_lanes_times(at, radian);
    const lane_mask moving = a->moving[i] & a->seeking;
    a->zr[i] = lanes_select(moving, on.re, at.re), a->zi[i] = lanes_select(moving, on.im, at.im);
  }
}

/* Finds one root after the other, each with its conjugate, in at most `most` steps each. `seeking` becomes the lanes
 * where a root was sought in vain. */
static void roots_lanes_in_turn(struct roots_lanes *a, double settled, int most)
{
  const int n = a->degree;
  lane_mask failed = {0};
  for (int i = 0; i < n && lanes_any(a->seeking); i++) {
    const lane_mask sought = a->moving[i] & a->seeking;
    if (a->method == SOLVER_LANES_LAGUERRE) roots_lanes_seek(a, i, true, settled, most);
    else roots_lanes_seek(a, i, false, settled, most);
    const lane_mask found = sought & ~a->moving[i];
    roots_lanes_count(a, i, found);
    failed |= sought & a->moving[i];
    a->seeking &= ~failed & (a->enough > 0);
    if (i + 1 == n) break;
    const lane_mask pair = found & ~roots_lanes_real(a, i);
    a->zr[i + 1] = lanes_select(pair, a->zr[i], a->zr[i + 1]);
    a->zi[i + 1] = lanes_select(pair, -a->zi[i], a->zi[i + 1]);
    a->moving[i + 1] &= ~pair;
  }
  a->seeking = failed;
}

/* Goes from the start values to the roots, on the lanes of `wanted`, in at most `most` steps per root, until all are
 * found or `enough` real ones in [-1,1]. Roots found are no longer `moving`. Returns the lanes that come to that. */
static lane_mask roots_lanes_run(struct roots_lanes *a, lane_mask wanted, lanes enough, double settled, int most)
{
  const int sweeps = most < ROOTS_SWEEPS ? most : ROOTS_SWEEPS;
  a->seeking = wanted, a->enough = enough, a->sweeps = lanes_all(0);
  for (int i = 0; i < a->degree; i++) a->moving[i] = wanted;
  if (a->method == SOLVER_LANES_NEWTON || a->method == SOLVER_LANES_LAGUERRE) roots_lanes_in_turn(a, settled, most);
  else if (a->degree == 2) roots_lanes_at_once(a, 2, settled, sweeps);
  else roots_lanes_at_once(a, a->degree, settled, sweeps);
  return wanted & ~a->seeking;
}

#endif
