/* Rays in the frame of a tree, and the slab tests there: of all rays on a box, or of one ray on four boxes.
 *
 * Internal to src/intersect/lanes. What every step of a walk calls is inline here.
 *
 * The boxes lie in the frame (world - origin)/frame, all within about [-1,1]. A ray's position there is its depth: the
 * distance along its dominant axis, counted from where it enters the frame, so that few bits are enough wherever it
 * comes from. Every rounding widens the boxes: those of the origin by an absolute slack, those of the distances by a
 * relative one (Ize, Robust BVH Ray Traversal, 2013). So the test may pass a box in vain, but never misses one.
 */
#ifndef PSCN_INTERSECT_LANES_VIEW_H
#define PSCN_INTERSECT_LANES_VIEW_H

#include <assert.h>
#include <string.h>

#include "base/float_lanes.h"
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

/* view.c: sets all but the ends of the rays of these 1 to PACKETS packets, in the tree's frame. */
void view_set(struct view *view, const struct packet packet[], int packets, const struct model_tree *tree);

/* view.c: sets the current ends of the same rays. */
void view_set_ends(struct view *view, const struct packet packet[], int packets);

/* view.c: view_boxes for rays that enter boxes by different sides. */
void view_boxes_unlike(const struct view *view, const struct bvh_node *node, struct entries *out);

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
 * rounding of half. The ray's slack (view.c) is at least 2^-22 (1 + R), and includes the other errors of `from`. */
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

#endif
