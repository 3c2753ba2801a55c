/* The last Newton step. Compiled once per instruction set and without contraction.
 *
 * A root comes from a leaf's net, which is cut from the patch and rounded. Where the ray is steep, it is right to a few
 * last places; where the ray grazes, rounding is magnified. A Newton step on the patch itself makes all roots right to
 * the last places. Its residuals a(u,v), b(u,v) are computed in double-double, from control points relative to the ray's
 * start, so that roots near the start keep their digits, too.
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

/* Position and derivatives at (u,v), in the patch's frame; and the way there from the ray's start. */
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

/* Evaluates control points relative to the ray's start, in double-double: the way is right to some 2^-100. */
static void last_step_evaluate(const struct model_patch *patch, const struct double_lanes start[3], lanes u, lanes v,
                               struct last_step_jet *out)
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
  struct last_step_jet jet;
  const struct double_lanes *way = jet.way;
  const lanes longest = lanes_select(l->near, lanes_all(LAST_STEP_LONGEST_NEAR), lanes_all(LAST_STEP_LONGEST));
  lane_mask moving = l->improves, again;
  for (int n = 0;; n++) {
    last_step_evaluate(patch, start, u, v, &jet);
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
    again = moving & (size > longest);
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
  l->done &= ~lost & ~(again & l->near); /* where they are lost, the jet is elsewhere */
}
