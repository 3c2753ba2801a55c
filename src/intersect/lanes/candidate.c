/* The way of a candidate: the order of its stages.
 *
 * Compiled once per instruction set. Read this file first; candidate.h says what each stage does.
 */
#include "intersect/lanes/candidate.h"

#include "base/real.h"

/* A leaf whose derivatives turn by more than this fraction of their size has its root far from that of its bilinear
 * part. An iteration for the latter is then in vain, and the next one's warm start is lost. A choice of speed, because
 * the result is proven. */
#define BENT_TURN 2.0

/* Whether finding the root of the bilinear part is worth its cost. */
static bool starts_bilinear(const struct candidate *it)
{
  const double *first = it->leaf->first;
  if (it->patch->lanes == SOLVER_LANES_SIGNS) return true;
  if (it->patch->lanes == SOLVER_LANES_NONE) return false;
  return turn_of(it->leaf->second) <= BENT_TURN * real_min(first[0], first[1]);
}

/* Let e be the bound on a plane's error (local_ray.h), so that u <= e/36. Then a is off by less than 2.5 e, b w by 8u,
 * w by its two roundings and that of the start, what is made of them by e + 6u, and the net by 32u. */
lane_mask stage_slab(const struct packet *p, const struct candidate *it, lane_mask open)
{
  const struct leaf_slab *slab = &it->leaf->slab[0];
  const struct line *line = it->line;
  lanes a, b;
  slab_values(line, it->axis, slab, &a, &b);
  lanes from, to, off;
  ray_ends(p, it, p->t_far, &from, &to, &off);
  const lanes out = slab->half + 10 * line->error + off, at[2] = {a + b * from, a + b * to};
  return open & ~((lanes_min(at[0], at[1]) > out) | (lanes_max(at[0], at[1]) < -out));
}

/* A scene with `polish off` wants the roots as its solver finds them. There only the slab closes a leaf before
 * that. */
static void candidate_pass(struct packet *p, struct candidate *it, lane_mask open)
{
  const struct model_patch *patch = it->patch;
  uint64_t *entered = p->tracer->counts.stages;
  open = stage_slab(p, it, open);
  packet_charge(p, open & COST_TRIED);
  if (!lanes_any(open)) return;
  p->tracer->counts.patches_tested += lanes_count(open);
  if (starts_bilinear(it)) {
    entered[STAGE_BILINEAR] += lanes_count(open);
    open = stage_bilinear(p, it, open);
    if (!lanes_any(open)) return;
    if (patch->method->polish) open &= ~stage_leaves(p, it, open);
    if (!lanes_any(open)) return;
  }
  packet_charge(p, open & COST_PLANES);
  entered[STAGE_PLANES] += lanes_count(open);
  if (patch->method->polish) open = stage_cover(p, it, open);
  if (lanes_any(open)) open = stage_resultant(p, it, open);
  if (lanes_any(open)) packet_postpone(p, it, open);
}

/* If the plane polynomials of a patch are known no better than this, because the ray starts far away, double precision
 * proves no root, and the last resort examines most of the patch in any case. */
#define BLIND 0x1p-5

/* The lanes of `active` on which the leaf may have a hit that counts. None if its patch lies exactly on an earlier one;
 * not those that have met an earlier patch of its surface; and if that is a plane, not those whose ray goes away from
 * it, or starts in it and leaves it. */
LANES_INLINE lane_mask before_on_surface(const struct packet *p, const struct leaf *leaf, lane_mask active)
{
  const struct packet *scene = packet_scene(p);
  const struct model *model = scene->model;
  const uint32_t patch = packet_patch(p, leaf), surface = model->surface ? model->surface[patch] : 0;
  if (surface == 0) return active;
  const int axis = SURFACE_AXIS(surface);
  if (axis >= 0) {
    const lanes above = scene->origin[axis] - model->scene->patches[patch].P[0][0][axis], up = scene->direction[axis];
    active &= ((above > 0) & (up < 0)) | ((above < 0) & (up > 0)) | ((above == 0) & (up == 0));
  }
  if (p->gather) return active;
  if (surface & SURFACE_AGAIN) return (lane_mask){0};
  if (!p->oriented) return active;
  const lane_mask number = (int64_t)patch + (lane_mask){0}, behind = active & (p->best.patch < number);
  return lanes_any(behind) ? active & ~one_surface(model, number, p->best.patch, behind) : active;
}

void packet_leaf(struct packet *p, struct leaf *leaf, const struct model_patch *patch, uint32_t number,
                 lane_mask active)
{
  struct candidate it;
  active = before_on_surface(p, leaf, active);
  if (!lanes_any(active)) return;
  it.leaf = leaf, it.patch = patch, it.number = number;
  if (p->patch != it.leaf->patch) packet_set_patch(p, it.patch, it.leaf->patch);
  for (unsigned bits = p->axes; bits; bits &= bits - 1) {
    it.axis = __builtin_ctz(bits), it.line = &p->line[it.axis];
    const lane_mask at = active & p->on_axis[it.axis], blind = at & ~(it.line->error <= BLIND);
    const lane_mask here = at & ~blind;
    if (lanes_any(blind)) packet_postpone(p, &it, blind);
    const bool explained = p->tracer->explainer && lanes_any(at);
    if (explained) explain_before(p, &it);
    if (lanes_any(here)) candidate_pass(p, &it, here);
    if (explained) explain_after(p, &it, lanes_any(blind));
  }
}
