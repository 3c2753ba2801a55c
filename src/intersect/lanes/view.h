/* Rays in the frame of a tree, and the slab tests there: of all rays on a box, or of one ray on four boxes.
 *
 * Internal to src/intersect/lanes: bundle.h includes it.
 *
 * The boxes lie in the frame (world - origin)/frame, all within about [-1,1]. A ray's position there is its depth: the
 * distance along its dominant axis, counted from where it enters the frame, so that few bits are enough wherever it
 * comes from. Every rounding widens the boxes: those of the origin by an absolute slack, those of the distances by a
 * relative one (Ize, Robust BVH Ray Traversal, 2013). So the test may pass a box in vain, but never misses one.
 */
#ifndef PSCN_INTERSECT_LANES_VIEW_H
#define PSCN_INTERSECT_LANES_VIEW_H

#include <assert.h>
#include <math.h>
#include <string.h>

#include "base/float_lanes.h"
#include "base/real.h"
#include "intersect/lanes/packet.h"

#define FLOAT_ROUNDOFF 0x1p-24f

/* Growth of a depth that others are compared with. It covers three roundings in each of the two depths (direction,
 * reciprocal, sum), one in the end of the ray, and those of the growth itself. */
#define DEPTH_GROWTH (1 + 16 * FLOAT_ROUNDOFF)

/* The byte offsets, in a node, of the planes that a ray meets first and last along each axis. */
struct sides {
  size_t first[3], last[3];
};

/* The rays of some packets, side by side as floats. A ray passes the plane x_k = c at a depth between c inverse + early
 * and c inverse + late. */
struct view {
  float_lanes inverse[3], early[3], late[3];
  float_lanes far;                     /* where the rays end; view_set_ends sets it */
  lanes start[PACKETS], unit[PACKETS]; /* of each packet: depth = t unit - start */
  float_lanes from[3], along[3];       /* a ray's point at a depth: from + along depth */
  float_lanes widen;                   /* oriented boxes are widened by this for each ray */
  bool apart;                          /* along each axis some rays go up and some down */
  bool alike;                          /* all rays enter boxes by the same sides, `sides` */
  struct sides sides;
};

/* What the rays find at a node: the depths where they enter its children, and a bit for each ray and child that it
 * passes before its end. The bits of child k begin at bit SIDE_BITS k. */
struct entries {
  float_lanes near[BVH_WIDTH];
  uint64_t rays;
};

enum { SIDE_BITS = 16 };
static_assert(FLOAT_LANES <= SIDE_BITS && SIDE_BITS * BVH_WIDTH == 64, "room for all rays of all children");

/* The bits of these rays for every child. */
LANES_INLINE uint64_t rays_of_sides(unsigned rays) { return rays * UINT64_C(0x0001000100010001); }

/* The bits of all rays for every child that exists. */
LANES_INLINE uint64_t node_sides(const struct bvh_node *node)
{
  four_mask child;
  memcpy(&child, node->child, sizeof child);
  return four_mask_words(child != 0);
}

/* A child of a node, and the rays that enter it. */
struct entered {
  int side;
  unsigned rays;
  float first; /* where the first of them enters */
};

/* Takes the first child out of *sides, which is not 0. */
LANES_INLINE struct entered take_side(const struct entries *in, uint64_t *sides)
{
  const int at = __builtin_ctzll(*sides), side = at / SIDE_BITS;
  const uint64_t all = ((UINT64_C(1) << SIDE_BITS) - 1) << SIDE_BITS * side;
  const struct entered child = {side, (unsigned)((*sides & all) >> SIDE_BITS * side), in->near[side][at % SIDE_BITS]};
  *sides &= ~all;
  return child;
}

/* One of the rays, repeated in four lanes. */
struct ray_view {
  four_floats inverse[3], early[3], late[3];
  struct sides sides;
};

/* The size of a row of four planes of a node, one for each child. */
enum { NODE_ROW = sizeof(float[BVH_WIDTH]) };

LANES_INLINE const float *node_row(const struct bvh_node *node, size_t at)
{
  return (const float *)(const void *)((const char *)node + at);
}

LANES_INLINE void sides_set(struct sides *sides, int k, bool down)
{
  const size_t lo = offsetof(struct bvh_node, lo), hi = offsetof(struct bvh_node, hi), at = (size_t)k * NODE_ROW;
  sides->first[k] = (down ? hi : lo) + at, sides->last[k] = (down ? lo : hi) + at;
}

