/* What a root is worth: one judge for all solvers, who looks at nothing but the value and the polynomial.
 *
 * For a polynomial q of degree n with Taylor coefficients q_j at z, each |q_j / q_0| is an elementary symmetric function of the
 * n reciprocal distances from z to the roots, at most C(n,j) / d^j with d the smallest distance. So for every j there is a
 * root within (C(n,j) |q_0| / |q_j|)^(1/j); j = 1 is the well-known n |p/p'|. With |q_0| rounded up and |q_j| rounded down by
 * their bounds (evaluation.h), this holds for the true polynomial. Roots at infinity only make it safer.
 *
 * The bound is taken in the chart variable z and carried to u, both ways of Moebius: if z = s/w, with w the chart's
 * denominator at u, the disc of radius r about z lies within r |w|^2 / (1 - r |w|) of u, or reaches infinity if r |w| >= 1.
 */
#include <math.h>
#include <string.h>

#include "algebra/root_problem.h"

/* The chart point is computed from u with a difference, a reciprocal of a square and products: under 10 roundings. */
#define CHART_ROUNDING (10 * UNIT_ROUNDOFF)

/* A slope known to less than half of itself makes the first-order bound poor: then the higher orders are asked too. */
#define SLOPE_CERTAINTY 0.5

/* A value whose disc reaches infinity is dropped as a root at infinity, except within this distance of 1/2: there a useless
 * disc only says that nothing is known, and a candidate for [0,1] is never dropped. */
#define NEAR_INTERVAL 1.0

struct judged_lanes {
  lanes zr, zi;       /* chart point */
  lanes bound;        /* of the distance from z to the nearest root, by j = 1 */
  lanes width_square; /* |w|^2 */
  lanes width;        /* |w|; 0 where z = u */
  lane_mask reversed;
  lane_mask doubtful; /* worth the higher orders */
};

/* Chart and first-order bound of eight values. */
LANES_INLINE void judge_lanes(const struct evaluation *p, lanes ur, lanes ui, struct judged_lanes *out)
{
  const bool power = p->basis == BASIS_POWER;
  const lanes one = lanes_all(1.0), zero = {0};
  const lanes vr = power ? one : 1.0 - ur, vi = power ? zero : -ui;
  const lanes u_square = ur * ur + ui * ui, v_square = vr * vr + vi * vi;
  out->reversed = u_square > v_square;
  const lanes top_r = lanes_select(out->reversed, vr, ur), top_i = lanes_select(out->reversed, vi, ui);
  const lanes low_r = lanes_select(out->reversed, ur, vr), low_i = lanes_select(out->reversed, ui, vi);
  out->width_square = lanes_select(out->reversed, u_square, v_square);
  out->width = lanes_sqrt(out->width_square);
  out->zr = (top_r * low_r + top_i * low_i) / out->width_square;
  out->zi = (top_i * low_r - top_r * low_i) / out->width_square;

  struct evaluation_lanes q;
  evaluation_at_lanes(p, out->zr, out->zi, out->reversed, &q);
  const lanes size = lanes_sqrt(out->zr * out->zr + out->zi * out->zi);
  const lanes value = lanes_sqrt(q.re * q.re + q.im * q.im);
  const lanes slope = lanes_sqrt(q.slope_re * q.slope_re + q.slope_im * q.slope_im);
  const lanes end_error = lanes_select(out->reversed, lanes_all(p->reverse_bound[0]), lanes_all(p->forward_bound[0]));
  const lane_mask at_end = size == 0.0; /* no arithmetic was done there: an exact coefficient is an exact value */
  const lanes end_value = lanes_select(value == 0.0, end_error, value + end_error);
  const lanes top = lanes_select(at_end, end_value, value + q.error);
  const lanes sure_slope = slope * (2.0 - BOUND_ROOM) - q.slope_error;
  out->bound = p->degree * top / sure_slope * BOUND_ROOM;
  out->bound = lanes_select(sure_slope > 0.0, out->bound, lanes_all(INFINITY));
  out->bound = lanes_select(top == 0.0, zero, out->bound);
  out->doubtful = (lane_mask)(sure_slope < SLOPE_CERTAINTY * slope) & (lane_mask)(top > 0.0);
  /* z = u needs no chart and has no chart rounding */
  const lane_mask plain = power ? ~out->reversed : (lane_mask){0};
  out->bound += lanes_select(plain, zero, CHART_ROUNDING * size);
  out->width = lanes_select(plain, zero, out->width);
}

