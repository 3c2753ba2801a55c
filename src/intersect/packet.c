/* A packet of rays, one a lane, against the leaves of the hierarchy.
 *
 * Compiled once per instruction set.
 *
 * A candidate (a ray and a leaf whose box it passes) is decided in stages, each for all lanes at once, each able to
 * end it:
 *   1. the box along the leaf; then plane polynomials a, b: if either, or a combination, keeps one sign on its whole
 *      net, the leaf is missed;
 *   2. Bezout's resultant r in Bernstein form, no sign variation: missed; one: exactly one root in the leaf's range;
 *      of a nearly bilinear leaf before that the resultant of its bilinear part, of degree 2, only for a start;
 *   3. that root by Newton from the control polygon of r, v from the null vector, both by Newton on (a, b);
 *   4. the Newton-Kantorovich test: one root, here, and no other in the leaf.
 * With Aberth's method instead of 3 and 4 all roots of r, and boxes (all_roots.h). What is left goes lane by lane to
 * subdivision; with another solver to that first (candidate.c).
 */
#include <assert.h>
#include <math.h>
#include <stddef.h>
#include <string.h>

#include "intersect/all_roots.h"
#include "intersect/packet.h"
#include "intersect/refine.h"
#include "intersect/surface.h"
#include "intersect/trial.h"

/* A ray is eight doubles in a row. */
enum { RAY_STRIDE = sizeof(struct ray) / sizeof(double) };
static_assert(RAY_STRIDE == 8 && offsetof(struct ray, direction) == 3 * sizeof(double) &&
                offsetof(struct ray, t_min) == 6 * sizeof(double), "read as two fours");

void packet_start(struct packet *p, struct tracer *tracer, const struct ray *rays, size_t count, bool any,
                  struct postponed *postponed)
{
  p->postponed = postponed;
  postponed->cut_off = 0;
  memset(postponed->count, 0, sizeof postponed->count);
  p->tracer = tracer, p->model = tracer->model, p->rays = rays, p->count = count, p->any = any;
  p->outer = NULL, p->net_error = 0, p->t_error = lanes_all(0);
  p->live = lanes_mask((1u << count) - 1);
  lanes *o = p->origin, *d = p->direction;
  lanes_load4(rays->origin, RAY_STRIDE, &o[0], &o[1], &o[2], &d[0]);
  lanes_load4(&rays->direction[1], RAY_STRIDE, &d[1], &d[2], &p->t_min, &p->t_max);
  p->t_far = p->t_max;
  packet_orient(p);
}

void packet_orient(struct packet *p)
{
  lanes size[3];
  for (int k = 0; k < 3; k++) size[k] = lanes_abs(p->direction[k]);
  p->moved = false, p->patch = UINT32_MAX;
  p->longest = lanes_max(lanes_max(size[0], size[1]), size[2]);
  /* As dominant_axis has it. */
  const lane_mask first = (size[0] >= size[1]) & (size[0] >= size[2]), second = ~first & (size[1] >= size[2]);
  p->on_axis[0] = p->live & first, p->on_axis[1] = p->live & second, p->on_axis[2] = p->live & ~first & ~second;
  p->axes = 0;
  for (int k = 0; k < 3; k++) {
    if (!lanes_any(p->on_axis[k])) continue;
    p->axes |= 1u << k;
    p->reciprocal[k] = 1 / p->direction[k];
    for (int s = 0; s < 2; s++) {
      const lanes d = p->direction[(k + 1 + s) % 3], slope = d * p->reciprocal[k];
      p->slope[k][s] = lanes_select(p->on_axis[k], slope, lanes_all(0));
      p->slope_rest[k][s] = -lanes_product_error(slope, p->direction[k], d) * p->reciprocal[k];
    }
  }
  p->best.u = p->best.v = p->best.radius_u = p->best.radius_v = lanes_all(0), p->best.t = lanes_all(INFINITY);
  p->best.patch = p->best.leaf = NO_PATCH + (lane_mask){0};
  p->best.certain = p->best.final = p->best.doubt = (lane_mask){0};
}