/* `alike` is view->alike, known at compile time. */
LANES_INLINE void view_boxes_as(const struct view *view, const struct bvh_node *node, bool alike, struct entries *out)
{
  float_lanes near[BVH_WIDTH], far[BVH_WIDTH];
  for (int k = 0; k < 3; k++) {
    const float_lanes inverse = view->inverse[k], early = view->early[k], late = view->late[k];
    const float *first = alike ? node_row(node, view->sides.first[k]) : node->lo[k];
    const float *last = alike ? node_row(node, view->sides.last[k]) : node->hi[k];
#pragma GCC unroll 4
    for (int side = 0; side < BVH_WIDTH; side++) {
      const float_lanes one = first[side] * inverse, other = last[side] * inverse;
      const float_lanes enter = (alike ? one : float_lanes_min(one, other)) + early;
      const float_lanes leave = (alike ? other : float_lanes_max(one, other)) + late;
      near[side] = float_lanes_max(enter, k > 0 ? near[side] : float_lanes_all(0));
      far[side] = float_lanes_min(leave, k > 0 ? far[side] : view->far);
    }
  }
  uint64_t rays = 0;
#pragma GCC unroll 4
  for (int side = 0; side < BVH_WIDTH; side++) {
    out->near[side] = near[side];
    rays |= (uint64_t)float_lanes_up_to(near[side], far[side] * DEPTH_GROWTH) << SIDE_BITS * side;
  }
  out->rays = rays & node_sides(node);
}

/* view_boxes for rays that enter boxes by different sides. Out of line: otherwise the compiler hoists the products that
 * both forms share, and fuses none of them. */
__attribute__((noinline)) static void view_boxes_unlike(const struct view *view, const struct bvh_node *node,
                                                        struct entries *out)
{
  view_boxes_as(view, node, false, out);
}

/* Tests all rays on the boxes of a node. */
LANES_INLINE void view_boxes(const struct view *view, const struct bvh_node *node, struct entries *out)
{
  if (view->alike) view_boxes_as(view, node, true, out);
  else view_boxes_unlike(view, node, out);
}

/* ---- oriented boxes ---- */

/* For a box's slab |g x - offset| <= half, a ray has A + B depth, with A = g from - offset and B = g along. |g| is at
 * most 1 in sum; let R be the largest coordinate of `from`. Roundings to floats and of sums, fused or not, move A by
 * less than 2^-21 (R + 1) and B by 2^-21. Where the ray is in the frame, its depth is no more than R + 2, so they move
 * A + B depth by 2^-20 (R + 2) in all. What is made of A and B is off by an eighth of that; leaf_orient allows for the
 * rounding of half. The ray's slack (ORIGIN_SLACK) is at least 2^-22 (1 + R), and includes the other errors of `from`.
 * */
#define WIDE_SLACKS 8

/* `widen` times this, plus 1, is no less than R + 2. */
#define WIDE_REACH 0x1p19f

/* More than underflow of floats can lose. */
#define WIDE_LEAST 0x1p-110f

/* As bits, the rays that may be in the box before their ends. Two slabs have a depth in common where |A_q B_r - A_r
 * B_q| <= half_q |B_r| + half_r |B_q|; and the ray must meet the slab across the leaf before its end. */
LANES_INLINE unsigned view_oriented(const struct view *view, const struct oriented_box *box)
{
  float_lanes a[3], b[3], size[3], half[3];
  for (int q = 0; q < 3; q++) {
    a[q] = view->from[0] * box->g[0][q] +
           (view->from[1] * box->g[1][q] + (view->from[2] * box->g[2][q] - box->offset[q]));
    b[q] = view->along[0] * box->g[0][q] + (view->along[1] * box->g[1][q] + view->along[2] * box->g[2][q]);
    size[q] = float_lanes_abs(b[q]), half[q] = view->widen + box->half[q];
  }
  const float_lanes end = a[0] + b[0] * float_lanes_min(view->far, view->widen * WIDE_REACH + 1);
  float_mask out = (float_lanes_min(a[0], end) > half[0]) | (float_lanes_max(a[0], end) < -half[0]);
  for (int q = 0; q < 3; q++) {
    const int r = (q + 1) % 3;
    out |= float_lanes_abs(a[q] * b[r] - a[r] * b[q]) > half[q] * size[r] + (half[r] * size[q] + WIDE_LEAST);
  }
  return ~float_lanes_bits(out);
}

