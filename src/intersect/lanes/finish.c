/* From the best roots to the answers: the last Newton step, the point, the normal; and what goes to the last resort. */
#include <assert.h>
#include <stddef.h>

#include "intersect/exact/exact.h"
#include "intersect/lanes/last_step.h"
#include "intersect/lanes/packet.h"

/* A root with a radius larger than this, in patch parameters, is seen so nearly edge-on that what the last step leaves,
 * 2^-27 of that, shows in the last places of t. */
#define BLURRED_RADIUS 0x1p-28

/* The answers of a packet's lanes. */
struct answers {
  lanes u, v, t;
  struct surface_point point;
  lanes normal[3]; /* of unit length and either sense */
  lane_mask done;  /* point and normal are sure, and the root has moved no farther than its radius */
};

/* Lanes whose answer is in doubt, whatever it is. */
static unsigned packet_doubt(const struct packet *p) { return p->model->unproven ? ~0u : lanes_bits(p->best.doubt); }

static struct exact_case lane_case(const struct packet *p, unsigned lane)
{
  struct postponed *postponed = p->postponed;
  return (struct exact_case){.model = p->model,
                             .ray = &p->rays[lane],
                             .regions = postponed->region[lane],
                             .region_count = postponed->count[lane],
                             .cut_from = postponed->cut_from[lane],
                             .work = &p->tracer->counts.work,
                             .limit = packet_exact_limit(p, lane)};
}

static struct exact_maybe lane_maybe(const struct packet *p, unsigned lane)
{
  const struct best *best = &p->best;
  return (struct exact_maybe){
    .patch = (uint32_t)best->patch[lane], .u = best->u[lane], .v = best->v[lane], .t = best->t[lane]};
}

/* Has the last resort decide the lane. Returns whether the answer is written; otherwise it is now the lane's best
 * root. */
static bool lane_decide(struct packet *p, unsigned lane, struct hit *out)
{
  struct best *best = &p->best;
  struct exact_case wanted = lane_case(p, lane);
  const bool hit = best->patch[lane] != NO_PATCH;
  const struct exact_root known = packet_root(p, lane);
  const struct exact_maybe maybe = lane_maybe(p, lane);
  if (hit && best->certain[lane]) wanted.known = &known;
  else if (hit) wanted.maybe = &maybe;
  struct exact_decision decision;
  exact_closest(&wanted, &decision);
  if (!decision.sure) best->doubt[lane] = -1;
  struct exact_root *root = &decision.root;
  if (decision.verdict == EXACT_MISS) {
    best->patch[lane] = NO_PATCH;
    return false;
  }
  if (decision.verdict == EXACT_MAYBE) {
    exact_maybe_hit(p->model, &p->rays[lane], &decision.maybe, out);
    return true;
  }
  if (decision.known) return false;
  exact_root_hit(p->model, &p->rays[lane], root, !(packet_doubt(p) >> lane & 1), out);
  return true;
}

/* Writes the hit of a lane whose best root the last step did not make good. */
static void lane_finish(const struct packet *p, unsigned lane, bool sure, struct hit *out)
{
  struct exact_root root = packet_root(p, lane);
  const struct exact_maybe maybe = lane_maybe(p, lane);
  if (p->best.certain[lane]) exact_root_hit(p->model, &p->rays[lane], &root, sure, out);
  else exact_maybe_hit(p->model, &p->rays[lane], &maybe, out);
}

/* A ray whose budget is exhausted, or that left more open than there is room for, may hit what was not examined. Every
 * such ray counts as hit, whatever else it meets, so that its answer does not depend on its neighbours. */
unsigned finish_occluded(const struct packet *p)
{
  if (!p->oriented) return 0;
  unsigned hit = lanes_bits(p->best.patch != NO_PATCH) | packet_cut_off(p);
  for (unsigned bits = p->postponed->open & ~hit; bits; bits &= bits - 1) {
    const unsigned lane = (unsigned)__builtin_ctz(bits);
    const struct exact_case wanted = lane_case(p, lane);
    const uint64_t before = *wanted.work;
    if (exact_occluded(&wanted)) hit |= 1u << lane;
    if (*wanted.work - before >= wanted.limit) p->postponed->exhausted |= 1u << lane;
  }
  return hit;
}

/* A hit's numbers are eleven doubles in a row. */
enum { HIT_STRIDE = sizeof(struct hit) / sizeof(double) };
static_assert(HIT_STRIDE == 12 && offsetof(struct hit, t) == sizeof(double) &&
                offsetof(struct hit, point) == 4 * sizeof(double) &&
                offsetof(struct hit, clearance) == 8 * sizeof(double),
              "written as three fours");

