/* The first stages of a candidate, on all lanes of one dominant axis at once: plane polynomials, resultant, one of
 * its roots.
 *
 * Internal to src/intersect; included by packet.c, which says in what order they come and what each may decide.
 */
#ifndef PSCN_INTERSECT_TRIAL_H
#define PSCN_INTERSECT_TRIAL_H

#include "intersect/packet.h"
#include "intersect/refine.h"

#define BEZOUT_REAL lanes
#define BEZOUT_NAME(name) bezout_lanes_##name
#include "algebra/bezout.h"

enum { RESULTANT_MAX_DEGREE = 18, RESULTANT_NEWTON_STEPS = 3 };

/* Everything about the candidates of one leaf on the lanes of one axis. */
struct trial {
  const struct leaf *leaf;
  const struct model_patch *patch; /* the leaf's */
  int64_t number;                  /* the leaf's, in its model */
  int axis;
  struct plane_nets nets;
  lanes alpha, beta;                 /* largest |a|, |b| of the nets, then of the form */
  lanes form_error;                  /* of a coefficient of the form */
  lanes form_a[16], form_b[16];      /* where the form is not the leaf's own net */
  const lanes *fa, *fb;
  int degree;                        /* of r, exact roots at the ends taken off */
  lanes c_store[RESULTANT_MAX_DEGREE + 1];
  const lanes *c;                    /* c[0..degree] */
  lanes variations;                  /* sign variations of c; -1 where not known: a sign is within its error */
};

LANES_INLINE void plane_values(const struct packet *p, int axis, const double x[3][16], int at, lanes *a, lanes *b)
{
  const double k = x[axis][at], i = x[(axis + 1) % 3][at], j = x[(axis + 2) % 3][at];
  *a = (i - p->local[axis].moment[0]) - p->slope[axis][0] * k;
  *b = (j - p->local[axis].moment[1]) - p->slope[axis][1] * k;
}

/* Stage 1. Lanes whose ray may pass the box along the leaf. On the ray x_i = m0 + s0 w, x_j = m1 + s1 w, x_k = w the
 * slabs' forms are A + B w; two slabs have a common w where |A_q B_r - A_r B_q| <= half_q |B_r| + half_r |B_q|. With
 * e the bound on a plane's error (local_ray.h), A is off by 2 |g| e and B by 4u |g|, where |A| u <= |g| e/4 and |B|
 * <= |g|: the products by 8 |g_q| |g_r| e in all, and the right side by less than that. */
static lane_mask trial_slabs(const struct packet *p, const struct trial *t, lane_mask active)
{
  const struct leaf_slabs *slabs = &t->leaf->slabs;
  const int k = t->axis, i = (k + 1) % 3, j = (k + 2) % 3;
  lanes a[3], b[3], size[3];
  for (int q = 0; q < 3; q++) {
    const double *g = slabs->g[q];
    a[q] = g[i] * p->local[k].moment[0] + (g[j] * p->local[k].moment[1] - slabs->offset[q]);
    b[q] = g[i] * p->slope[k][0] + (g[j] * p->slope[k][1] + g[k]);
    size[q] = lanes_abs(b[q]);
  }
  const lanes error = slabs->slack * p->local[k].error;
  for (int q = 0; q < 3; q++) {
    const int r = (q + 1) % 3;
    active &= ~(lanes_abs(a[q] * b[r] - a[r] * b[q]) > slabs->half[q] * size[r] + (slabs->half[r] * size[q] + error));
  }
  return active;
}

static void trial_nets(const struct packet *p, struct trial *t)
{
  for (int n = 0; n < 16; n++) plane_values(p, t->axis, t->leaf->x, n, &t->nets.a[n], &t->nets.b[n]);
  t->nets.slope[0] = p->slope[t->axis][0], t->nets.slope[1] = p->slope[t->axis][1];
  t->nets.error = p->local[t->axis].error;
}

