/* The last Newton step. Compiled once per instruction set and without contraction.
 *
 * A root comes from a leaf's net, which is cut from the patch and rounded. Where the ray is steep, it is right to a few
 * last places; where the ray grazes, rounding is magnified. A Newton step on the patch itself makes all roots right to
 * the last places. Its residuals a(u,v), b(u,v) are as if computed in half as much precision again. The leading parts
 * have few bits on a common grid, so their sums are exact (as in Rump, Ogita and Oishi, Accurate Floating-Point
 * Summation, 2008, and Ozaki and others, Error-free transformations of matrix multiplication, 2012). That takes one
 * multiply-add a product, where sums that keep track of their error take ten. Roots near the ray's start use the
 * latter, on control points relative to the start.
 */
#include "intersect/lanes/last_step.h"

#include <string.h>

#include "base/double_lanes.h"

enum { LAST_STEPS_MAX = 3 };

/* A step longer than this, in patch parameters, is followed by another one: the derivatives that give point and normal
 * are off by about as much, relative to the second derivatives. */
#define LAST_STEP_LONGEST 0x1p-44

/* The same near the ray's start, where t is as short as 2^-44 of the patch (NEAREST_START): the step leaves its square
 * times the second derivatives. */
#define LAST_STEP_LONGEST_NEAR 0x1p-52

/* Splits a number of absolute value at most 1. The product of two heads, and a sum of such products up to 2, is then a
 * multiple of 2^-52 and exact. The tails add 2^-26 of it, and their rounding is smaller by as much. */
LANES_INLINE struct split_lanes last_step_split(struct double_lanes x)
{
  struct split_lanes split = split_lanes_of(x.hi);
  split.tail += x.lo;
  return split;
}

/* A patch's control net, split; coefficients are read one at a time, for all lanes. */
struct last_step_net {
  const double *x;
  double head[48], tail[48];
};

LANES_INLINE void last_step_split_net(const struct model_patch *patch, struct last_step_net *out)
{
  const double *rest = &patch->rest[0][0][0];
  out->x = &patch->x[0][0][0];
  for (int n = 0; n < 48; n += LANES) {
    lanes x, less;
    memcpy(&x, out->x + n, sizeof x), memcpy(&less, rest + n, sizeof less);
    const lanes head = split_lanes_head(x), tail = (x - head) + less;
    memcpy(out->head + n, &head, sizeof head), memcpy(out->tail + n, &tail, sizeof tail);
  }
}

/* Position as hi + lo, |lo| up to 2^-24, and derivatives at (u,v), in the patch's frame; and the way there from the
 * ray's start. */
struct last_step_jet {
  struct double_lanes s[3], way[3];
  lanes du[3], dv[3];
};

/* The weights w_i, cubic Bernstein polynomials, and their derivatives. */
LANES_INLINE void last_step_weights(lanes t, struct double_lanes w[4], lanes dw[4])
{
  const struct double_lanes s = double_lanes_sum(lanes_all(1), -t), tt = double_lanes_product(t, t);
  const struct double_lanes ss = double_lanes_multiply(s, s), three_t = double_lanes_product(lanes_all(3), t);
  w[0] = double_lanes_multiply(ss, s), w[1] = double_lanes_multiply(ss, three_t);
  w[2] = double_lanes_multiply(s, double_lanes_scale(tt, lanes_all(3))), w[3] = double_lanes_scale(tt, t);
  const lanes st = s.hi * t;
  dw[0] = -3 * ss.hi, dw[1] = 3 * (ss.hi - 2 * st), dw[2] = 3 * (2 * st - tt.hi), dw[3] = 3 * tt.hi;
}

/* Right to some 2^-76. */
LANES_INLINE void last_step_evaluate(const struct last_step_net *net, const struct double_lanes start[3], lanes u,
                                     lanes v, struct last_step_jet *out)
{
  struct double_lanes weight_u[4], weight_v[4];
  struct split_lanes wu[4], wv[4];
  lanes du[4], dv[4];
  last_step_weights(u, weight_u, du);
  last_step_weights(v, weight_v, dv);
  for (int i = 0; i < 4; i++) wu[i] = last_step_split(weight_u[i]), wv[i] = last_step_split(weight_v[i]);
  for (int c = 0; c < 3; c++) {
    lanes hi = {0}, lo = {0}, by_u = {0}, by_v = {0};
#pragma GCC unroll 4
    for (int i = 0; i < 4; i++) {
      lanes row_hi = {0}, row_lo = {0}, row_dv = {0};
#pragma GCC unroll 4
      for (int j = 0; j < 4; j++) {
        const int n = 16 * c + 4 * i + j;
        const lanes x = lanes_all(net->x[n]);
        row_hi = lanes_multiply_add(wv[j].head, lanes_all(net->head[n]), row_hi);
        row_lo = lanes_multiply_add(wv[j].head, lanes_all(net->tail[n]), lanes_multiply_add(wv[j].tail, x, row_lo));
        row_dv = lanes_multiply_add(dv[j], x, row_dv);
      }
      const struct split_lanes row = last_step_split((struct double_lanes){row_hi, row_lo});
      const lanes sum = row_hi + row_lo;
      hi = lanes_multiply_add(wu[i].head, row.head, hi);
      lo = lanes_multiply_add(wu[i].head, row.tail, lanes_multiply_add(wu[i].tail, sum, lo));
      by_u = lanes_multiply_add(du[i], sum, by_u);
      by_v = lanes_multiply_add(wu[i].head + wu[i].tail, row_dv, by_v);
    }
    out->s[c] = (struct double_lanes){hi, lo}, out->du[c] = by_u, out->dv[c] = by_v;
    out->way[c] = double_lanes_subtract(out->s[c], start[c]);
  }
}

