/* Newton's process on the plane polynomials of a leaf. See newton.h.
 *
 * Compiled once per instruction set.
 */
#include "intersect/lanes/newton.h"

struct newton_root newton_refine(const struct plane_nets *nets, const struct leaf *leaf, lanes u, lanes v,
                                 lane_mask active)
{
  struct newton_root r = {.u = u, .v = v};
  struct newton_inverse m = {{0}, {0}, {0}, {0}};
  lanes step = lanes_all(NEWTON_START);
  lane_mask moving = active, settled = {0};
  for (int n = 0; n < NEWTON_MAX_STEPS && lanes_any(moving); n++) {
    lanes wu[4], du[4], wv[4], dv[4];
    newton_weights(r.u, wu, du);
    newton_weights(r.v, wv, dv);
    const struct newton_jet a = newton_evaluate(nets->a, wu, du, wv, dv), b = newton_evaluate(nets->b, wu, du, wv, dv);
    const lanes inverse = 1 / (a.du * b.dv - a.dv * b.du);
    m.ua = lanes_select(moving, b.dv * inverse, m.ua), m.ub = lanes_select(moving, -a.dv * inverse, m.ub);
    m.va = lanes_select(moving, -b.du * inverse, m.va), m.vb = lanes_select(moving, a.du * inverse, m.vb);
    const lanes step_u = m.ua * a.value + m.ub * b.value, step_v = m.va * a.value + m.vb * b.value;
    r.u = lanes_select(moving, r.u - step_u, r.u);
    r.v = lanes_select(moving, r.v - step_v, r.v);
    const lanes here = lanes_max(lanes_abs(step_u), lanes_abs(step_v)), before = step * step;
    step = lanes_select(moving, here, step);
    settled |= moving & (here * here * here <= NEWTON_NEXT_STEP * before);
    /* A root far outside the leaf, or no progress (NaN compares false), is no concern of this process. */
    moving &= ~settled & (lanes_abs(r.u - 0.5) < 2) & (lanes_abs(r.v - 0.5) < 2);
  }
  newton_prove(leaf, &m, nets->slope, nets->error, step, settled, &r);
  return r;
}