/* Stage 1 again, by the whole net. */
static lane_mask trial_planes(struct trial *t, lane_mask active)
{
  lanes a_low, a_high, b_low, b_high;
  for (int n = 0; n < 16; n++) {
    const lanes a = t->nets.a[n], b = t->nets.b[n];
    a_low = n ? lanes_min(a, a_low) : a, a_high = n ? lanes_max(a, a_high) : a;
    b_low = n ? lanes_min(b, b_low) : b, b_high = n ? lanes_max(b, b_high) : b;
  }
  const lanes e = t->nets.error;
  t->alpha = lanes_max(-a_low, a_high), t->beta = lanes_max(-b_low, b_high);
  return active & (a_low <= e) & (a_high >= -e) & (b_low <= e) & (b_high >= -e);
}

/* Stage 1 again, with the two combinations of a and b that aim along the leaf's parameters: near the middle they are
 * like u - u0 and v - v0 for the point (u0,v0) where the ray meets the tangent plane, so they tell a ray that passes
 * the leaf by. */
static lane_mask trial_aligned(const struct trial *t, lane_mask active)
{
  const lanes *a = t->nets.a, *b = t->nets.b;
  const lanes au = (a[13] + a[14]) - (a[1] + a[2]), av = (a[7] + a[11]) - (a[4] + a[8]);
  const lanes bu = (b[13] + b[14]) - (b[1] + b[2]), bv = (b[7] + b[11]) - (b[4] + b[8]);
  lanes u_low = bv * a[0] - av * b[0], v_low = au * b[0] - bu * a[0], u_high = u_low, v_high = v_low;
  for (int n = 1; n < 16; n++) {
    const lanes u = bv * a[n] - av * b[n], v = au * b[n] - bu * a[n];
    u_low = lanes_min(u, u_low), u_high = lanes_max(u, u_high);
    v_low = lanes_min(v, v_low), v_high = lanes_max(v, v_high);
  }
  /* The combination's own three roundings, on top of the coefficients' error. */
  const lanes e = t->nets.error + 4 * UNIT_ROUNDOFF * (t->alpha + t->beta);
  const lanes u_error = e * (lanes_abs(bv) + lanes_abs(av)), v_error = e * (lanes_abs(au) + lanes_abs(bu));
  return active & (u_low <= u_error) & (u_high >= -u_error) & (v_low <= v_error) & (v_high >= -v_error);
}

static void trial_form(const struct packet *p, struct trial *t)
{
  const struct leaf_form *form = t->leaf->form;
  t->fa = t->nets.a, t->fb = t->nets.b, t->form_error = t->nets.error;
  if (!form) return;
  t->alpha = t->beta = lanes_all(0);
  for (int i = 0; i <= t->leaf->kept_degree; i++) {
    for (int j = 0; j <= t->leaf->eliminated_degree; j++) {
      lanes a, b;
      plane_values(p, t->axis, form->x, 4 * i + j, &a, &b);
      t->form_a[4 * i + j] = a, t->form_b[4 * i + j] = b;
      t->alpha = lanes_max(t->alpha, lanes_abs(a)), t->beta = lanes_max(t->beta, lanes_abs(b));
    }
  }
  t->fa = t->form_a, t->fb = t->form_b;
  /* Where the ray meets the leaf the form's polynomials are off by their excess, twice for a plane of slope 1. Both
   * moved by a constant, which moves every coefficient by it, have their common root there: so it counts as an error
   * of coefficients. */
  t->form_error = t->nets.error * form->size + 2 * form->excess;
}