/* ---- keeping the nearest ---- */

void packet_postpone(struct packet *p, const struct leaf *leaf, lane_mask open)
{
  struct postponed *to = p->postponed;
  const struct exact_region region = {p->outer ? NULL : leaf, leaf->patch + (p->outer ? p->copy->first_patch : 0),
                                      {leaf->column_u, leaf->column_v}, {1, 1}};
  for (unsigned bits = lanes_bits(open); bits; bits &= bits - 1) {
    const unsigned lane = (unsigned)__builtin_ctz(bits), count = to->count[lane];
    if (count == EXACT_REGIONS_MAX) to->cut_off |= 1u << lane;
    else if (count == 0 || !exact_region_equal(&to->region[lane][count - 1], &region))
      to->region[lane][to->count[lane]++] = region;
  }
  p->tracer->counts.escalated += (unsigned)__builtin_popcount(lanes_bits(open));
}

/* Lanes whose root may lie on a border of the patch. */
static lane_mask on_border(const struct trial *t, const struct refined *r)
{
  const int last = t->patch->split - 1;
  lane_mask border = {0};
  if (t->leaf->column_u == 0) border |= r->u <= r->radius_u;
  if (t->leaf->column_u == last) border |= 1 - r->u <= r->radius_u;
  if (t->leaf->column_v == 0) border |= r->v <= r->radius_v;
  if (t->leaf->column_v == last) border |= 1 - r->v <= r->radius_v;
  return border;
}

/* The place on the ray of x_k = w. */
LANES_INLINE lanes place_on_ray(const struct packet *p, int axis, lanes w)
{
  const lanes *start = p->local[axis].start;
  return ((w + start[1]) + start[0]) * p->local[axis].to_t;
}

/* The bound on the error of a proven root's place: how far its radii let x_k move, and the roundings of x_k and t. */
LANES_INLINE lanes place_error(const struct packet *p, const struct trial *t, const struct refined *r, lanes w, lanes at)
{
  const lanes size = lanes_abs(p->local[t->axis].to_t);
  return size * (t->leaf->first[0] * r->radius_u + t->leaf->first[1] * r->radius_v + p->local[t->axis].error) +
         8 * UNIT_ROUNDOFF * (lanes_abs(at) + size * lanes_abs(w)) + p->t_error;
}

LANES_INLINE void packet_take(struct packet *p, const struct trial *t, const struct refined *r, lanes at, lanes error,
                              lane_mask taken)
{
  const int64_t leaf = t->number, patch = t->leaf->patch + (p->outer ? p->copy->first_patch : 0);
  const double part = 1.0 / t->patch->split;
  const lanes place[2] = {(t->leaf->column_u + r->u) * part, (t->leaf->column_v + r->v) * part};
  const lanes radius[2] = {r->radius_u * part + UNIT_ROUNDOFF, r->radius_v * part + UNIT_ROUNDOFF};
  const lane_mask none = {0};
  best_take(&p->best, taken, place, radius, at, patch + none, leaf + none);
  p->t_far = lanes_select(taken, at + error, p->t_far);
  if (p->any) p->live &= ~taken;
  p->moved = true;
  p->tracer->counts.roots_accepted += (unsigned)__builtin_popcount(lanes_bits(taken));
}

/* Proven roots of several lanes, at x_k = w and on the ray at `at`, become the best where they come before it. One
 * that may lie on a border of the patch, at an end of the ray or where another patch's is, is left to the last resort.
 * Returns the lanes that took theirs. */