/* As bits, the rays that start in the slab across the leaf, as far as floats show. */
LANES_INLINE unsigned view_starts(const struct view *view, const struct oriented_box *box)
{
  const float_lanes a = view->from[0] * box->g[0][0] +
                        (view->from[1] * box->g[1][0] + (view->from[2] * box->g[2][0] - box->offset[0]));
  return float_lanes_bits(float_lanes_abs(a) <= view->widen + box->half[0]);
}

LANES_INLINE four_floats four_floats_load(const float *from)
{
  four_floats x;
  memcpy(&x, from, sizeof x);
  return x;
}

/* view_oriented for one ray, with the three slabs side by side. */
LANES_INLINE bool view_oriented_one(const struct view *view, unsigned lane, const struct oriented_box *box)
{
  const four_floats g0 = four_floats_load(box->g[0]), g1 = four_floats_load(box->g[1]),
                    g2 = four_floats_load(box->g[2]);
  const four_floats half = view->widen[lane] + four_floats_load(box->half);
  const four_floats a = g0 * view->from[0][lane] +
                        (g1 * view->from[1][lane] + (g2 * view->from[2][lane] - four_floats_load(box->offset)));
  const four_floats b = g0 * view->along[0][lane] + (g1 * view->along[1][lane] + g2 * view->along[2][lane]);
  const four_floats size = four_floats_abs(b);
  const float far = view->far[lane], reach = view->widen[lane] * WIDE_REACH + 1;
  const four_floats end = a + b * (far < reach ? far : reach);
  const four_mask beyond = (four_floats_min(a, end) > half) | (four_floats_max(a, end) < -half);
  const four_floats apart = four_floats_abs(a * four_floats_next(b) - four_floats_next(a) * b);
  const four_mask out = beyond | (apart > half * four_floats_next(size) + (four_floats_next(half) * size + WIDE_LEAST));
  return (four_mask_bits(out) & 7) == 0;
}

LANES_INLINE struct ray_view ray_view_of(const struct view *view, unsigned lane)
{
  struct ray_view ray;
  for (int k = 0; k < 3; k++) {
    ray.inverse[k] = four_floats_all(view->inverse[k][lane]);
    ray.early[k] = four_floats_all(view->early[k][lane]), ray.late[k] = four_floats_all(view->late[k][lane]);
    sides_set(&ray.sides, k, view->inverse[k][lane] < 0);
  }
  return ray;
}

/* The node's children, as bits, that the ray passes before `end`, and where it enters them. The test is that of
 * view_boxes. */
LANES_INLINE unsigned ray_view_boxes(const struct ray_view *ray, float end, const struct bvh_node *node,
                                     float out_near[BVH_WIDTH])
{
  four_floats near = four_floats_all(0), far = four_floats_all(end);
  four_mask child;
  for (int k = 0; k < 3; k++) {
    const four_floats first = four_floats_load(node_row(node, ray->sides.first[k]));
    const four_floats last = four_floats_load(node_row(node, ray->sides.last[k]));
    near = four_floats_max(first * ray->inverse[k] + ray->early[k], near);
    far = four_floats_min(last * ray->inverse[k] + ray->late[k], far);
  }
  memcpy(&child, node->child, sizeof child), memcpy(out_near, &near, sizeof near);
  return four_mask_bits((near <= far * DEPTH_GROWTH) & (child != 0));
}

/* ---- rays in the frame ---- */

/* The bits of all rays. */
#define ALL_RAYS ((1u << (FLOAT_LANES - 1) << 1) - 1)

/* The half width of a cube that holds all boxes, with the roundings of making them. */
#define FRAME_HALF 1.0625

/* A ray that starts farther away than FRAME_NEAR is moved up to the frame first. Doubles lose it from beyond FRAME_FAR.
 * */
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

/* Sets all but the ends of the rays of these 1 to PACKETS packets, in the tree's frame. Two calls, so that one packet
 * costs no loops over more. */
static void view_set(struct view *view, const struct packet packet[], int packets, const struct model_tree *tree)
{
  if (packets == 1) set(view, packet, 1, tree);
  else set(view, packet, PACKETS, tree);
}

/* Sets the current ends of the same rays. */
static void view_set_ends(struct view *view, const struct packet packet[], int packets)
{
  lanes far[PACKETS];
  for (int k = 0; k < PACKETS; k++) {
    const int h = k < packets ? k : packets - 1;
    const lanes end = packet[h].t_far * view->unit[h];
    far[k] = (end - view->start[h]) + 8 * UNIT_ROUNDOFF * (lanes_abs(end) + lanes_abs(view->start[h]));
  }
  view->far = float_lanes_join(far) * DEPTH_GROWTH;
}

#endif
