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

#include "intersect/all_roots.h"
#include "intersect/leaf.h"
#include "intersect/packet.h"
#include "intersect/refine.h"
#include "intersect/subdivide.h"
#include "intersect/surface.h"
#include "intersect/trial.h"

/* A ray is eight doubles in a row. */
enum { RAY_STRIDE = sizeof(struct ray) / sizeof(double) };
static_assert(RAY_STRIDE == 8 && offsetof(struct ray, direction) == 3 * sizeof(double) &&
                offsetof(struct ray, t_min) == 6 * sizeof(double), "read as two fours");

void packet_start(struct packet *p, struct tracer *tracer, const struct ray *rays, size_t count, bool any)
{
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
  p->best.certain = p->best.sharp = p->best.final = p->best.doubt = (lane_mask){0};
}

/* ---- keeping the nearest ---- */

/* The root at x_k = w on a lane, whose place on the ray it sets. */
static struct leaf_hit packet_root(const struct packet *p, unsigned lane, const struct trial *at,
                                   const struct refined *r, unsigned n, double w)
{
  const int axis = at->axis;
  const double t = ((w + p->local[axis].start[1][lane]) + p->local[axis].start[0][lane]) * p->local[axis].to_t[lane];
  struct leaf_hit root = {r->u[n], r->v[n], r->radius_u[n], r->radius_v[n], w, t, 0, true, false};
  root.t_error = leaf_hit_t_error(at->leaf, &root, p->local[axis].to_t[lane]);
  return root;
}

/* Makes a root the answer so far where it comes before the best, as best_after() has it. */
static void packet_offer(struct packet *p, unsigned lane, const struct trial *t, struct leaf_hit *root)
{
  struct best *best = &p->best;
  const int split = t->patch->split;
  const int64_t leaf = t->number, patch = t->leaf->patch;
  const enum leaf_hit_side side = leaf_hit_side(p->model, t->leaf, &p->rays[lane], root);
  if (side == SIDE_UNKNOWN) best->doubt[lane] = -1;
  if (side != SIDE_BEHIND || !(root->t < p->t_max[lane])) return;
  const lane_mask none = {0}, before = best_after(best, lanes_all(root->t), patch + none, leaf + none);
  if (!before[lane]) return;
  best->u[lane] = leaf_to_patch(split, t->leaf->column_u, root->u), best->radius_u[lane] = root->radius_u / split;
  best->v[lane] = leaf_to_patch(split, t->leaf->column_v, root->v), best->radius_v[lane] = root->radius_v / split;
  best->t[lane] = root->t, best->patch[lane] = patch, best->leaf[lane] = leaf,
  best->certain[lane] = root->certain ? -1 : 0;
  best->sharp[lane] = root->sharp ? -1 : 0, best->final[lane] = 0;
  p->t_far[lane] = root->t + root->t_error;
  if (p->any) p->live[lane] = 0;
  p->moved = true;
  p->tracer->counts.roots_accepted++;
}

static void lane_subdivide_outside(struct packet *p, const struct trial *t, unsigned lane);

/* Lanes whose root may lie on a border of the patch. */
static lane_mask on_border(const struct trial *t, const struct refined *r)
{
  const int last = t->patch->split - 1;
  lane_mask border = {0};
  if (t->leaf->column_u == 0) border |= r->u < r->radius_u;
  if (t->leaf->column_u == last) border |= r->u > 1 - r->radius_u;
  if (t->leaf->column_v == 0) border |= r->v < r->radius_v;
  if (t->leaf->column_v == last) border |= r->v > 1 - r->radius_v;
  return border;
}

/* The same for the roots of several lanes at once, at x_k = w and on the ray at `at`; those next to t_min go the
 * other way. Returns the lanes that took theirs. */