/* Writes the hits of the lanes of `group`. Returns how many are not certain. */
LANES_INLINE unsigned write_hits(const struct packet *p, unsigned group, const struct answers *a, struct hit out[])
{
  const struct best *best = &p->best;
  const unsigned doubt = packet_doubt(p);
  lanes facing = lanes_all(0), normal[3];
  for (int c = 0; c < 3; c++) facing += a->normal[c] * p->direction[c];
  for (int c = 0; c < 3; c++) normal[c] = lanes_select(facing > 0, -a->normal[c], a->normal[c]);
  const lane_mask done = a->done & best->certain & (a->t > p->t_min) & (a->t < p->t_max) &
                         (best->radius_u <= BLURRED_RADIUS) & (best->radius_v <= BLURRED_RADIUS);
  const unsigned done_bits = lanes_bits(done);
  struct hit some[LANES];
  struct hit *row = (group & done_bits) == ALL_LANES ? out : some;
  unsigned grazing = 0;
  const struct surface_point *point = &a->point;
  lanes_store4(a->t, a->u, a->v, point->at[0], &row->t, HIT_STRIDE);
  lanes_store4(point->at[1], point->at[2], point->error, point->clearance, &row->point[1], HIT_STRIDE);
  lanes_store4(point->clearance, normal[0], normal[1], normal[2], &row->clearance, HIT_STRIDE);
  if (row == out && !doubt) { /* most of the time */
    for (int l = 0; l < LANES; l++) out[l].patch = (uint32_t)best->patch[l], out[l].certainty = CERTAINTY_CERTAIN;
    return 0;
  }
  for (unsigned bits = group; bits; bits &= bits - 1) {
    const unsigned l = (unsigned)__builtin_ctz(bits);
    const bool sure = !(doubt >> l & 1);
    if (!(done_bits >> l & 1)) {
      lane_finish(p, l, sure, &out[l]);
      grazing += out[l].certainty == CERTAINTY_GRAZING;
      continue;
    }
    row[l].patch = (uint32_t)best->patch[l], row[l].certainty = sure ? CERTAINTY_CERTAIN : CERTAINTY_GRAZING;
    if (row != out) out[l] = row[l];
    grazing += !sure;
  }
  return grazing;
}

/* Finishes the lanes of `group`, whose best roots are final. */
static unsigned finish_final(const struct packet *p, unsigned group, struct hit out[])
{
  const struct best *best = &p->best;
  struct answers a;
  a.u = lanes_clamp(best->u, 0, 1), a.v = lanes_clamp(best->v, 0, 1), a.t = best->t;
  a.done = surface_normal(best->normal, best->tangent, a.normal);
  a.point = best->point;
  return write_hits(p, group, &a, out);
}

/* Finishes the lanes of `group`. Their best roots are on one patch, and their rays share an axis. */
static unsigned finish_group(const struct packet *p, unsigned group, int axis, const struct model_patch *patch,
                             struct hit out[])
{
  const struct best *best = &p->best;
  struct last_step step;
  step.patch = patch, step.axis = axis, step.origin = p->origin, step.direction = p->direction;
  step.near = packet_nearer(p, patch, NEAR_START, best->t);
  step.improves = lanes_mask(group) & best->certain;
  step.u = lanes_clamp(best->u, 0, 1), step.v = lanes_clamp(best->v, 0, 1), step.t = best->t;
  last_step_take(&step);
  struct answers a = {.u = step.u, .v = step.v, .t = step.t, .done = step.done};
  a.done &= (lanes_abs(step.u - best->u) <= best->radius_u) & (lanes_abs(step.v - best->v) <= best->radius_v) &
            packet_has_digits(p, patch, NEAREST_START, best->t);
  a.point = surface_point(patch, step.point, step.tangent);
  for (int c = 0; c < 3; c++) a.normal[c] = step.normal[c];
  return write_hits(p, group, &a, out);
}

/* Has the last resort decide what is open. Returns the lanes, as bits, whose answers are written. */
static unsigned decide_open(struct packet *p, struct hit out[])
{
  unsigned written = 0;
  for (unsigned bits = p->postponed->open; bits; bits &= bits - 1) {
    const unsigned l = (unsigned)__builtin_ctz(bits);
    if (lane_decide(p, l, &out[l])) written |= 1u << l;
  }
  return written;
}

/* Writes misses for these rays, grazing on the lanes of `doubt`. Returns how many of them are grazing. */
static unsigned write_misses(struct hit out[], unsigned misses, unsigned doubt)
{
  if (misses == ALL_LANES && !doubt) { /* the same without a loop */
    for (int l = 0; l < LANES; l++) out[l].patch = HIT_NONE, out[l].certainty = CERTAINTY_CERTAIN;
    return 0;
  }
  for (unsigned bits = misses; bits; bits &= bits - 1) {
    const int l = __builtin_ctz(bits);
    out[l].patch = HIT_NONE, out[l].certainty = doubt >> l & 1 ? CERTAINTY_GRAZING : CERTAINTY_CERTAIN;
  }
  return (unsigned)__builtin_popcount(misses & doubt);
}

unsigned finish_best(const struct packet *p, unsigned written, struct hit out[])
{
  const unsigned hits = lanes_bits(p->best.patch != NO_PATCH);
  unsigned left = ((1u << p->count) - 1) & ~written, grazing = 0;
  for (unsigned bits = written; bits; bits &= bits - 1)
    grazing += out[__builtin_ctz(bits)].certainty == CERTAINTY_GRAZING;
  grazing += write_misses(out, left & ~hits, packet_doubt(p));
  left &= hits;
  const unsigned final = left & lanes_bits(p->best.final);
  if (final) grazing += finish_final(p, final, out);
  left &= ~final;
  while (left) {
    const unsigned first = (unsigned)__builtin_ctz(left);
    const int axis = packet_axis(p, first);
    const int64_t patch = p->best.patch[first];
    const unsigned group = left & lanes_bits((p->best.patch == patch) & p->on_axis[axis]);
    struct patch_room room;
    grazing += finish_group(p, group, axis, model_patch_at(p->model, (uint32_t)patch, &room), out);
    left &= ~group;
  }
  return grazing;
}

unsigned finish_hits(struct packet *p, struct hit out[])
{
  if (!p->oriented) return write_misses(out, (1u << p->count) - 1, p->model->unproven ? ~0u : 0);
  return finish_best(p, decide_open(p, out), out);
}

unsigned finish_unsettled(const struct packet *p, const struct hit hits[])
{
  unsigned unsettled = 0;
  for (size_t l = 0; l < p->count; l++)
    if (hits[l].certainty != CERTAINTY_CERTAIN) unsettled |= 1u << l;
  return unsettled;
}
