/* The nearest root of every lane, or all roots (gather.c): the one place where roots are taken or refused.
 *
 * A root is taken if double precision leaves no question. If it may lie on a border of its patch, at an end of the ray,
 * or where another root is, its leaf is left to the last resort. Compiled once per instruction set.
 */
#include <math.h>

#include "base/real.h"
#include "intersect/lanes/candidate.h"

void packet_exhaust(struct packet *p, unsigned exhausted)
{
  p->postponed->exhausted |= exhausted;
  for (struct packet *q = p; q; q = q->outer) {
    q->live &= ~lanes_mask(exhausted), q->moved = true;
    if (!q->outer) q->best.doubt |= lanes_mask(exhausted);
  }
}

/* Leaves out the one that begins last, of the patches on the full list and one more. From then on, what begins there or
 * behind is left out. So, in whatever order they come, cut_from is where the first one without room begins. */
static void leave_out_last(struct postponed *to, unsigned lane, struct exact_region region)
{
  struct exact_region *last = to->region[lane];
  for (unsigned k = 1; k < EXACT_REGIONS_MAX; k++)
    if (to->region[lane][k].near > last->near) last = &to->region[lane][k];
  to->cut_from[lane] = real_max(last->near, region.near);
  if (region.near < last->near) *last = region;
}

/* Adds the region to the list, or to that of its patch. */
static void list_region(struct postponed *to, unsigned lane, struct exact_region region)
{
  const unsigned count = to->count[lane];
  struct exact_region *list = to->region[lane];
  for (unsigned k = 0; k < count; k++) {
    if (list[k].patch != region.patch) continue;
    list[k].near = real_min(list[k].near, region.near);
    return;
  }
  if (count < EXACT_REGIONS_MAX) list[to->count[lane]++] = region;
  else leave_out_last(to, lane, region);
}

/* Postpones the patch of the scene, in which what is open begins at `near`. What begins at a list's cut_from or behind
 * is ignored. */
static void postpone(struct packet *p, uint32_t patch, lanes near, lane_mask open)
{
  struct postponed *to = p->postponed;
  if (p->outer) near = (p->shift + near) - 4 * UNIT_ROUNDOFF * (lanes_abs(p->shift) + lanes_abs(near));
  near = lanes_max(near, lanes_all(-INFINITY)); /* or not a number */
  if (!p->gather) open &= ~(near >= to->cut_from);
  p->tracer->counts.escalated += lanes_count(open);
  if (!p->gather) to->open |= lanes_bits(open);
  for (unsigned bits = lanes_bits(open); bits; bits &= bits - 1) {
    const unsigned lane = (unsigned)__builtin_ctz(bits);
    if (p->gather) gather_postpone(p, patch, lane);
    else list_region(to, lane, (struct exact_region){patch, near[lane]});
  }
}

/* t where x_k = w. */
LANES_INLINE lanes depth_to_t(const struct line *line, lanes w)
{
  return ((w + line->start[1]) + line->start[0]) * line->to_t;
}

/* In y = w to_t/|to_t|, which grows along the ray, a slab begins at -(a sign + its half)/|b|, the sign being b's in y.
 * Errors are those of stage_slab. The quotient's three roundings are 6u of |y| <= FRAME_END, for which the error of x_k
 * has room. The error of t is that of a root there. */
static lanes slab_begin(const struct packet *p, const struct candidate *it)
{
  const struct line *line = it->line;
  lanes begin = lanes_all(-FRAME_END);
  for (int q = 0; q < 3; q++) {
    lanes a, b;
    slab_values(line, it->axis, &it->leaf->slab[q], &a, &b);
    const lanes along = lanes_select(line->to_t < 0, -b, b), out = it->leaf->slab[q].half + 10 * line->error;
    const lanes at = (-lanes_select(along < 0, -a, a) - out) / lanes_abs(b);
    begin = lanes_select((at > begin) & (lanes_abs(b) > 0), at, begin);
  }
  const lanes w = lanes_min(begin, lanes_all(FRAME_END)), size = lanes_abs(line->to_t);
  const lanes at = depth_to_t(line, lanes_select(line->to_t < 0, -w, w));
  return lanes_max(at - (size * line->error + 8 * UNIT_ROUNDOFF * (lanes_abs(at) + FRAME_END * size) + p->t_error),
                   p->t_min);
}

void packet_postpone(struct packet *p, const struct candidate *it, lane_mask open)
{
  postpone(p, packet_patch(p, it->leaf), slab_begin(p, it), open);
}