static lane_mask packet_offer_lanes(struct packet *p, const struct trial *t, const struct refined *r, lanes w, lanes at,
                                    lane_mask hits)
{
  const int64_t leaf = t->number, patch = t->leaf->patch + (p->outer ? p->copy->first_patch : 0);
  const double part = 1.0 / t->patch->split;
  const lanes size = lanes_abs(p->local[t->axis].to_t),
              error = size * (t->leaf->first[0] * r->radius_u + t->leaf->first[1] * r->radius_v) +
                      8 * UNIT_ROUNDOFF * (lanes_abs(at) + size * lanes_abs(w)) + p->t_error;
  const lane_mask behind = at > p->t_min + error, unknown = hits & ~behind & ~(at < p->t_min - error);
  if (p->outer) {
    const lane_mask outside = hits & (unknown | on_border(t, r));
    for (unsigned bits = lanes_bits(outside); bits; bits &= bits - 1)
      lane_subdivide_outside(p, t, (unsigned)__builtin_ctz(bits));
    hits &= ~outside;
  } else {
    for (unsigned bits = lanes_bits(unknown); bits; bits &= bits - 1) {
      const unsigned lane = (unsigned)__builtin_ctz(bits);
      struct leaf_hit root = packet_root(p, lane, t, r, lane, w[lane]);
      packet_offer(p, lane, t, &root);
    }
  }
  const lane_mask none = {0}, patches = patch + none, leaves = leaf + none;
  const lane_mask taken = hits & behind & (at < p->t_max) & best_after(&p->best, at, patches, leaves);
  if (!lanes_any(taken)) return taken;
  const lanes place[2] = {(t->leaf->column_u + r->u) * part, (t->leaf->column_v + r->v) * part};
  const lanes radius[2] = {r->radius_u * part, r->radius_v * part};
  best_take(&p->best, taken, place, radius, at, patches, leaves);
  p->t_far = lanes_select(taken, at + error, p->t_far);
  if (p->any) p->live &= ~taken;
  p->moved = true;
  p->tracer->counts.roots_accepted += (unsigned)__builtin_popcount(lanes_bits(taken));
  return taken;
}

static void packet_offer_refined(struct packet *p, const struct trial *t, const struct refined *r, lane_mask hits)
{
  if (!lanes_any(hits)) return;
  const lanes w = trial_place(t, r->u, r->v), *start = p->local[t->axis].start;
  packet_offer_lanes(p, t, r, w, ((w + start[1]) + start[0]) * p->local[t->axis].to_t, hits);
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
  best->final |= taken;
}

static void packet_offer_root(struct packet *p, const struct trial *t, const struct leaf_root *root, lane_mask hits)
{
  if (!lanes_any(hits)) return;
  const lane_mask taken = packet_offer_lanes(p, t, &root->at, root->w, root->t, hits);
  if (t->leaf->parts->exact && !p->any && !p->outer && lanes_any(taken)) packet_keep(p, t->patch, root, taken);
}

LANES_INLINE lane_mask inside(const struct refined *r)
{
  return r->exists & (r->u >= -r->radius_u) & (r->u <= 1 + r->radius_u) & (r->v >= -r->radius_v) &
         (r->v <= 1 + r->radius_v);
}

/* ---- lane by lane: the scene's solver, then subdivision ---- */

/* The proven roots of one candidate. */
struct proven {
  int count, within; /* within: how many lie strictly inside the kept parameter's range */
  struct leaf_hit root[CANDIDATE_MAX_ROOTS];
  bool inside[CANDIDATE_MAX_ROOTS];
};

static void proven_add(struct proven *all, const struct trial *t, const struct leaf_hit *added, bool in_leaf)
{
  const struct leaf_hit root = *added;
  for (int k = 0; k < all->count; k++) {
    const struct leaf_hit *old = &all->root[k];
    if (fabs(old->u - root.u) <= old->radius_u + root.radius_u &&
        fabs(old->v - root.v) <= old->radius_v + root.radius_v)
      return;
  }
  const double kept = t->leaf->v_kept ? root.v : root.u, radius = t->leaf->v_kept ? root.radius_v : root.radius_u;
  all->within += kept > radius && kept < 1 - radius;
  all->inside[all->count] = in_leaf;
  all->root[all->count++] = root;
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
    const lanes w = trial_place(t, r.u, r.v);
    const unsigned in_leaf = lanes_bits(inside(&r)), exists = lanes_bits(r.exists), only = lanes_bits(r.alone);
    if (only) all.count = 0, alone = true; /* whatever else was found is this root again */
    for (unsigned bits = alone ? only & -only : exists; bits; bits &= bits - 1) {
      const unsigned n = (unsigned)__builtin_ctz(bits);
      const struct leaf_hit root = packet_root(p, lane, t, &r, n, w[n]);
      proven_add(&all, t, &root, in_leaf >> n & 1);
    }
  }
  if (!alone && !(all.count > 0 && all.within == t->variations[lane])) return false;
  for (int k = 0; k < all.count; k++)
    if (all.inside[k]) packet_offer(p, lane, t, &all.root[k]);
  return true;
}