static lane_mask packet_offer(struct packet *p, const struct trial *t, const struct refined *r, lanes w, lanes at,
                              lane_mask hits)
{
  const int64_t leaf = t->number, patch = t->leaf->patch + (p->outer ? p->copy->first_patch : 0);
  const lanes error = place_error(p, t, r, w, at);
  hits &= ~((at < p->t_min - error) | (at - error > lanes_min(p->t_max, p->t_far)));
  if (!lanes_any(hits)) return hits;
  const lane_mask rival = (p->best.patch != patch) & (lanes_abs(at - p->best.t) <= error + (p->t_far - p->best.t));
  const lane_mask sure = ~on_border(t, r) & (at > p->t_min + error) & (at < p->t_max - error) & ~rival;
  if (lanes_any(hits & ~sure)) packet_postpone(p, t->leaf, hits & ~sure);
  const lane_mask none = {0};
  const lane_mask taken = hits & sure & best_after(&p->best, at, patch + none, leaf + none);
  if (lanes_any(taken)) packet_take(p, t, r, at, error, taken);
  return taken;
}

static void packet_offer_refined(struct packet *p, const struct trial *t, const struct refined *r, lane_mask hits)
{
  if (!lanes_any(hits)) return;
  const lanes w = trial_place(t, r->u, r->v);
  packet_offer(p, t, r, w, place_on_ray(p, t->axis, w), hits);
}

/* The same for points in the leaf that nobody has proven anything of. */
static void packet_offer_unproven(struct packet *p, const struct trial *t, lanes u, lanes v, lane_mask hits)
{
  const struct refined r = {.u = u, .v = v};
  const lanes w = trial_place(t, u, v), at = place_on_ray(p, t->axis, w), error = place_error(p, t, &r, w, at);
  const lane_mask behind = at > p->t_min + error, none = {0};
  p->best.doubt |= hits & ~behind & ~(at < p->t_min - error);
  const lane_mask taken = hits & behind & (at < p->t_max) &
                          best_after(&p->best, at, t->leaf->patch + none, t->number + none);
  if (!lanes_any(taken)) return;
  packet_take(p, t, &r, at, error, taken);
  p->best.certain &= ~taken;
}

/* Keeps what a leaf's root says of the surface. */
static void packet_keep(struct packet *p, const struct model_patch *patch, const struct leaf_root *root,
                        lane_mask taken)
{
  struct best *best = &p->best;
  lanes normal[3];
  surface_cross(root->su, root->sv, normal);
  const lanes tangent = surface_tangent(root->su, root->sv);
  const struct surface_point point = surface_point(patch, root->point, patch->split * tangent);
  for (int c = 0; c < 3; c++) {
    best->point.at[c] = lanes_select(taken, point.at[c], best->point.at[c]);
    best->normal[c] = lanes_select(taken, normal[c], best->normal[c]);
  }
  best->tangent = lanes_select(taken, tangent, best->tangent);
  best->point.error = lanes_select(taken, point.error, best->point.error);
  best->point.clearance = lanes_select(taken, point.clearance, best->point.clearance);
  best->final |= taken & (lanes_abs(root->t) * p->longest >= NEAR_START_FINAL * patch->scale);
}

static void packet_offer_root(struct packet *p, const struct trial *t, const struct leaf_root *root, lane_mask hits)
{
  if (!lanes_any(hits)) return;
  const lane_mask taken = packet_offer(p, t, &root->at, root->w, root->t, hits);
  if (t->leaf->parts->exact && !p->any && !p->outer && lanes_any(taken)) packet_keep(p, t->patch, root, taken);
}

LANES_INLINE lane_mask inside(const struct refined *r)
{
  return r->exists & (r->u >= -r->radius_u) & (r->u - 1 <= r->radius_u) & (r->v >= -r->radius_v) &
         (r->v - 1 <= r->radius_v);
}

/* ---- lane by lane: the scene's solver, then subdivision ---- */

/* The proven roots of one candidate. */
struct proven {
  int count, within; /* within: how many lie strictly inside the kept parameter's range */
  double u[CANDIDATE_MAX_ROOTS], v[CANDIDATE_MAX_ROOTS], radius_u[CANDIDATE_MAX_ROOTS], radius_v[CANDIDATE_MAX_ROOTS];
};