void packet_postpone_best(struct packet *p, lane_mask open)
{
  const struct best *best = &p->best;
  for (unsigned bits = lanes_bits(open); bits; bits &= bits - 1) {
    const unsigned lane = (unsigned)__builtin_ctz(bits);
    postpone(p, (uint32_t)best->patch[lane], best->t - (p->t_far - best->t), lanes_mask(1u << lane));
  }
}

/* Lanes whose root may lie on a border of the patch. */
static lane_mask on_border(const struct candidate *it, const struct newton_root *r)
{
  const uint16_t *split = it->patch->cut.split;
  lane_mask border = {0};
  if (it->leaf->column_u == 0) border |= r->u <= r->radius_u;
  if (it->leaf->column_u == split[0] - 1) border |= 1 - r->u <= r->radius_u;
  if (it->leaf->column_v == 0) border |= r->v <= r->radius_v;
  if (it->leaf->column_v == split[1] - 1) border |= 1 - r->v <= r->radius_v;
  return border;
}

/* How far a point of the surface moves at most within the radii of a root. */
LANES_INLINE lanes root_reach(const struct candidate *it, const struct newton_root *r)
{
  return it->leaf->first[0] * r->radius_u + it->leaf->first[1] * r->radius_v;
}

/* Bounds the error of t of a root within these radii: how far they let x_k move, and the roundings of x_k and of t. */
LANES_INLINE lanes root_t_error(const struct packet *p, const struct candidate *it, const struct newton_root *r,
                                lanes w, lanes at)
{
  const lanes size = lanes_abs(it->line->to_t);
  return size * (root_reach(it, r) + it->line->error + it->leaf->parts.error) +
         8 * UNIT_ROUNDOFF * (lanes_abs(at) + size * lanes_abs(w)) + p->t_error;
}

/* The root and its radii in parameters of the patch. */
LANES_INLINE void root_uv(const struct candidate *it, const struct newton_root *r, lanes uv[2], lanes radius[2])
{
  const double part[2] = {1.0 / it->patch->cut.split[0], 1.0 / it->patch->cut.split[1]};
  uv[0] = (it->leaf->column_u + r->u) * part[0], uv[1] = (it->leaf->column_v + r->v) * part[1];
  radius[0] = r->radius_u * part[0] + UNIT_ROUNDOFF, radius[1] = r->radius_v * part[1] + UNIT_ROUNDOFF;
}

LANES_INLINE void packet_take(struct packet *p, const struct candidate *it, const struct newton_root *r, lanes at,
                              lanes error, lane_mask taken, bool certain)
{
  const int64_t leaf = it->number, patch = packet_patch(p, it->leaf);
  lanes uv[2], radius[2];
  root_uv(it, r, uv, radius);
  p->tracer->counts.roots_accepted += lanes_count(taken);
  const lane_mask none = {0};
  best_take(&p->best, taken, uv, radius, at, patch + none, leaf + none);
  if (!certain) p->best.certain &= ~taken;
  p->t_far = lanes_select(taken, at + error, p->t_far);
  if (p->any) p->live &= ~taken;
  p->moved = true;
}

/* Lanes where the root is the best one again, found by another leaf. */
static lane_mask same_root(const struct packet *p, const struct candidate *it, const struct newton_root *r,
                           int64_t patch)
{
  const struct best *best = &p->best;
  lanes uv[2], radius[2];
  root_uv(it, r, uv, radius);
  return (best->patch == patch) & (lanes_abs(uv[0] - best->u) <= radius[0] + best->radius_u) &
         (lanes_abs(uv[1] - best->v) <= radius[1] + best->radius_v);
}

/* Proven roots of several lanes, at x_k = w and t = `at`, become the best where they come before it. Where all hits are
 * gathered there was no best, and the caller removes it again. A root that may lie on a border of the patch, at an end
 * of the ray, or where another root is, is left to the last resort. Returns the lanes that took theirs. */