/* The least bound over all orders j, at one chart point. */
static double all_orders_bound(const struct evaluation *p, double zr, double zi, bool reversed)
{
  const int n = p->degree;
  const size_t bytes = sizeof(double) * (size_t)(n + 1);
  const double modulus = hypot(zr, zi) * (1.0 + 4 * UNIT_ROUNDOFF);
  double re[POLYNOMIAL_MAX_DEGREE + 1], im[POLYNOMIAL_MAX_DEGREE + 1] = {0}, error[POLYNOMIAL_MAX_DEGREE + 1];
  memcpy(re, reversed ? p->reverse : p->forward, bytes);
  memcpy(error, reversed ? p->reverse_bound : p->forward_bound, bytes);
  double best = INFINITY, top = 0.0;
  for (int j = 0; j <= n; j++) {
    for (int k = n - 1; k >= j; k--) {
      re[k] += re[k + 1] * zr - im[k + 1] * zi;
      im[k] += re[k + 1] * zi + im[k + 1] * zr;
      error[k] += error[k + 1] * modulus;
    }
    const double size = hypot(re[j], im[j]), doubt = error[j] + UNDERFLOW_ERROR;
    if (j == 0) {
      top = (size + doubt) * BOUND_ROOM;
    } else if (size * (2.0 - BOUND_ROOM) > doubt) {
      const double ratio = polynomial_binomial(n, j) * top / (size * (2.0 - BOUND_ROOM) - doubt);
      best = fmin(best, pow(ratio, 1.0 / j) * BOUND_ROOM);
    }
  }
  return best;
}

/* From a bound in z to one in u. */
static double radius_in_u(double bound, double width, double width_square)
{
  const double room = 1.0 - bound * width * BOUND_ROOM;
  const double radius = bound * width_square / room * BOUND_ROOM;
  return room > 0.0 && radius >= 0.0 ? radius : INFINITY; /* NaN ends here too */
}

ALGEBRA_CLONES static void find_radii(const struct evaluation *p, int count, struct root root[])
{
  for (int first = 0; first < count; first += LANES) {
    const int used = count - first < LANES ? count - first : LANES;
    lanes ur = {0}, ui = {0};
    for (int l = 0; l < used; l++) {
      ur[l] = root[first + l].re;
      ui[l] = root[first + l].im;
    }
    struct judged_lanes judged;
    judge_lanes(p, ur, ui, &judged);
    for (int l = 0; l < used; l++) {
      double bound = judged.bound[l];
      if (judged.doubtful[l] != 0) {
        const bool plain = judged.width[l] == 0.0;
        const double rounding = plain ? 0.0 : CHART_ROUNDING * hypot(judged.zr[l], judged.zi[l]);
        bound = fmin(bound, all_orders_bound(p, judged.zr[l], judged.zi[l], judged.reversed[l] != 0) + rounding);
      }
      root[first + l].radius = radius_in_u(bound, judged.width[l], judged.width_square[l]);
    }
  }
}

/* A real polynomial's root whose disc meets the real axis may be real: it is moved there and judged again. */
static void snap_to_axis(const struct evaluation *p, struct root_set *roots)
{
  struct root moved[POLYNOMIAL_MAX_DEGREE];
  int from[POLYNOMIAL_MAX_DEGREE], count = 0;
  for (int i = 0; i < roots->count; i++) {
    const struct root *root = &roots->root[i];
    if (root->im != 0.0 && fabs(root->im) <= root->radius && root->radius < INFINITY) {
      moved[count] = *root;
      moved[count].im = 0.0;
      from[count++] = i;
    }
  }
  find_radii(p, count, moved);
  for (int m = 0; m < count; m++) {
    struct root *root = &roots->root[from[m]];
    const double carried = (root->radius + fabs(root->im)) * BOUND_ROOM;
    root->radius = fmin(moved[m].radius, carried);
    root->im = 0.0;
  }
}

/* Discs that meet are one cluster. */
static void mark_clusters(struct root_set *roots)
{
  for (int i = 0; i < roots->count; i++) {
    struct root *a = &roots->root[i];
    for (int j = i + 1; j < roots->count; j++) {
      struct root *b = &roots->root[j];
      const double dx = a->re - b->re, dy = a->im - b->im, reach = a->radius + b->radius;
      if (dx * dx + dy * dy <= reach * reach) {
        a->status = a->status == ROOT_CONVERGED ? ROOT_CLUSTER : a->status;
        b->status = b->status == ROOT_CONVERGED ? ROOT_CLUSTER : b->status;
      }
    }
  }
}

void validation_judge(const struct evaluation *p, struct root_set *roots)
{
  find_radii(p, roots->count, roots->root);
  int kept = 0;
  for (int i = 0; i < roots->count; i++) {
    struct root *root = &roots->root[i];
    if (!(root->radius < INFINITY) && root->status != ROOT_LIMIT) {
      if (hypot(root->re - 0.5, root->im) > NEAR_INTERVAL) {
        continue; /* its disc reaches infinity */
      }
      root->status = ROOT_LIMIT;
    }
    roots->root[kept++] = *root;
  }
  roots->count = kept;
  snap_to_axis(p, roots);
  mark_clusters(roots);
}