static void lane_local_ray(const struct packet *p, const struct trial *t, unsigned lane, struct local_ray *out)
{
  const int k = t->axis;
  *out = (struct local_ray){k,
                            {p->slope[k][0][lane], p->slope[k][1][lane]},
                            {p->local[k].moment[0][lane], p->local[k].moment[1][lane]},
                            {p->local[k].start[0][lane], p->local[k].start[1][lane]},
                            p->local[k].to_t[lane],
                            p->local[k].error[lane]};
}

static void lane_subdivide(struct packet *p, const struct trial *t, unsigned lane)
{
  p->tracer->counts.escalated++;
  struct local_ray ray;
  struct leaf_hit root;
  bool doubt = false;
  lane_local_ray(p, t, lane, &ray);
  /* Up to the ray's own end, not the nearest hit so far: what the search can not decide must not depend on the order
   * of leaves. */
  const struct subdivide_task task = {p->model, t->leaf, t->patch, p->model->scene->patches[t->leaf->patch].P,
                                      &p->rays[lane], &ray, p->rays[lane].t_min, p->rays[lane].t_max};
  if (subdivide_closest(&task, &root, &doubt)) packet_offer(p, lane, t, &root);
  if (doubt) p->best.doubt[lane] = -1;
}

/* What cannot be decided in an object's coordinates is decided in the scene's, on a leaf cut for it. */
static void lane_subdivide_outside(struct packet *p, const struct trial *t, unsigned lane)
{
  struct packet *outer = p->outer;
  struct leaf leaf;
  struct trial there;
  const uint32_t patch = p->copy->first_patch + t->leaf->patch;
  struct model_patch *model_patch = &outer->model->patches[patch];
  there.patch = model_patch, there.leaf = &leaf, there.number = t->number;
  leaf_cut(model_patch, t->leaf->column_u, t->leaf->column_v, &leaf, NULL);
  leaf.patch = patch;
  if (outer->patch != patch) packet_set_patch(outer, patch);
  there.axis = packet_axis(outer, lane);
  lane_subdivide(outer, &there, lane);
  if (!outer->live[lane]) p->live[lane] = 0, p->moved = true;
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
  if (!t->patch->solver->polish) {
    for (int n = 0; n < roots.count; n++) {
      const struct refined r = {lanes_all(roots.u[n]), lanes_all(roots.v[n]), {0}, {0}, {0}, {0}, {0}, {0}};
      if (!(roots.u[n] >= 0 && roots.u[n] <= 1 && roots.v[n] >= 0 && roots.v[n] <= 1)) continue;
      struct leaf_hit root = packet_root(p, lane, t, &r, 0, trial_place(t, r.u, r.v)[0]);
      root.certain = false;
      packet_offer(p, lane, t, &root);
    }
    return;
  }
  if (!lane_prove(p, t, lane, &roots)) lane_subdivide(p, t, lane);
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
  const lane_mask single = (t->variations == 1) & r.exists & (k > radius) & (k < 1 - radius);
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
  for (unsigned bits = lanes_bits(left); bits; bits &= bits - 1) {
    const unsigned lane = (unsigned)__builtin_ctz(bits);
    /* The only root of r has been tried already; and where the root of a nearly bilinear leaf was not proven to be
     * alone the ray mostly passes the fold by, which subdivision sees at once. */
    if (p->outer) lane_subdivide_outside(p, t, lane);
    else if (t->patch->lanes) lane_subdivide(p, t, lane);
    else lane_alone(p, t, lane);
  }
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
