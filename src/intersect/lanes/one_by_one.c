/* The scene's method, lane by lane: if its form does not run on lanes, or without polish.
 *
 * Compiled once per instruction set.
 */
#include <limits.h>

#include "intersect/lanes/nearest.h"
#include "intersect/method.h"

/* If the roots are the answer and nothing else decides the leaf, this part of a step's products is charged: the paper's
 * form takes thousands of steps for a leaf. */
#define BARE_COST 0x1p-4

/* Finds the roots on one lane, with as many steps as the budget has left. A step of one root has some products for each
 * coefficient of r. */
static void lane_solve(const struct packet *p, const struct candidate *it, unsigned lane, struct method_roots *out)
{
  const struct method *method = it->patch->method;
  struct method_planes planes = {.form = &it->form};
  const int64_t left = p->postponed->left[lane];
  out->count = 0;
  if (left < 0 || tracer_stopped(p->tracer)) return;
  for (int i = 0; i <= it->form.kept_degree; i++)
    for (int j = 0; j <= it->form.eliminated_degree; j++)
      planes.a[4 * i + j] = it->fa[4 * i + j][lane], planes.b[4 * i + j] = it->fb[4 * i + j][lane];
  const double degree = 2 * it->form.kept_degree * it->form.eliminated_degree,
               step = degree * (method->polish ? 1.0 : BARE_COST) / PRODUCTS_A_UNIT; /* its cost */
  const double most = (double)left / (step * degree);                                /* of each root */
  method_find(method, &planes, most < INT_MAX ? (int)most : INT_MAX, tracer_warm(p->tracer, method, it->number), out,
              explain_roots(p->tracer));
  p->tracer->counts.roots_found += (unsigned)out->found;
  lane_mask cost = {0};
  cost[lane] = (int64_t)(step * out->steps);
  packet_charge(p, cost);
}

void method_starts(const struct packet *p, const struct candidate *it, lane_mask open, struct root_starts *out)
{
  for (unsigned bits = lanes_bits(open); bits; bits &= bits - 1) {
    const unsigned lane = (unsigned)__builtin_ctz(bits);
    struct method_roots roots;
    lane_solve(p, it, lane, &roots);
    const int count = roots.count < TRIED_ROOTS ? roots.count : TRIED_ROOTS;
    for (int k = 0; k < count; k++) out->u[k][lane] = roots.u[k], out->v[k][lane] = roots.v[k], out->has[k][lane] = -1;
    out->count = out->count > count ? out->count : count;
  }
}

lane_mask stage_bare_roots(struct packet *p, struct candidate *it, lane_mask open)
{
  for (unsigned bits = lanes_bits(open); bits; bits &= bits - 1) {
    const unsigned lane = (unsigned)__builtin_ctz(bits);
    struct method_roots roots;
    lane_solve(p, it, lane, &roots);
    for (int n = 0; n < roots.count; n++)
      if (roots.u[n] >= 0 && roots.u[n] <= 1 && roots.v[n] >= 0 && roots.v[n] <= 1)
        offer_unproven(p, it, lanes_all(roots.u[n]), lanes_all(roots.v[n]), lanes_mask(1u << lane));
  }
  return (lane_mask){0};
}
