/* Real polynomials, one per lane, and the values from which the iterations of roots_lanes.h start.
 *
 * Polynomials in scaled Bernstein form are converted to powers of y = 2u - 1. All roots that matter have |y| <= 1, and
 * the rounding there (mostly 1e-11 of a root, 1e-6 at worst) is small for a start value.
 *
 * Included by sources that are compiled once per instruction set. A lane's results do not depend on the other lanes,
 * not even in the last bit.
 */
#ifndef PSCN_ALGEBRA_ROOTS_LANES_START_H
#define PSCN_ALGEBRA_ROOTS_LANES_START_H

#include <math.h>

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

#endif
