/* From the best roots to the answers: the last Newton step, the point, the normal; and what goes to the last resort.
 *
 * Compiled once per instruction set and without contraction.
 */
#include <math.h>

#include "base/double_lanes.h"
#include "intersect/lanes/packet.h"

/* A root with a radius larger than this, in patch parameters, is seen so nearly edge-on that what the last step leaves,
 * 2^-27 of that, shows in the last places of t. */
#define BLURRED_RADIUS 0x1p-28

/* The answers of a packet's lanes. */
struct answers {
  lanes u, v, t;
  lane_mask done; /* the point is sure, and the root has moved no farther than its radius */
};

/* ---- the last Newton step ---- */

/* A root comes from a leaf's net, which is cut from the patch and rounded. Where the ray is steep, it is right to a few
 * last places; where the ray grazes, rounding is magnified. A Newton step on the patch itself makes all roots right to
 * the last places. Its residuals a(u,v), b(u,v) are computed in double-double, from control points relative to the
 * ray's start, so that roots near the start keep their digits, too. */
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

/* Computes the answers on lanes whose best roots are on one patch, and whose rays share an axis; roots of `improves`
 * get new u, v and t. A lane whose steps do not end within the patch's size keeps its own. T is right to 2^-80 of the
 * patch's frame, near the ray's start to 2^-100, and then rounded once. */
