/* What a root is worth: one judge for all solvers, who looks at nothing but the value and the polynomial.
 *
 * For a polynomial q of degree n with Taylor coefficients q_j at z, each |q_j / q_0| is an elementary symmetric
 * function of the n reciprocal distances from z to the roots, at most C(n,j) / d^j with d the smallest distance. So for
 * every j there is a root within (C(n,j) |q_0| / |q_j|)^(1/j); j = 1 is the well-known n |p/p'|. With |q_0| rounded up
 * and |q_j| rounded down by their bounds (evaluation.h), this holds for the true polynomial. Roots at infinity only
 * make it safer.
 *
 * The bound is taken in the chart variable z and carried to u, both ways of Moebius: if z = s/w, with w the chart's
 * denominator at u, the disc of radius r about z lies within r |w|^2 / (1 - r |w|) of u, or reaches infinity if r |w|
 * >= 1.
 */
#include <math.h>
#include <string.h>

#include "algebra/root_kernel.h"

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

static void find_radii(const struct evaluation *p, int count, struct root root[])
{
  double re[POLYNOMIAL_MAX_DEGREE], im[POLYNOMIAL_MAX_DEGREE];
  struct inclusion found[POLYNOMIAL_MAX_DEGREE];
  for (int i = 0; i < count; i++) {
    re[i] = root[i].re;
    im[i] = root[i].im;
  }
  root_kernel_best()->include(p, count, re, im, found);
  for (int i = 0; i < count; i++) {
    double bound = found[i].bound;
    if (found[i].doubtful) {
      const double rounding = found[i].width == 0.0 ? 0.0 : CHART_ROUNDING * hypot(found[i].zr, found[i].zi);
      bound = fmin(bound, all_orders_bound(p, found[i].zr, found[i].zi, found[i].reversed) + rounding);
    }
    root[i].radius = radius_in_u(bound, found[i].width, found[i].width_square);
  }
}

/* The bound n |p/p'| is n times what Newton's method would guess of the error of a simple root; a value whose imaginary
 * part is within this many such guesses is moved to the real axis and judged again. */
#define SNAP_GUESSES 2.0

static void snap_to_axis(const struct evaluation *p, struct root_set *roots)
{
  struct root moved[POLYNOMIAL_MAX_DEGREE];
  int from[POLYNOMIAL_MAX_DEGREE], count = 0;
  for (int i = 0; i < roots->count; i++) {
    const struct root *root = &roots->root[i];
    if (root->im != 0.0 && root->radius < INFINITY && p->degree * fabs(root->im) <= SNAP_GUESSES * root->radius) {
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

/* Whether p may have a root at infinity: its leading coefficient in powers of u is not told from zero. In Bernstein
 * form that is the value of q at x = -1. */
static bool may_reach_infinity(const struct evaluation *p)
{
  const bool power = p->basis == BASIS_POWER;
  const struct evaluation_real at = evaluation_at_real(p, power ? 0.0 : -1.0, power);
  return fabs(at.value) <= at.error;
}

void validation_judge(const struct evaluation *p, struct root_set *roots)
{
  find_radii(p, roots->count, roots->root);
  bool infinite = false, asked = false;
  int kept = 0;
  for (int i = 0; i < roots->count; i++) {
    struct root *root = &roots->root[i];
    if (!(root->radius < INFINITY) && root->status != ROOT_LIMIT) {
      infinite = asked ? infinite : may_reach_infinity(p);
      asked = true;
      if (infinite && hypot(root->re - 0.5, root->im) > 1.0) {
        continue; /* a candidate for [0,1] is kept in any case */
      }
      root->status = ROOT_LIMIT;
    }
    roots->root[kept++] = *root;
  }
  roots->count = kept;
  snap_to_axis(p, roots);
  mark_clusters(roots);
}