LANES_INLINE lane_mask offer(struct packet *p, const struct candidate *it, const struct newton_root *r, lanes w,
                             lanes at, lane_mask hits)
{
  const int64_t leaf = it->number, patch = packet_patch(p, it->leaf);
  const lanes error = root_t_error(p, it, r, w, at);
  hits &= ~((at < p->t_min - error) | (at - error > lanes_min(p->t_max, p->t_far)));
  if (!lanes_any(hits)) return hits;
  const lane_mask none = {0}, first = patch < p->best.patch;
  lane_mask rival = lanes_abs(at - p->best.t) <= error + (p->t_far - p->best.t), tied = none;
  if (lanes_any(hits & rival)) {
    rival &= ~same_root(p, it, r, patch);
    tied = one_surface(packet_scene(p)->model, patch + none, p->best.patch, hits & rival);
    rival &= ~tied, hits &= ~tied | first;
  }
  const lane_mask sure = ~on_border(it, r) & (at > p->t_min + error) & (at < p->t_max - error) & ~rival;
  if (lanes_any(hits & ~sure)) packet_postpone(p, it, hits & ~sure);
  const lane_mask taken = hits & sure & (tied | best_after(&p->best, at, patch + none, leaf + none));
  if (lanes_any(taken)) packet_take(p, it, r, at, error, taken, true);
  return taken;
}

void offer_unproven(struct packet *p, const struct candidate *it, double u, double v, unsigned lane)
{
  const struct newton_root r = {.u = lanes_all(u), .v = lanes_all(v)};
  const lanes w = lanes_all(leaf_depth(it, u, v)), at = depth_to_t(it->line, w), error = root_t_error(p, it, &r, w, at);
  const lane_mask behind = at > p->t_min + error, hits = lanes_mask(1u << lane), none = {0};
  p->best.doubt |= hits & ~behind & ~(at < p->t_min - error);
  const lane_mask taken = hits & behind & (at < p->t_max) &
                          best_after(&p->best, at, it->leaf->patch + none, it->number + none);
  if (!lanes_any(taken)) return;
  packet_take(p, it, &r, at, error, taken, false);
  if (p->gather) gather_best(p, taken);
}

/* A root is final if it is off by no more than this many roundings of t. */
#define FINAL_ROUNDINGS 4

/* The error of a plane at a root that Newton's method ends at, besides the rest's rounding (leaf_parts.error) and what
 * the last step leaves. The products of tails, 2^-27 with s and t of a patch that is one leaf, are 2^-26 of 6 at most
 * in either of two coordinates, and take six roundings each. */
#define TAIL_ERROR (72 * UNIT_ROUNDOFF * 0x1p-26)

/* The lanes whose root is final. The radii are no less than 72 u |M| for the inverse Jacobian M (PLANE_ERROR), so they
 * show how M magnifies an error. On a thin patch seen edge-on, the root may be off by far more than rounding the input
 * causes. */
LANES_INLINE lane_mask root_is_final(const struct packet *p, const struct candidate *it, const struct leaf_root *root)
{
  const struct leaf *leaf = it->leaf;
  const lanes reach = root_reach(it, &root->at);
  const lanes off = leaf->parts.error + TAIL_ERROR + root->left;
  return packet_has_digits(p, it->patch, NEAR_START, root->t) &
         (off * it->patch->scale * reach <=
          72 * FINAL_ROUNDINGS * UNIT_ROUNDOFF * UNIT_ROUNDOFF * (lanes_abs(root->t) * p->longest));
}

/* Keeps point and normal at a leaf's root. */
LANES_INLINE void packet_keep(struct packet *p, const struct candidate *it, const struct leaf_root *root,
                              lane_mask taken)
{
  const uint16_t *split = it->patch->cut.split;
  struct surface found, *kept = &p->best.surface;
  surface_set(it->patch, root->point, root->su, root->sv, split[0] > split[1] ? split[0] : split[1], &found);
  for (int c = 0; c < 3; c++) {
    kept->at[c] = lanes_select(taken, found.at[c], kept->at[c]);
    kept->normal[c] = lanes_select(taken, found.normal[c], kept->normal[c]);
  }
  kept->tangent = lanes_select(taken, found.tangent, kept->tangent);
  kept->error = lanes_select(taken, found.error, kept->error);
  kept->clearance = lanes_select(taken, found.clearance, kept->clearance);
  p->best.final |= taken & root_is_final(p, it, root);
}

void offer_root(struct packet *p, const struct candidate *it, const struct leaf_root *root, lane_mask hits)
{
  if (!lanes_any(hits)) return;
  const lane_mask taken = offer(p, it, &root->at, root->w, root->t, hits);
  if (!lanes_any(taken)) return;
  if (it->leaf->parts.final && !p->any && !p->outer) packet_keep(p, it, root, taken);
  if (p->gather) gather_best(p, taken);
}
