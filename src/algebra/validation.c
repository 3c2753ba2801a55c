/* Validates roots: one judge for all solvers, which uses nothing but the value and the polynomial.
 *
 * For a polynomial q of degree n with Taylor coefficients q_j at z, each |q_j / q_0| is an elementary symmetric
 * function of the n reciprocal distances from z to the roots, at most C(n,j) / d^j with d the smallest distance. So for
 * every j there is a root within (C(n,j) |q_0| / |q_j|)^(1/j); j = 1 is the well-known n |p/p'|. With |q_0| rounded up
 * and |q_j| rounded down by their bounds (evaluation.h), this holds for the true polynomial. Roots at infinity only
 * make it safer.
 *
 * The bound is taken in the chart variable z and carried to u; both charts are Moebius maps. If z = s/w, with w the
 * chart's denominator at u, the disc of radius r about z lies within r |w|^2 / (1 - r |w|) of u, or reaches infinity if
 * r |w| >= 1.
 *
 * That a disc holds a root does not say that no root is left over. To say that, n different values x_i are needed. The
 * discs about them of radius n |q(x_i)| / (|c_n| product over j != i of |x_i - x_j|) cover all roots, and a group of k
 * discs that is apart from the rest holds exactly k (B. T. Smith, "Error bounds for zeros of a polynomial based upon
 * Gerschgorin's theorems", 1970). Here x is that of root_problem.h, or u itself, with p for q. In every group, values
 * are taken in the order of their own bounds. A value whose disc is apart from those taken before has a root of its
 * own. The roots left over are somewhere in the group, and the other values get radii that reach all of it. Then roots
 * and values can be paired, each root within the radius of its value. With fewer than n values, only those with discs
 * of their own are known.
 */
#include <float.h>
#include <math.h>
#include <string.h>

#include "algebra/root_problem.h"

/* The chart point is computed from u with a difference, a reciprocal of a square and products: under 10 roundings. */
#define CHART_ROUNDING (10 * UNIT_ROUNDOFF)

/* A slope known to less than half of itself makes the first-order bound poor; the higher orders are then tried too. */
#define SLOPE_CERTAINTY 0.5

/* The chart point z = top/low of u, with low = w, and whether z is 1/x. */
struct chart {
  struct complex_number z;
  double width_square; /* |w|^2 */
  bool reversed;
};

static struct chart chart_of(enum basis basis, struct complex_number u)
{
  const struct complex_number v = basis == BASIS_POWER ? (struct complex_number){1.0, 0.0}
                                                       : (struct complex_number){1.0 - u.re, -u.im};
  struct chart out = {.reversed = complex_norm(u) > complex_norm(v)};
  const struct complex_number top = out.reversed ? v : u, low = out.reversed ? u : v;
  out.width_square = complex_norm(low);
  out.z.re = (top.re * low.re + top.im * low.im) / out.width_square;
  out.z.im = (top.im * low.re - top.re * low.im) / out.width_square;
  return out;
}

/* The first-order bound of one value. */
struct inclusion {
  struct complex_number z;    /* chart point */
  double bound;               /* of the distance from z to the nearest root; may be infinite or NaN */
  double width, width_square; /* |w| and |w|^2 of the chart at u; width is 0 where z = u */
  bool reversed;
  bool doubtful; /* the slope is hardly told from zero; higher orders may bound better */
};

static struct inclusion include(const struct evaluation *p, struct complex_number u)
{
  const bool power = p->basis == BASIS_POWER;
  const struct chart chart = chart_of(p->basis, u);
  struct inclusion out = {.z = chart.z, .width_square = chart.width_square, .reversed = chart.reversed};