/* last_step_evaluate on control points relative to the ray's start, in double-double: the way is right to some
 * 2^-100. */
static void last_step_evaluate_near(const struct model_patch *patch, const struct double_lanes start[3], lanes u,
                                    lanes v, struct last_step_jet *out)
{
  struct double_lanes wu[4], wv[4];
  lanes du[4], dv[4];
  last_step_weights(u, wu, du);
  last_step_weights(v, wv, dv);
  for (int c = 0; c < 3; c++) {
    struct double_lanes way = {{0}, {0}};
    lanes by_u = {0}, by_v = {0};
    for (int i = 0; i < 4; i++) {
      struct double_lanes row = {{0}, {0}};
      lanes row_dv = {0};
      for (int j = 0; j < 4; j++) {
        const struct double_lanes point = {lanes_all(patch->x[c][i][j]), lanes_all(patch->rest[c][i][j])};
        const struct double_lanes from_start = double_lanes_subtract(point, start[c]);
        row = double_lanes_add(row, double_lanes_multiply(wv[j], from_start));
        row_dv = lanes_multiply_add(dv[j], from_start.hi, row_dv);
      }
      way = double_lanes_add(way, double_lanes_multiply(wu[i], row));
      by_u = lanes_multiply_add(du[i], row.hi + row.lo, by_u), by_v = lanes_multiply_add(wu[i].hi, row_dv, by_v);
    }
    out->way[c] = way, out->s[c] = double_lanes_add(way, start[c]), out->du[c] = by_u, out->dv[c] = by_v;
  }
}

LANES_INLINE void last_step_normal(struct last_step *l, const struct last_step_jet *jet)
{
  lanes normal[3];
  l->tangent = surface_tangent(jet->du, jet->dv);
  surface_cross(jet->du, jet->dv, normal);
  l->done = surface_normal(normal, l->tangent, l->normal);
}

void last_step_take(struct last_step *l)
{
  const struct model_patch *patch = l->patch;
  const int k = l->axis, i = (k + 1) % 3, j = (k + 2) % 3;
  const lanes dk = l->direction[k], inverse = 1 / dk, ri = l->direction[i] * inverse, rj = l->direction[j] * inverse;
  const double to_local = 1 / patch->scale; /* a power of two */
  struct double_lanes start[3];
  for (int c = 0; c < 3; c++) {
    start[c] = double_lanes_sum(l->origin[c], lanes_all(-patch->center[c]));
    start[c].hi *= to_local, start[c].lo *= to_local;
  }
  lanes u = l->u, v = l->v, du, dv;
  struct last_step_net net;
  if (!l->near) last_step_split_net(patch, &net);
  struct last_step_jet jet;
  const struct double_lanes *way = jet.way;
  lane_mask moving = l->improves, again;
  for (int n = 0;; n++) {
    if (l->near) last_step_evaluate_near(patch, start, u, v, &jet);
    else last_step_evaluate(&net, start, u, v, &jet);
    lanes f[2], fu[2], fv[2];
    for (int s = 0; s < 2; s++) {
      const int at = s ? j : i;
      const struct double_lanes x = double_lanes_scale(way[at], dk), y = double_lanes_scale(way[k], l->direction[at]);
      const struct double_lanes difference = double_lanes_subtract(x, y);
      const lanes ratio = s ? rj : ri;
      f[s] = (difference.hi + difference.lo) * inverse;
      fu[s] = jet.du[at] - ratio * jet.du[k], fv[s] = jet.dv[at] - ratio * jet.dv[k];
    }
    const lanes determinant = 1 / (fu[0] * fv[1] - fv[0] * fu[1]);
    du = (fv[0] * f[1] - fv[1] * f[0]) * determinant, dv = (fu[1] * f[0] - fu[0] * f[1]) * determinant;
    const lanes size = lanes_max(lanes_abs(du), lanes_abs(dv));
    moving &= (lanes_abs(du) < 1) & (lanes_abs(dv) < 1);
    du = lanes_select(moving, du, lanes_all(0)), dv = lanes_select(moving, dv, lanes_all(0));
    again = moving & (size > (l->near ? LAST_STEP_LONGEST_NEAR : LAST_STEP_LONGEST));
    if (n + 1 == LAST_STEPS_MAX || !lanes_any(again)) break;
    /* A lane that is done stays where it is, so that its result does not depend on the others. */
    u = lanes_select(again, u + du, u), v = lanes_select(again, v + dv, v);
  }
  const lanes off = way[k].lo + (jet.du[k] * du + jet.dv[k] * dv), depth = way[k].hi + off;
  const lanes t = depth * inverse, left = off - lanes_product_error(t, dk, way[k].hi);
  l->t = lanes_select(moving, (t + left * inverse) * patch->scale, l->t);
  const lane_mask lost = l->improves & ~moving;
  l->u = lanes_clamp(lanes_select(lost, l->u, u + du), 0, 1);
  l->v = lanes_clamp(lanes_select(lost, l->v, v + dv), 0, 1);
  const lanes to_u = l->u - u, to_v = l->v - v;
  for (int c = 0; c < 3; c++) l->point[c] = jet.s[c].hi + (jet.s[c].lo + (jet.du[c] * to_u + jet.dv[c] * to_v));
  last_step_normal(l, &jet);
  l->done &= ~lost; /* the jet is elsewhere */
  if (l->near) l->done &= ~again;
}