static struct answers last_step(const struct packet *p, const struct model_patch *patch, int axis, lane_mask improves,
                                struct surface *surface)
{
  const struct best *best = &p->best;
  const int k = axis, i = (k + 1) % 3, j = (k + 2) % 3;
  const lanes dk = p->direction[k], inverse = 1 / dk, ri = p->direction[i] * inverse, rj = p->direction[j] * inverse;
  const double to_local = 1 / patch->scale; /* a power of two */
  struct double_lanes start[3];
  for (int c = 0; c < 3; c++) {
    start[c] = double_lanes_sum(p->origin[c], lanes_all(-patch->center[c]));
    start[c].hi *= to_local, start[c].lo *= to_local;
  }
  const lanes from_u = lanes_clamp(best->u, 0, 1), from_v = lanes_clamp(best->v, 0, 1);
  lanes u = from_u, v = from_v, du, dv;
  struct last_step_jet jet;
  const struct double_lanes *way = jet.way;
  const lane_mask near = packet_nearer(p, patch, NEAR_START, best->t);
  const lanes longest = lanes_select(near, lanes_all(LAST_STEP_LONGEST_NEAR), lanes_all(LAST_STEP_LONGEST));
  lane_mask moving = improves, again;
  for (int n = 0;; n++) {
    last_step_evaluate(patch, start, u, v, &jet);
    lanes f[2], fu[2], fv[2];
    for (int s = 0; s < 2; s++) {
      const int at = s ? j : i;
      const struct double_lanes x = double_lanes_scale(way[at], dk), y = double_lanes_scale(way[k], p->direction[at]);
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
  const lane_mask lost = improves & ~moving; /* the jet is elsewhere */
  struct answers a;
  a.t = lanes_select(moving, (t + left * inverse) * patch->scale, best->t);
  a.u = lanes_clamp(lanes_select(lost, from_u, u + du), 0, 1);
  a.v = lanes_clamp(lanes_select(lost, from_v, v + dv), 0, 1);
  const lanes to_u = a.u - u, to_v = a.v - v;
  lanes point[3];
  for (int c = 0; c < 3; c++) point[c] = jet.s[c].hi + (jet.s[c].lo + (jet.du[c] * to_u + jet.dv[c] * to_v));
  surface_set(patch, point, jet.du, jet.dv, 1, surface);
  a.done = ~lost & ~(again & near) & (lanes_abs(a.u - best->u) <= best->radius_u) &
           (lanes_abs(a.v - best->v) <= best->radius_v) & packet_has_digits(p, patch, NEAREST_START, best->t);
  return a;
}

/* ---- what the last resort decides ---- */

/* Lanes whose answer is in doubt, whatever it is. */
static unsigned packet_doubt(const struct packet *p) { return p->model->unproven ? ~0u : lanes_bits(p->best.doubt); }

/* Has the last resort decide the lane. Returns whether the answer is written; otherwise it is the lane's best root. */
static bool lane_decide(struct packet *p, unsigned lane, struct hit *out)
{
  struct best *best = &p->best;
  struct exact_case wanted = packet_case(p, lane);
  const struct exact_root known = packet_root(p, lane);
  struct exact_decision decision;
  if (best->patch[lane] != NO_PATCH) wanted.known = &known;
  exact_closest(&wanted, &decision);
  if (!decision.sure) best->doubt[lane] = -1;
  if (!decision.hit) best->patch[lane] = NO_PATCH;
  if (!decision.hit || decision.known) return false;
  exact_hit(p->model, &p->rays[lane], &decision.root, !(packet_doubt(p) >> lane & 1), out);
  return true;
}

/* A t as near as this, relatively, rounds to a double next to it. */
#define LAST_PLACES 0x1p-58

/* Writes the hit of a lane whose best root the last step did not make good. */
static void lane_finish(const struct packet *p, unsigned lane, bool sure, struct hit *out)
{
  const struct exact_root known = packet_root(p, lane);
  struct exact_root root = known;
  const bool certain = p->best.certain[lane];
  struct exact_case wanted = packet_case(p, lane);
  wanted.known = &known;
  if (certain && known.t_error > LAST_PLACES * fabs((double)known.t)) exact_place(&wanted, &root);
  exact_hit(p->model, &p->rays[lane], &root, sure && certain, out);
}

/* A ray whose budget is exhausted, or that left more open than there is room for, may hit what was not examined. Every
 * such ray counts as hit, whatever else it meets, so that its answer does not depend on its neighbours. */
unsigned finish_occluded(const struct packet *p, bool out[])
{
  unsigned hit = 0;
  if (p->oriented) hit = lanes_bits(p->best.patch != NO_PATCH) | packet_cut_off(p);
  for (unsigned bits = p->postponed->open & ~hit; bits; bits &= bits - 1) {
    const unsigned lane = (unsigned)__builtin_ctz(bits);
    const struct exact_case wanted = packet_case(p, lane);
    bool proven;
    if (exact_occluded(&wanted, &proven)) hit |= 1u << lane;
    if (!proven) p->postponed->exhausted |= 1u << lane; /* a share of its budget may not have sufficed */
  }
  for (size_t l = 0; l < p->count; l++) out[l] = hit >> l & 1;
  return hit & packet_cut_off(p);
}

/* ---- what is written ---- */

/* Writes the hits of the lanes of `group`. Returns those that are not certain. */
LANES_INLINE unsigned write_hits(const struct packet *p, unsigned group, const struct answers *a,
                                 const struct surface *on, struct hit out[])
{
  const struct best *best = &p->best;
  const unsigned doubt = packet_doubt(p);
  const lanes *across = on->normal,
              length = lanes_sqrt(across[0] * across[0] + across[1] * across[1] + across[2] * across[2]);
  const lanes inverse = 1 / length;
  lanes facing = lanes_all(0), normal[3];
  for (int c = 0; c < 3; c++) normal[c] = across[c] * inverse, facing += normal[c] * p->direction[c];
  for (int c = 0; c < 3; c++) normal[c] = lanes_select(facing > 0, -normal[c], normal[c]);
  const lane_mask done = a->done & best->certain & (a->t > p->t_min) & (a->t < p->t_max) &
                         (best->radius_u <= BLURRED_RADIUS) & (best->radius_v <= BLURRED_RADIUS) &
                         (length > SURFACE_SURE * on->tangent * lanes_max(on->tangent, lanes_all(SURFACE_LEAST)));
  const unsigned done_bits = lanes_bits(done);
  struct hit some[LANES];
  struct hit *row = (group & done_bits) == ALL_LANES ? out : some;
  unsigned grazing = 0;
  lanes_store4(a->t, a->u, a->v, on->at[0], &row->t, HIT_STRIDE);
  lanes_store4(on->at[1], on->at[2], on->error, on->clearance, &row->point[1], HIT_STRIDE);
  lanes_store4(on->clearance, normal[0], normal[1], normal[2], &row->clearance, HIT_STRIDE);
  if (row == out && !doubt) { /* most of the time */
    for (int l = 0; l < LANES; l++) out[l].patch = (uint32_t)best->patch[l], out[l].certainty = CERTAINTY_CERTAIN;
    return 0;
  }
  for (unsigned bits = group; bits; bits &= bits - 1) {
    const unsigned l = (unsigned)__builtin_ctz(bits);
    const bool sure = !(doubt >> l & 1);
    if (done_bits >> l & 1) {
      row[l].patch = (uint32_t)best->patch[l], row[l].certainty = sure ? CERTAINTY_CERTAIN : CERTAINTY_GRAZING;
      if (row != out) out[l] = row[l];
    } else {
      lane_finish(p, l, sure, &out[l]);
    }
    grazing |= (unsigned)(out[l].certainty == CERTAINTY_GRAZING) << l;
  }
  return grazing;
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

/* Writes misses for these rays, grazing on the lanes of `doubt`. Returns those that are grazing. */
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
  return misses & doubt;
}

unsigned finish_best(const struct packet *p, unsigned written, struct hit out[])
{
  const unsigned hits = lanes_bits(p->best.patch != NO_PATCH);
  unsigned left = ((1u << p->count) - 1) & ~written, grazing = 0;
  for (unsigned bits = written; bits; bits &= bits - 1)
    if (out[__builtin_ctz(bits)].certainty == CERTAINTY_GRAZING) grazing |= bits & -bits;
  grazing |= write_misses(out, left & ~hits, packet_doubt(p));
  left &= hits;
  const unsigned final = left & lanes_bits(p->best.final);
  if (final) {
    const struct best *best = &p->best;
    const struct answers answers = {lanes_clamp(best->u, 0, 1), lanes_clamp(best->v, 0, 1), best->t, lanes_mask(final)};
    grazing |= write_hits(p, final, &answers, &best->surface, out);
  }
  left &= ~final;
  while (left) {
    const unsigned first = (unsigned)__builtin_ctz(left);
    const int axis = packet_axis(p, first);
    const int64_t patch = p->best.patch[first];
    const unsigned group = left & lanes_bits((p->best.patch == patch) & p->on_axis[axis]);
    struct patch_room room;
    struct surface surface;
    const struct answers answers = last_step(p, model_patch_at(p->model, (uint32_t)patch, &room), axis,
                                             lanes_mask(group) & p->best.certain, &surface);
    grazing |= write_hits(p, group, &answers, &surface, out);
    left &= ~group;
  }
  return grazing;
}

unsigned finish_hits(struct packet *p, const int *exponents, struct hit out[])
{
  if (!p->oriented) return write_misses(out, (1u << p->count) - 1, p->model->unproven ? ~0u : 0);
  const unsigned grazing = finish_best(p, decide_open(p, out), out);
  for (size_t l = 0; l < p->count && exponents; l++)
    if (out[l].patch != HIT_NONE) out[l].t = ldexp(out[l].t, -exponents[l]);
  return grazing;
}