  const double *c = out.reversed ? p->reverse : p->forward;
  const double *bound = out.reversed ? p->reverse_bound : p->forward_bound;
  const double size = complex_small_modulus(out.z);
  struct complex_number q = {c[p->degree], 0.0}, slope = {0.0, 0.0};
  double error = bound[p->degree], slope_error = 0.0;
  for (int k = p->degree - 1; k >= 0; k--) {
    slope = complex_add(complex_multiply(slope, out.z), q);
    q = complex_multiply(q, out.z);
    q.re += c[k];
    slope_error = slope_error * size + error;
    error = error * size + bound[k];
  }
  /* at an end no arithmetic is done, so the value of an exact coefficient is exact */
  const double value = complex_small_modulus(q), value_error = size == 0.0 ? bound[0] : error + UNDERFLOW_ERROR;
  const double most = value + value_error, steep = complex_small_modulus(slope);
  const double sure_slope = steep * (2.0 - BOUND_ROOM) - (slope_error + UNDERFLOW_ERROR);
  out.bound = most == 0.0 ? 0.0 : sure_slope > 0.0 ? p->degree * most / sure_slope * BOUND_ROOM : INFINITY;
  out.doubtful = sure_slope < SLOPE_CERTAINTY * steep && most > 0.0;
  if (power && !out.reversed) return out; /* z = u needs no chart and has no chart rounding */
  out.bound += CHART_ROUNDING * size;
  out.width = sqrt(out.width_square);
  return out;
}

