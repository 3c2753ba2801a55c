/* Rays converted to the frame of a tree, from doubles to floats.
 *
 * Compiled once per instruction set.
 */
#include <math.h>

#include "base/real.h"
#include "intersect/lanes/view.h"

/* The bits of all rays. */
#define ALL_RAYS ((1u << (FLOAT_LANES - 1) << 1) - 1)

/* The half width of a cube that holds all boxes, with the roundings of making them. */
#define FRAME_HALF 1.0625

/* A ray that starts farther away than FRAME_NEAR is moved up to the frame first. Doubles lose it from beyond FRAME_FAR. */
#define FRAME_NEAR 16.0
#define FRAME_FAR 0x1p30

/* Bound on the rounding of a ray's start, or of the frame's origin, on the way into the frame, relative to its
 * coordinates. */
#define START_ROUNDOFF (16 * UNIT_ROUNDOFF)

/* Further errors of the origin, relative to its size in the frame or to 1. They are the roundings to float of the
 * origin, of its sum with the slack, and of that sum's product with the reciprocal; and of a box, whose planes are off
 * by as much. */
#define ORIGIN_SLACK 0x1p-22

/* Stands in for the reciprocal of 0. It is so large that whatever is beyond the slack ends up beyond the frame, but
 * finite, so that 0 times it is 0. */
#define HUGE_INVERSE 0x1p80f

/* A packet's rays in the frame. */
struct placed {
  lanes from[3], along[3]; /* where they start, and their directions, the longest component being 1 */
  lanes slack;             /* bound on the error of a coordinate of `from` */
  lanes start, unit;       /* the view's */
};

/* Moves on to the depth where the rays start. */
LANES_INLINE void advance(struct placed *it)
{
  for (int k = 0; k < 3; k++) it->from[k] += it->start * it->along[k];
  it->slack += 8 * UNIT_ROUNDOFF * lanes_abs(it->start);
}

/* Moves rays that start farther away than FRAME_NEAR to where their lines enter the frame, or before it. Those beyond
 * FRAME_FAR, where doubles lose them, pass every box. Out of line, because it is rare. */
__attribute__((noinline)) static void come_near(lanes farthest, struct placed *it)
{
  lanes enter = lanes_all(-INFINITY);
  for (int k = 0; k < 3; k++) {
    const lanes half = FRAME_HALF + it->slack, inverse = 1 / it->along[k];
    enter = lanes_max(lanes_min((-half - it->from[k]) * inverse, (half - it->from[k]) * inverse), enter);
  }
  it->start = lanes_max(enter, it->start);
  advance(it);
  const lane_mask lost = ~(farthest <= FRAME_FAR);
  for (int k = 0; k < 3; k++) it->from[k] = lanes_select(lost, lanes_all(0), it->from[k]);
  it->start = lanes_select(lost, lanes_all(0), it->start),
  it->slack = lanes_select(lost, lanes_all(FRAME_FAR), it->slack);
}

/* size: START_ROUNDOFF times twice the distance from the world's origin to the frame's. One half is for the frame's
 * origin. The other, with the ray's distance from the frame's origin, covers its distance from the world's. */
LANES_INLINE void place(const struct packet *p, const struct model_tree *tree, double to_frame, double size,
                        struct placed *it)
{
  const lanes shrink = 1 / p->longest;
  for (int k = 0; k < 3; k++) {
    it->along[k] = p->direction[k] * shrink;
    it->from[k] = (p->origin[k] - tree->origin[k]) * to_frame;
  }
  const lanes farthest = largest_of(it->from);
  it->slack = START_ROUNDOFF * farthest + size;
  it->unit = p->longest * to_frame;
  /* No ray is in the frame before this depth, because its dominant coordinate is outside. In the coordinates of a
   * copy's object the start is known only to t_error, which from far away is many times the object's size. */
  it->start = lanes_max((p->t_min - p->t_error) * it->unit, -(farthest + 2));
  if (lanes_any(~(farthest <= FRAME_NEAR))) come_near(farthest, it);
  else advance(it);
  it->slack += ORIGIN_SLACK * (1 + largest_of(it->from));
}

LANES_INLINE void set(struct view *view, const struct packet packet[], int packets, const struct model_tree *tree)
{
  const double *o = tree->origin, to_frame = 1 / tree->frame; /* a power of two */
  const double size = 2 * START_ROUNDOFF * real_max(real_max(fabs(o[0]), fabs(o[1])), fabs(o[2])) * to_frame;
  lanes from[3][PACKETS], along[3][PACKETS], slack[PACKETS];
  for (int h = 0; h < packets; h++) {
    struct placed it;
    place(&packet[h], tree, to_frame, size, &it);
    for (int k = 0; k < 3; k++) from[k][h] = it.from[k], along[k][h] = it.along[k];
    slack[h] = it.slack, view->start[h] = it.start, view->unit[h] = it.unit;
  }
  for (int h = packets; h < PACKETS; h++) { /* as the other */
    for (int k = 0; k < 3; k++) from[k][h] = from[k][packets - 1], along[k][h] = along[k][packets - 1];
    slack[h] = slack[packets - 1];
  }
  view->alike = view->apart = true;
  const float_lanes off = float_lanes_join(slack);
  for (int k = 0; k < 3; k++) {
    const float_lanes at = float_lanes_join(from[k]), d = float_lanes_join(along[k]);
    const float_lanes huge = float_lanes_select(d < 0, float_lanes_all(-HUGE_INVERSE), float_lanes_all(HUGE_INVERSE));
    const float_lanes inverse = float_lanes_select(float_lanes_abs(d) > 1 / HUGE_INVERSE, 1 / d, huge);
    const float_lanes to_low = (at + off) * -inverse, to_high = (at - off) * -inverse;
    const unsigned down = float_lanes_bits(d < 0);
    view->inverse[k] = inverse, view->from[k] = at, view->along[k] = d;
    view->early[k] = float_lanes_min(to_low, to_high), view->late[k] = float_lanes_max(to_low, to_high);
    const bool same = down == 0 || down == ALL_RAYS;
    view->alike &= same, view->apart &= !same;
    sides_set(&view->sides, k, down != 0);
  }
  view->widen = WIDE_SLACKS * off;
}

/* Two calls, so that one packet costs no loops over more. */
void view_set(struct view *view, const struct packet packet[], int packets, const struct model_tree *tree)
{
  if (packets == 1) set(view, packet, 1, tree);
  else set(view, packet, PACKETS, tree);
}

void view_set_ends(struct view *view, const struct packet packet[], int packets)
{
  lanes far[PACKETS];
  for (int k = 0; k < PACKETS; k++) {
    const int h = k < packets ? k : packets - 1;
    const lanes end = packet[h].t_far * view->unit[h];
    far[k] = (end - view->start[h]) + 8 * UNIT_ROUNDOFF * (lanes_abs(end) + lanes_abs(view->start[h]));
  }
  view->far = float_lanes_join(far) * DEPTH_GROWTH;
}

/* Out of line: otherwise the compiler hoists the products that both forms share, and fuses none of them. */
void view_boxes_unlike(const struct view *view, const struct bvh_node *node, struct entries *out)
{
  view_boxes_as(view, node, false, out);
}
