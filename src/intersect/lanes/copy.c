/* A packet in the coordinates of an object, and back. Compiled once per instruction set and without contraction.
 *
 * A ray o + t d is moved along itself to o + shift d, where it passes the middle of the copy, and then taken to the
 * object's coordinates. All that is in about twice the precision, so the ray is right to its last places near the
 * object. copies.c bounds the rounding that is left, model_object.error.
 */
#include "base/double_lanes.h"
#include "intersect/lanes/packet.h"

/* For a start up to this many times the object's error away, in the object's coordinates, twice the precision leaves
 * less unknown than that error: 2^-104 of the way, by a map that may stretch errors by 2^10 (copies.c). Rays from
 * farther away, some 2^38 objects, get no proven answer from the copy. */
#define FARTHEST_WAY 0x1p88

void packet_enter(struct packet *outer, const struct model_copy *copy, lane_mask active, struct packet *inner)
{
  if (!outer->oriented) packet_orient(outer);
  inner->tracer = outer->tracer, inner->model = copy->object->model, inner->rays = NULL, inner->count = LANES;
  inner->any = outer->any, inner->outer = outer, inner->copy = copy, inner->postponed = outer->postponed;
  inner->gather = outer->gather;
  inner->live = active & outer->live;
  lanes ahead = lanes_all(0), square = lanes_all(0);
  for (int k = 0; k < 3; k++) {
    const lanes d = outer->direction[k];
    ahead += (copy->b[k] - outer->origin[k]) * d, square += d * d;
  }
  inner->shift = ahead / square;
  struct double_lanes from[3]; /* the middle */
  for (int k = 0; k < 3; k++) {
    const struct double_lanes way = double_lanes_product(inner->shift, outer->direction[k]);
    const struct double_lanes origin = double_lanes_sum(outer->origin[k], lanes_all(-copy->b[k]));
    const struct double_lanes sum = double_lanes_sum(way.hi, origin.hi);
    from[k] = (struct double_lanes){sum.hi, sum.lo + (way.lo + origin.lo)};
  }
  for (int j = 0; j < 3; j++) {
    lanes hi = lanes_all(0), lo = lanes_all(0), direction = lanes_all(0);
    for (int k = 0; k < 3; k++) {
      const struct double_lanes part = double_lanes_scale(from[k], lanes_all(copy->W[k][j]));
      const struct double_lanes sum = double_lanes_sum(hi, part.hi);
      hi = sum.hi, lo += sum.lo + part.lo;
      direction += outer->direction[k] * copy->W[k][j];
    }
    inner->origin[j] = hi + lo, inner->direction[j] = direction;
  }
  inner->net_error = copy->object->error;
  packet_untried(inner);
  const lane_mask far = inner->live & ~(lanes_abs(inner->shift) * inner->longest <= FARTHEST_WAY * inner->net_error);
  if (lanes_any(far)) packet_exhaust(inner, lanes_bits(far));
  const lanes shift = inner->shift;
  inner->t_min = outer->t_min - shift, inner->t_max = outer->t_max - shift;
  inner->t_far = (outer->t_far - shift) + 4 * UNIT_ROUNDOFF * (lanes_abs(shift) + lanes_abs(outer->t_far));
  inner->t_error = 2 * inner->net_error / inner->longest +
                   8 * UNIT_ROUNDOFF * (lanes_abs(shift) + lanes_abs(outer->t_min));
}

void packet_leave(struct packet *inner)
{
  struct packet *outer = inner->outer;
  const struct best *found = &inner->best;
  if (!inner->oriented) return;
  const lanes t = inner->shift + found->t;
  const lanes far = (inner->shift + inner->t_far) +
                    4 * UNIT_ROUNDOFF * (lanes_abs(inner->shift) + lanes_abs(inner->t_far));
  const lane_mask hits = found->patch != NO_PATCH;
  lane_mask rival = hits & (lanes_abs(t - outer->best.t) <= (far - t) + (outer->t_far - outer->best.t)), tied = {0};
  if (lanes_any(rival)) {
    tied = one_surface(outer->model, found->patch, outer->best.patch, rival), rival &= ~tied;
    packet_postpone_best(inner, rival);
  }
  const lane_mask after = best_after(&outer->best, t, found->patch, found->leaf);
  const lane_mask taken = hits & ~rival & ((tied & (found->patch < outer->best.patch)) | (~tied & after));
  if (!lanes_any(taken)) return;
  const lanes uv[2] = {found->u, found->v}, radius[2] = {found->radius_u, found->radius_v};
  best_take(&outer->best, taken, uv, radius, t, found->patch, found->leaf);
  outer->t_far = lanes_select(taken, far, outer->t_far);
  if (outer->any) outer->live &= ~taken;
  outer->moved = true;
}
