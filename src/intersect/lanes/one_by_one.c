/* The method that the scene asks for, lane by lane, and what can be proven of its roots.
 *
 * Compiled once per instruction set.
 */
#include <math.h>

#include "intersect/lanes/nearest.h"
#include "intersect/method.h"

/* The proven roots of one candidate. */
struct proven {
  int count, within; /* within: how many lie strictly inside the kept parameter's range */
  double u[METHOD_MAX_ROOTS], v[METHOD_MAX_ROOTS], radius_u[METHOD_MAX_ROOTS], radius_v[METHOD_MAX_ROOTS];
};

static void proven_add(struct proven *all, const struct candidate *it, const struct newton_root *r, int n)
{
  const double u = r->u[n], v = r->v[n], radius_u = r->radius_u[n], radius_v = r->radius_v[n];
  for (int k = 0; k < all->count; k++)
    if (fabs(all->u[k] - u) <= all->radius_u[k] + radius_u && fabs(all->v[k] - v) <= all->radius_v[k] + radius_v)
      return;
  const double kept = it->leaf->v_kept ? v : u, radius = it->leaf->v_kept ? radius_v : radius_u;
  all->within += kept > radius && 1 - kept > radius;
  const int k = all->count++;
  all->u[k] = u, all->v[k] = v, all->radius_u[k] = radius_u, all->radius_v[k] = radius_v;
}

/* Roots found by the solver, made exact by Newton, several at once: whether they are proven to be all that the leaf
 * has, because one of them is alone in it, or because they are as many as r has sign variations. */
static bool lane_prove(struct packet *p, const struct candidate *it, unsigned lane, const struct method_roots *roots)
{
  struct plane_nets one;
  for (int n = 0; n < 16; n++) one.a[n] = lanes_all(it->nets.a[n][lane]), one.b[n] = lanes_all(it->nets.b[n][lane]);
  for (int s = 0; s < 2; s++) one.slope[s] = lanes_all(it->nets.slope[s][lane]);
  one.error = lanes_all(it->nets.error[lane]);
  struct proven all = {.count = 0, .within = 0};
  bool alone = false;
  for (int first = 0; first < roots->count && !alone; first += LANES) {
    lanes u = lanes_all(0.5), v = lanes_all(0.5);
    lane_mask active = {0};
    for (int n = 0; n < LANES && first + n < roots->count; n++)
      u[n] = roots->u[first + n], v[n] = roots->v[first + n], active[n] = -1;
    const struct newton_root r = newton_refine(&one, it->leaf, u, v, active);
    const unsigned exists = lanes_bits(r.exists), only = lanes_bits(r.alone);
    if (only) all.count = 0, alone = true; /* whatever else was found is this root again */
    for (unsigned bits = alone ? only & -only : exists; bits; bits &= bits - 1)
      proven_add(&all, it, &r, __builtin_ctz(bits));
  }
  if (!alone && !(all.count > 0 && all.within == it->variations[lane])) return false;
  for (int k = 0; k < all.count; k++) {
    const struct newton_root r = {.u = lanes_all(all.u[k]),
                                  .v = lanes_all(all.v[k]),
                                  .radius_u = lanes_all(all.radius_u[k]),
                                  .radius_v = lanes_all(all.radius_v[k]),
                                  .exists = lanes_mask(1u << lane)};
    offer_root(p, it, &r, inside(&r));
  }
  return true;
}

static void lane_alone(struct packet *p, const struct candidate *it, unsigned lane)
{
  struct tracer *tracer = p->tracer;
  double a[16], b[16];
  for (int i = 0; i <= it->leaf->kept_degree; i++)
    for (int j = 0; j <= it->leaf->eliminated_degree; j++)
      a[4 * i + j] = it->fa[4 * i + j][lane], b[4 * i + j] = it->fb[4 * i + j][lane];
  struct method_roots roots;
  method_solve(tracer, it->patch->method, it->leaf, it->number, a, b, it->form_error[lane], &roots);
  if (it->patch->method->polish) {
    if (!lane_prove(p, it, lane, &roots)) packet_postpone(p, it->leaf, lanes_mask(1u << lane));
    return;
  }
  for (int n = 0; n < roots.count; n++)
    if (roots.u[n] >= 0 && roots.u[n] <= 1 && roots.v[n] >= 0 && roots.v[n] <= 1)
      offer_unproven(p, it, lanes_all(roots.u[n]), lanes_all(roots.v[n]), lanes_mask(1u << lane));
}

lane_mask stage_method(struct packet *p, struct candidate *it, lane_mask open)
{
  for (unsigned bits = lanes_bits(open); bits; bits &= bits - 1) lane_alone(p, it, (unsigned)__builtin_ctz(bits));
  return (lane_mask){0};
}