static void proven_add(struct proven *all, const struct trial *t, const struct refined *r, int n)
{
  const double u = r->u[n], v = r->v[n], radius_u = r->radius_u[n], radius_v = r->radius_v[n];
  for (int k = 0; k < all->count; k++)
    if (fabs(all->u[k] - u) <= all->radius_u[k] + radius_u && fabs(all->v[k] - v) <= all->radius_v[k] + radius_v) return;
  const double kept = t->leaf->v_kept ? v : u, radius = t->leaf->v_kept ? radius_v : radius_u;
  all->within += kept > radius && 1 - kept > radius;
  const int k = all->count++;
  all->u[k] = u, all->v[k] = v, all->radius_u[k] = radius_u, all->radius_v[k] = radius_v;
}

/* Roots found by the solver, made exact by Newton, several at once: whether they are proven to be all that the leaf
 * has, because one of them is alone in it, or because they are as many as r has sign variations. */
static bool lane_prove(struct packet *p, const struct trial *t, unsigned lane, const struct candidate_roots *roots)
{
  struct plane_nets one;
  for (int n = 0; n < 16; n++) one.a[n] = lanes_all(t->nets.a[n][lane]), one.b[n] = lanes_all(t->nets.b[n][lane]);
  for (int s = 0; s < 2; s++) one.slope[s] = lanes_all(t->nets.slope[s][lane]);
  one.error = lanes_all(t->nets.error[lane]);
  struct proven all = {.count = 0, .within = 0};
  bool alone = false;
  for (int first = 0; first < roots->count && !alone; first += LANES) {
    lanes u = lanes_all(0.5), v = lanes_all(0.5);
    lane_mask active = {0};
    for (int n = 0; n < LANES && first + n < roots->count; n++)
      u[n] = roots->u[first + n], v[n] = roots->v[first + n], active[n] = -1;
    const struct refined r = refine(&one, t->leaf, u, v, active);
    const unsigned exists = lanes_bits(r.exists), only = lanes_bits(r.alone);
    if (only) all.count = 0, alone = true; /* whatever else was found is this root again */
    for (unsigned bits = alone ? only & -only : exists; bits; bits &= bits - 1)
      proven_add(&all, t, &r, __builtin_ctz(bits));
  }
  if (!alone && !(all.count > 0 && all.within == t->variations[lane])) return false;
  for (int k = 0; k < all.count; k++) {
    const struct refined r = {.u = lanes_all(all.u[k]), .v = lanes_all(all.v[k]), .radius_u = lanes_all(all.radius_u[k]),
                              .radius_v = lanes_all(all.radius_v[k]), .exists = lanes_mask(1u << lane)};
    packet_offer_refined(p, t, &r, inside(&r));
  }
  return true;
}

static void lane_alone(struct packet *p, const struct trial *t, unsigned lane)
{
  struct tracer *tracer = p->tracer;
  double a[16], b[16];
  for (int i = 0; i <= t->leaf->kept_degree; i++)
    for (int j = 0; j <= t->leaf->eliminated_degree; j++)
      a[4 * i + j] = t->fa[4 * i + j][lane], b[4 * i + j] = t->fb[4 * i + j][lane];
  struct candidate_roots roots;
  candidate_solve(tracer, t->leaf, a, b, t->form_error[lane], &roots);
  if (t->patch->solver->polish) {
    if (!lane_prove(p, t, lane, &roots)) packet_postpone(p, t->leaf, lanes_mask(1u << lane));
    return;
  }
  for (int n = 0; n < roots.count; n++)
    if (roots.u[n] >= 0 && roots.u[n] <= 1 && roots.v[n] >= 0 && roots.v[n] <= 1)
      packet_offer_unproven(p, t, lanes_all(roots.u[n]), lanes_all(roots.v[n]), lanes_mask(1u << lane));
}

/* Stages 3 and 4. Lanes that are left undecided. Where r has several sign variations, the start is one of its roots,
 * or none; what is found from it still decides the leaf where it is proven to be alone. */
