/* Rays taken to the frame of a tree, from doubles to floats.
 *
 * Compiled once per instruction set.
 */
#include <math.h>

#include "base/lane_points.h"
#include "base/real.h"
#include "intersect/lanes/view.h"

/* All rays' bits. */
#define ALL_RAYS ((1u << (FLOAT_LANES - 1) << 1) - 1)

/* All boxes, and the roundings of making them. */
#define FRAME_HALF 1.0625

/* A ray that starts farther away is moved up to the frame first; in wide arithmetic where that would lose it. */
#define FRAME_NEAR 16.0
#define FRAME_FAR 0x1p30

/* What rounding may do to the start of a ray, or to the frame's origin, on the way into the frame: of its coordinates. */
#define START_ROUNDOFF (16 * UNIT_ROUNDOFF)

/* What may be wrong with the origin besides its own roundings, relative to its size in the frame or to 1: rounding it
 * and its sum with the slack to float, its product with the reciprocal, and a box's, for the planes are that far off
 * then. */
#define ORIGIN_SLACK 0x1p-22

/* A stand-in for the reciprocal of 0: so large that all that is beyond the slack ends up beyond the frame, finite so
 * that 0 times it is 0. */
#define HUGE_INVERSE 0x1p80f

/* The depth where the line of a ray enters the frame, or less. */
static lanes frame_entry(const lanes from[3], const lanes slack[3], const lanes direction[3])
{
  lanes enter = lanes_all(-INFINITY);
  for (int k = 0; k < 3; k++) {
    const lanes half = FRAME_HALF + slack[k], inverse = 1 / direction[k];
    enter = lanes_max(lanes_min((-half - from[k]) * inverse, (half - from[k]) * inverse), enter);
  }
  return enter;
}

/* Out of line, for it is rare: where the rays of the lanes `far` come to the frame, as local_ray.h has it. */
__attribute__((noinline)) static void come_near(const struct packet *p, const struct model_tree *tree, lane_mask far,
                                                lanes from[3], lanes slack[3], lanes *start)
{
  for (unsigned bits = lanes_bits(far); bits; bits &= bits - 1) {
    const int l = __builtin_ctz(bits);
    struct ray ray = {.t_min = p->t_min[l] - p->t_error[l]};
    double at[3];
    for (int k = 0; k < 3; k++) ray.origin[k] = p->origin[k][l], ray.direction[k] = p->direction[k][l];
    (*start)[l] = local_ray_enter(&ray, tree->origin, tree->frame, at);
    /* the ray is where it should be, but the frame's origin is rounded */
    for (int k = 0; k < 3; k++) from[k][l] = at[k], slack[k][l] = START_ROUNDOFF * fabs(tree->origin[k]) / tree->frame;
  }
}

LANES_INLINE void set(struct view *view, const struct packet packet[], int packets, const struct model_tree *tree)
{
  view->alike = view->apart = true;
  const double to_frame = 1 / tree->frame; /* a power of two */
  lanes low[3][PACKETS], high[3][PACKETS], along[3][PACKETS], from[3][PACKETS], widen[PACKETS];
  const int last = packets - 1;
  for (int h = 0; h <= last; h++) {
    const struct packet *p = &packet[h];
    const lanes shrink = 1 / p->longest;
    lanes at[3], slack[3], direction[3], farthest = {0};
    for (int k = 0; k < 3; k++) {
      along[k][h] = direction[k] = p->direction[k] * shrink;
      at[k] = (p->origin[k] - tree->origin[k]) * to_frame;
      slack[k] = START_ROUNDOFF * (lanes_abs(p->origin[k]) + fabs(tree->origin[k])) * to_frame;
      farthest = lanes_max(lanes_abs(at[k]), farthest);
    }
    view->unit[h] = p->longest * to_frame;
    /* No ray is in the frame before this depth: its dominant coordinate is outside. In the coordinates of a copy's
     * object its start is known to t_error only, which from far away is many times the object's size. */
    lanes start = lanes_max((p->t_min - p->t_error) * view->unit[h], -(farthest + 2));
    if (lanes_any(farthest > FRAME_NEAR)) start = lanes_max(frame_entry(at, slack, direction), start);
    for (int k = 0; k < 3; k++) at[k] += start * direction[k], slack[k] += 8 * UNIT_ROUNDOFF * lanes_abs(start);
    const lane_mask far = ~(farthest <= FRAME_FAR);
    if (lanes_any(far)) come_near(p, tree, far, at, slack, &start);
    view->start[h] = start;
    widen[h] = lanes_all(0);
    for (int k = 0; k < 3; k++) {
      slack[k] += ORIGIN_SLACK * (1 + lanes_abs(at[k]));
      low[k][h] = at[k] + slack[k], high[k][h] = at[k] - slack[k], from[k][h] = at[k];
      widen[h] = lanes_max(slack[k], widen[h]);
    }
  }
  for (int h = packets; h < PACKETS; h++) { /* as the last */
    for (int k = 0; k < 3; k++)
      low[k][h] = low[k][last], high[k][h] = high[k][last], along[k][h] = along[k][last], from[k][h] = from[k][last];
    widen[h] = widen[last];
  }
  for (int k = 0; k < 3; k++) {
    const float_lanes d = float_lanes_join(along[k]);
    const float_lanes huge = float_lanes_select(d < 0, float_lanes_all(-HUGE_INVERSE), float_lanes_all(HUGE_INVERSE));
    const float_lanes inverse = float_lanes_select(float_lanes_abs(d) > 1 / HUGE_INVERSE, 1 / d, huge);
    const float_lanes to_low = float_lanes_join(low[k]) * -inverse;
    const float_lanes to_high = float_lanes_join(high[k]) * -inverse;
    const unsigned down = float_lanes_bits(d < 0);
    view->inverse[k] = inverse, view->from[k] = float_lanes_join(from[k]), view->along[k] = d;
    view->early[k] = float_lanes_min(to_low, to_high), view->late[k] = float_lanes_max(to_low, to_high);
    const bool same = down == 0 || down == ALL_RAYS;
    view->alike &= same, view->apart &= !same;
    sides_set(&view->sides, k, down != 0);
  }
  view->widen = WIDE_SLACKS * float_lanes_join(widen);
}