/* The least bound over all orders j, at one chart point. */
static double all_orders_bound(const struct evaluation *p, struct complex_number z, bool reversed)
{
  const int n = p->degree;
  const size_t bytes = sizeof(double) * (size_t)(n + 1);
  const double modulus = hypot(z.re, z.im) * (1.0 + 4 * UNIT_ROUNDOFF);
  double re[POLYNOMIAL_MAX_DEGREE + 1], im[POLYNOMIAL_MAX_DEGREE + 1] = {0}, error[POLYNOMIAL_MAX_DEGREE + 1];
  memcpy(re, reversed ? p->reverse : p->forward, bytes);
  memcpy(error, reversed ? p->reverse_bound : p->forward_bound, bytes);
  double best = INFINITY, top = 0.0;
  for (int j = 0; j <= n; j++) {
    for (int k = n - 1; k >= j; k--) {
      re[k] += re[k + 1] * z.re - im[k + 1] * z.im;
      im[k] += re[k + 1] * z.im + im[k + 1] * z.re;
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

/* Converts a bound in z to one in u. */
static double radius_in_u(double bound, double width, double width_square)
{
  const double room = 1.0 - bound * width * BOUND_ROOM;
  const double radius = bound * width_square / room * BOUND_ROOM;
  return room > 0.0 && radius >= 0.0 ? radius : INFINITY; /* NaN ends here too */
}

/* One value and what is known of it. Lengths are in the plane of the discs, except where a comment says otherwise. */
struct judged {
  struct complex_number x; /* the value, or a point beside it if two are equal */
  double shift;            /* how far beside */
  double own;              /* some root is within it */
  double shared;           /* Smith's disc; INFINITY where there is none */
  double own_in_u;
  double width, width_square; /* |w| and |w|^2 of the plane as a chart of u; 0 and 1 where it is that of u */
  int group;                  /* the least index of its group */
  bool taken;                 /* the root within `own` belongs to no other value */
};

/* Smith's theorem needs different centres. Of two equal ones, the later is moved aside by about its own uncertainty. */
static void set_apart(struct judged *later, const struct judged *earlier)
{
  if (later->x.re != earlier->x.re || later->x.im != earlier->x.im || !(later->own < INFINITY)) return;
  const double shift = fmax(2.0 * later->own, 4 * DBL_EPSILON * fabs(later->x.re) + DBL_MIN);
  const double from = later->x.re;
  later->x.re += shift;
  const double moved = (later->x.re - from) * BOUND_ROOM; /* rounding may have moved it farther */
  later->shift += moved, later->own += moved;
}

static void find_own(const struct evaluation *p, bool in_u, int count, const struct root root[], struct judged all[])
{
  for (int i = 0; i < count; i++) {
    const struct complex_number u = {root[i].re, root[i].im};
    const struct inclusion at = include(p, u);
    double bound = at.bound;
    if (at.doubtful) {
      const double rounding = at.width == 0.0 ? 0.0 : CHART_ROUNDING * hypot(at.z.re, at.z.im);
      bound = fmin(bound, all_orders_bound(p, at.z, at.reversed) + rounding);
    }
    const double own_in_u = radius_in_u(bound, at.width, at.width_square);
    all[i] = (struct judged){
      .x = u, .own = own_in_u, .own_in_u = own_in_u, .shared = INFINITY, .width_square = 1.0, .group = i};
    if (!in_u) {
      root_problem_x_from_u(p->basis, &all[i].x.re, &all[i].x.im);
      all[i].width = hypot(1.0 - u.re, u.im);
      all[i].width_square = all[i].width * all[i].width;
      const double x_width = at.reversed ? complex_modulus(all[i].x) : 0.0;
      all[i].own = radius_in_u(bound, x_width, at.reversed ? x_width * x_width : 1.0) +
                   CHART_ROUNDING * hypot(all[i].x.re, all[i].x.im); /* the rounding of x from u */
    }
    for (int j = 0; j < i; j++) set_apart(&all[i], &all[j]);
  }
}

/* Room for the rounding of a sum of 200 logarithms to base 2, each below 2^17. */
#define LOG_ROOM 0x1p-20

/* log2 of a bound on |q(x)|, or on |p(u)|. A chart point comes from u by a difference and a quotient: 7 roundings. */
static double log_value(const struct evaluation *p, bool in_u, struct complex_number x)
{
  if (in_u && p->basis == BASIS_BERNSTEIN) {
    const struct chart chart = chart_of(p->basis, x);
    const struct evaluation_complex q = evaluation_in_chart(p, chart.z, chart.reversed);
    return log2(hypot(q.value.re, q.value.im) + q.error) + 0.5 * p->degree * log2(chart.width_square);
  }
  const struct evaluation_complex q = evaluation_at_complex(p, x, 1.0);
  return log2(hypot(q.value.re, q.value.im) + q.error) + (q.reversed ? p->degree * log2(hypot(x.re, x.im)) : 0.0);
}

/* The leading coefficient, and a bound on its error. In powers of x it is the last of q; in powers of u, with p in
 * Bernstein form, it is the value of q at x = -1. */
static struct evaluation_real leading_of(const struct evaluation *p, bool in_u)
{
  if (in_u && p->basis == BASIS_BERNSTEIN) return evaluation_at_real(p, -1.0, false);
  return (struct evaluation_real){.value = p->forward[p->degree], .error = p->forward_bound[p->degree]};
}

/* Whether to draw the discs in the plane of u. The plane of x has its point at infinity at u = 1. Near a root there, no
 * disc is known, and the leading coefficient is hardly told from zero. */
static bool better_in_u(const struct evaluation *p)
{
  const struct evaluation_real u = leading_of(p, true), x = leading_of(p, false);
  return p->basis == BASIS_POWER || fabs(u.value) * x.error > fabs(x.value) * u.error;
}

/* Half the distance, which does not overflow. */
static double half_distance(const struct judged *a, const struct judged *b)
{
  return hypot(0.5 * a->x.re - 0.5 * b->x.re, 0.5 * a->x.im - 0.5 * b->x.im);
}

static bool discs_meet(const struct judged *a, double a_radius, const struct judged *b, double b_radius)
{
  return !(2.0 * half_distance(a, b) > (a_radius + b_radius) * BOUND_ROOM);
}

/* Finds Smith's discs, and the groups they form. */
static void find_groups(const struct evaluation *p, bool in_u, int count, struct judged all[])
{
  const struct evaluation_real last = leading_of(p, in_u);
  const double leading = fabs(last.value) * (2.0 - BOUND_ROOM) - last.error;
  bool able = count == p->degree && leading > 0.0;
  for (int i = 0; i < count; i++) able = able && isfinite(all[i].x.re) && isfinite(all[i].x.im);
  for (int i = 0; able && i < count; i++) {
    double size = log2(count) + log_value(p, in_u, all[i].x) - log2(leading) + LOG_ROOM;
    for (int j = 0; j < count; j++) size -= j == i ? 0.0 : log2(half_distance(&all[i], &all[j])) + 1.0;
    all[i].shared = isnan(size) ? INFINITY : exp2(size) + DBL_MIN;
  }
  for (int i = 0; i < count; i++) {
    for (int j = 0; j < i; j++) {
      const int from = all[i].group, to = all[j].group;
      if (from == to || !discs_meet(&all[i], all[i].shared, &all[j], all[j].shared)) continue;
      for (int k = 0; k < count; k++)
        if (all[k].group == from || all[k].group == to) all[k].group = from < to ? from : to;
    }
  }
}

/* Gives roots to the values whose discs are apart from those taken before, in order of size, smallest first. */
static void take_own(int count, struct judged all[])
{
  bool seen[POLYNOMIAL_MAX_DEGREE] = {false};
  for (int round = 0; round < count; round++) {
    int best = -1;
    for (int i = 0; i < count; i++)
      if (!seen[i] && (best < 0 || all[i].own < all[best].own)) best = i;
    struct judged *here = &all[best];
    seen[best] = true;
    here->taken = here->own < INFINITY && here->own <= here->shared;
    for (int j = 0; j < count && here->taken; j++) {
      const bool rival = j != best && all[j].taken && all[j].group == here->group;
      here->taken = !rival || !discs_meet(here, here->own, &all[j], all[j].own);
    }
  }
}

/* The radius of a value, in u. */
static double final_radius(int i, int count, const struct judged all[])
{
  const struct judged *here = &all[i];
  if (here->taken) return here->own_in_u;
  double reach = 0.0;
  for (int j = 0; j < count; j++) {
    const double far = 2.0 * half_distance(here, &all[j]) + all[j].shared;
    if (all[j].group == here->group && !(far <= reach)) reach = isnan(far) ? INFINITY : far;
  }
  const double rounding = here->width == 0.0 ? 0.0 : CHART_ROUNDING * hypot(here->x.re, here->x.im);
  return radius_in_u((reach + here->shift) * BOUND_ROOM + rounding, here->width, here->width_square);
}

/* The bound n |p/p'| is n times Newton's guess of the error of a simple root. A value whose imaginary part is within
 * this many such guesses is moved to the real axis. */
#define SNAP_GUESSES 2.0

static void set_radii(const struct evaluation *p, bool all_sought, int count, struct root root[])
{
  struct judged all[POLYNOMIAL_MAX_DEGREE];
  const bool in_u = better_in_u(p);
  find_own(p, in_u, count, root, all);
  if (all_sought) {
    find_groups(p, in_u, count, all);
    take_own(count, all);
  }
  for (int i = 0; i < count; i++) {
    const double own = all[i].own_in_u;
    root[i].radius = fmax(root[i].radius, all_sought ? final_radius(i, count, all) : own);
    if (own < INFINITY && p->degree * fabs(root[i].im) <= SNAP_GUESSES * own) {
      root[i].radius = (root[i].radius + fabs(root[i].im)) * BOUND_ROOM;
      root[i].im = 0.0;
    }
  }
}

/* Marks discs that meet as clusters. */
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

/* Whether p may have a root at infinity: its leading coefficient in powers of u, which in Bernstein form is the value
 * of q at x = -1, is not told from zero. */
static bool may_reach_infinity(const struct evaluation *p)
{
  const bool power = p->basis == BASIS_POWER;
  const struct evaluation_real at = evaluation_at_real(p, power ? 0.0 : -1.0, power);
  return fabs(at.value) <= at.error;
}

void validation_judge(const struct evaluation *p, bool all_sought, int exact, struct root_set *roots)
{
  set_radii(p, all_sought, roots->count - exact, roots->root + exact);
  bool infinite = false, asked = false;
  int kept = exact;
  for (int i = exact; i < roots->count; i++) {
    struct root *root = &roots->root[i];
    if (!(root->radius < INFINITY)) {
      infinite = asked ? infinite : may_reach_infinity(p);
      asked = true;
      if (infinite && hypot(root->re - 0.5, root->im) > 1.0 && root->status != ROOT_LIMIT)
        continue; /* a candidate for [0,1] is kept in any case */
      root->status = ROOT_LIMIT;
    }
    roots->root[kept++] = *root;
  }
  roots->count = kept;
  mark_clusters(roots);
}