static lane_mask trial_first_root(struct packet *p, const struct trial *t, lane_mask active)
{
  if (!lanes_any(active)) return active;
  p->tracer->counts.roots_found += (unsigned)__builtin_popcount(lanes_bits(active));
  const lanes kept = start_within(trial_root(t)), eliminated = start_within(trial_eliminated(t, kept));
  const bool v_kept = t->leaf->v_kept;
  const struct refined r = refine(&t->nets, t->leaf, v_kept ? eliminated : kept, v_kept ? kept : eliminated, active);
  const lanes k = v_kept ? r.v : r.u, radius = v_kept ? r.radius_v : r.radius_u;
  /* One sign variation: r has one root in the open range, so a root of (a, b) strictly within it is the only one. */
  const lane_mask single = (t->variations == 1) & r.exists & (k > radius) & (1 - k > radius);
  const lane_mask decided = active & (r.alone | single);
  packet_offer_refined(p, t, &r, decided & inside(&r));
  return active & ~decided;
}

/* Stages 2 to 4 of a nearly bilinear leaf, by a resultant of the least degree. Lanes that are left undecided: where
 * the ray is so slanted that the leaf's curvature matters, the resultant of its full degree has its turn. */
static lane_mask trial_bilinear(struct packet *p, const struct trial *t, lane_mask active)
{
  struct leaf_root root;
  leaf_root_solve(p, t->leaf, t->axis, NULL, active, &root);
  p->tracer->counts.roots_found += (unsigned)__builtin_popcount(lanes_bits(root.at.alone));
  packet_offer_root(p, t, &root, root.at.alone & inside(&root.at));
  return active & ~root.at.alone;
}

/* Stages 3 and 4 with all roots of r. Lanes that are left undecided. */
static lane_mask trial_all_roots(struct packet *p, const struct trial *t, lane_mask active)
{
  struct all_roots all;
  if (!lanes_any(active)) return active;
  const lane_mask decided = all_roots_find(p, t, active, &all);
  for (int k = 0; k < all.count; k++) {
    const lane_mask hits = decided & all.proven[k] & inside(&all.root[k].at);
    if (t->leaf->parts) packet_offer_root(p, t, &all.root[k], hits);
    else packet_offer_refined(p, t, &all.root[k].at, hits);
  }
  return active & ~decided;
}

static void packet_try(struct packet *p, struct trial *t, lane_mask active)
{
  const bool paper = !t->patch->solver->polish;
  if (!paper) active = trial_slabs(p, t, active);
  if (!lanes_any(active)) return;
  p->tracer->counts.patches_tested += (unsigned)__builtin_popcount(lanes_bits(active));
  if (t->leaf->parts && !t->patch->all_roots) {
    active = trial_bilinear(p, t, active);
    if (!lanes_any(active)) return;
  }
  trial_nets(p, t);
  lane_mask near = trial_planes(t, active);
  if (lanes_any(near)) near = trial_aligned(t, near);
  active = paper ? active : near;
  if (!lanes_any(active)) return;
  trial_form(p, t);
  lane_mask left = active;
  t->variations = lanes_all(-1);
  if (t->patch->solver->polish) left = trial_resultant(t, active);
  if (t->patch->lanes) left = t->patch->all_roots ? trial_all_roots(p, t, left) : trial_first_root(p, t, left);
  if (t->patch->lanes) {
    if (lanes_any(left)) packet_postpone(p, t->leaf, left);
    return;
  }
  for (unsigned bits = lanes_bits(left); bits; bits &= bits - 1) lane_alone(p, t, (unsigned)__builtin_ctz(bits));
}

void packet_leaf(struct packet *p, uint32_t index, lane_mask active)
{
  struct trial t;
  t.leaf = &p->model->leaves[index], t.number = index;
  t.patch = &p->model->patches[t.leaf->patch];
  if (p->patch != t.leaf->patch) packet_set_patch(p, t.leaf->patch);
  for (unsigned bits = p->axes; bits; bits &= bits - 1) {
    t.axis = __builtin_ctz(bits);
    const lane_mask here = active & p->on_axis[t.axis];
    if (lanes_any(here)) packet_try(p, &t, here);
  }
}