#if LANES == 4
/* The same of one ray, all that lane 0 wants, with its coordinates side by side. Returns false where it starts so far away
 * that there is more to be done. */
static bool set_one(struct view *view, const struct packet *p, const struct model_tree *tree)
{
  const double to_frame = 1 / tree->frame, longest = p->longest[0], unit = longest * to_frame;
  const lanes *o = p->origin, *d = p->direction;
  const lanes origin = {o[0][0], o[1][0], o[2][0], o[2][0]}, middle = lane_points_load(tree->origin);
  const lanes along = lanes_all(1 / longest) * (lanes){d[0][0], d[1][0], d[2][0], d[2][0]};
  lanes from = (origin - middle) * to_frame,
        slack = START_ROUNDOFF * (lanes_abs(origin) + lanes_abs(middle)) * to_frame;
  const lanes far = lanes_abs(from);
  const double farthest = real_max(real_max(far[0], far[1]), far[2]),
               start = real_max(p->t_min[0] * unit, -(farthest + 2));
  if (!(farthest <= FRAME_NEAR)) return false;
  from += start * along, slack += 8 * UNIT_ROUNDOFF * fabs(start);
  slack += ORIGIN_SLACK * (1 + lanes_abs(from));
  const four_floats way = __builtin_convertvector(along, four_floats);
  const four_floats low = __builtin_convertvector(from + slack, four_floats);
  const four_floats high = __builtin_convertvector(from - slack, four_floats);
  const four_floats huge = four_floats_select(way < 0, four_floats_all(-HUGE_INVERSE), four_floats_all(HUGE_INVERSE));
  const four_floats inverse = four_floats_select(four_floats_abs(way) > 1 / HUGE_INVERSE, 1 / way, huge);
  const four_floats to_low = low * -inverse, to_high = high * -inverse;
  const four_floats early = four_floats_min(to_low, to_high), late = four_floats_max(to_low, to_high);
  const four_floats at = __builtin_convertvector(from, four_floats);
  for (int k = 0; k < 3; k++) {
    view->inverse[k][0] = inverse[k], view->early[k][0] = early[k], view->late[k][0] = late[k];
    view->from[k][0] = at[k], view->along[k][0] = way[k];
  }
  view->widen[0] = WIDE_SLACKS * (float)real_max(real_max(slack[0], slack[1]), slack[2]);
  view->start[0][0] = start, view->unit[0][0] = unit;
  view->apart = view->alike = false;
  return true;
}
#endif

/* Twice in the code, so that one packet costs no loops over more; out of line for the room they take. */
__attribute__((noinline)) static void set_many(struct view *view, const struct packet packet[], int packets,
                                               const struct model_tree *tree)
{
  if (packets == 1) set(view, packet, 1, tree);
  else set(view, packet, PACKETS == 2 ? 2 : packets, tree);
}

void view_set(struct view *view, const struct packet packet[], int packets, const struct model_tree *tree)
{
#if LANES == 4
  if (packets == 1 && packet->count == 1 && set_one(view, packet, tree)) return;
#endif
  set_many(view, packet, packets, tree);
}

void view_set_ends(struct view *view, const struct packet packet[], int packets)
{
  if (packets == 1 && packet->count == 1) {
    const double end = packet->t_far[0] * view->unit[0][0], start = view->start[0][0];
    view->far[0] = (float)((end - start) + 8 * UNIT_ROUNDOFF * (fabs(end) + fabs(start))) * DEPTH_GROWTH;
    return;
  }
  lanes far[PACKETS];
  for (int k = 0; k < PACKETS; k++) {
    const int h = k < packets ? k : packets - 1;
    const lanes end = packet[h].t_far * view->unit[h];
    far[k] = (end - view->start[h]) + 8 * UNIT_ROUNDOFF * (lanes_abs(end) + lanes_abs(view->start[h]));
  }
  view->far = float_lanes_join(far) * DEPTH_GROWTH;
}

/* Out of line, or the compiler takes the products that both forms have in front of them, and fuses none. */
void view_boxes_unlike(const struct view *view, const struct bvh_node *node, struct entries *out)
{
  view_boxes_as(view, node, false, out);
}