/* Stage 2: r and the sign variations of its coefficients. Lanes that may meet the leaf. */
static lane_mask trial_resultant(struct trial *t, lane_mask active)
{
  const int m = t->leaf->kept_degree, n = t->leaf->eliminated_degree;
  if (m == 3 && n == 3) bezout_lanes_resultant(3, 3, t->fa, t->fb, t->c_store);
  else bezout_lanes_resultant(m, n, t->fa, t->fb, t->c_store);
  t->c = t->c_store + t->leaf->zeros[0];
  t->degree = 2 * m * n - t->leaf->zeros[0] - t->leaf->zeros[1];
  const lanes product = t->alpha * t->beta, power = n == 1   ? product
                                                    : n == 2 ? product * product
                                                             : product * product * product;
  const lanes bound = RESULTANT_WEIGHT[n] * power *
                      (RESULTANT_ROUNDINGS * UNIT_ROUNDOFF + n * t->form_error * (1 / t->alpha + 1 / t->beta));
  lanes last = {0}, variations = {0};
  lane_mask doubt = {0};
  const int full = 2 * m * n;
  double choose = 1;
  for (int k = 0; k < t->leaf->zeros[0]; k++) choose = choose * (full - k) / (k + 1);
  for (int k = 0; k <= t->degree; k++) {
    const lanes c = t->c[k];
    doubt |= ~(lanes_abs(c) > choose * bound);
    variations += lanes_select(c * last < 0, lanes_all(1), lanes_all(0));
    last = lanes_select(c > 0, lanes_all(1), lanes_all(-1));
    const int at = k + t->leaf->zeros[0];
    choose = choose * (full - at) / (at + 1);
  }
  t->variations = lanes_select(doubt, lanes_all(-1), variations);
  return active & (t->variations != 0);
}

/* The value of the kept parameter where the control polygon of r crosses zero, improved by Newton on r. */
static lanes trial_root(const struct trial *t)
{
  const int d = t->degree;
  lanes at = lanes_all(0.5), before = t->c[0];
  double choose = 1;
  for (int k = 1; k <= d; k++) {
    choose = choose * (d - k + 1) / k;
    const lanes here = t->c[k] * (1 / choose);
    at = lanes_select(before * here < 0, (k - 1 + before / (before - here)) / d, at);
    before = here;
  }
  /* r(u) = (1-u)^d sum c_k x^k with x = u/(1-u); the half of the range near 1 reads the coefficients backwards. */
  const lane_mask back = at > 0.5;
  const lanes near = lanes_select(back, 1 - at, at);
  lanes x = near / (1 - near);
  for (int step = 0; step < RESULTANT_NEWTON_STEPS; step++) {
    lanes value = {0}, slope = {0};
    for (int k = d; k >= 0; k--) {
      slope = slope * x + value;
      value = value * x + lanes_select(back, t->c[d - k], t->c[k]);
    }
    x -= value / slope;
  }
  const lanes found = x / (1 + x);
  return lanes_select(back, 1 - found, found);
}

/* The eliminated parameter at a root of r. */
static lanes trial_eliminated(const struct trial *t, lanes kept)
{
  const int m = t->leaf->kept_degree, n = t->leaf->eliminated_degree;
  const lanes s = 1 - kept;
  lanes w[4], p[4] = {{0}}, q[4] = {{0}};
  if (m == 1) w[0] = s, w[1] = kept;
  else if (m == 2) w[0] = s * s, w[1] = 2 * (s * kept), w[2] = kept * kept;
  else w[0] = s * s * s, w[1] = 3 * (s * s * kept), w[2] = 3 * (s * kept * kept), w[3] = kept * kept * kept;
  for (int i = 0; i <= m; i++)
    for (int j = 0; j <= n; j++) p[j] += w[i] * t->fa[4 * i + j], q[j] += w[i] * t->fb[4 * i + j];
  lanes num[2], den[2], better;
  bezout_lanes_null_vector(n, p, q, num, den, &better);
  const lane_mask first = better > 0;
  return lanes_select(first, num[0], num[1]) / lanes_select(first, den[0], den[1]);
}

/* t within [0,1], or the middle where it is not a number. */
LANES_INLINE lanes start_within(lanes t)
{
  t = lanes_select(t == t, t, lanes_all(0.5));
  return lanes_min(lanes_max(t, lanes_all(0)), lanes_all(1));
}

/* x_k of the points (u,v). */
static lanes trial_place(const struct trial *t, lanes u, lanes v)
{
  lanes wu[4], wv[4], unused[4], w = {0};
  refine_weights(u, wu, unused);
  refine_weights(v, wv, unused);
  const double *x = t->leaf->x[t->axis];
  for (int i = 0; i < 4; i++)
    w += wu[i] * (x[4 * i] * wv[0] + x[4 * i + 1] * wv[1] + x[4 * i + 2] * wv[2] + x[4 * i + 3] * wv[3]);
  return w;
}

#endif
