/* Rays as the frame of a tree sees them, and the slab test in it: all of them on a box, or one on four boxes.
 *
 * Internal to src/intersect/lanes; what every step of a walk asks is inlined there.
 *
 * The boxes lie in the frame (world - origin)/frame, all within about [-1,1]. A ray is looked at there by its depth:
 * the distance along its dominant axis, counted from where it enters the frame, so that few bits are enough wherever
 * it comes from. Every rounding widens the boxes: an absolute slack for the origin's, a relative one for those of
 * the distances (Ize, Robust BVH Ray Traversal, 2013). So a box may be told as passed for nothing, but none is missed.
 */
#ifndef PSCN_INTERSECT_LANES_VIEW_H
#define PSCN_INTERSECT_LANES_VIEW_H

#include <string.h>

#include "base/float_lanes.h"
#include "intersect/lanes/packet.h"

#define FLOAT_ROUNDOFF 0x1p-24f

/* Growth of a depth that others are compared with: three roundings in each of the two (direction, reciprocal, sum), one
 * in the end of the ray, and those of growing. */
#define DEPTH_GROWTH (1 + 16 * FLOAT_ROUNDOFF)

/* Where in a node the planes stand that a ray comes to first and last along each axis, in bytes. */
struct sides {
  size_t first[3], last[3];
};

/* The rays of a packet or two, one behind the other as floats. A ray passes the plane x_k = c at a depth from c inverse
 * + early to c inverse + late. */
struct view {
  float_lanes inverse[3], early[3], late[3];
  float_lanes far;         /* where the rays end, by view_set_ends */
  lanes start[2], unit[2]; /* of each packet: depth = t unit - start */
  bool apart;              /* along each axis some rays go up and some down */
  bool alike;              /* all rays enter boxes by the same sides: */
  struct sides sides;
};

/* What the rays make of a node: where they enter its children, and their bits where they pass one before their ends. */
struct entries {
  float_lanes near[BVH_WIDTH];
  unsigned rays[BVH_WIDTH];
};

/* One ray of them, four times over. */
struct ray_view {
  four_floats inverse[3], early[3], late[3];
  struct sides sides;
};

/* view.c: the rays of these packets, one or two, in the tree's frame; all but their ends. Of a ray by itself no lane but the
 * first need be set, which ray_view_of asks for. */
void view_set(struct view *view, const struct packet packet[], int packets, const struct model_tree *tree);

/* view.c: the ends of the same rays, as they are now. */
void view_set_ends(struct view *view, const struct packet packet[], int packets);

/* view.c: view_boxes, of rays that enter boxes by different sides. */
void view_boxes_unlike(const struct view *view, const struct bvh_node *node, struct entries *out);

/* A row of four planes of a node, one for each child. */
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

/* `alike`: the view's. What the node has no child for means nothing. */
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
#pragma GCC unroll 4
  for (int side = 0; side < BVH_WIDTH; side++) {
    out->near[side] = near[side];
    out->rays[side] = float_lanes_up_to(near[side], far[side] * DEPTH_GROWTH);
  }
}

/* All rays on the boxes of a node; what it has no child for means nothing. */
LANES_INLINE void view_boxes(const struct view *view, const struct bvh_node *node, struct entries *out)
{
  if (view->alike) view_boxes_as(view, node, true, out);
  else view_boxes_unlike(view, node, out);
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

/* The node's children that the ray passes before `end`, as bits, and where it enters them; as view_boxes. */
LANES_INLINE unsigned ray_view_boxes(const struct ray_view *ray, float end, const struct bvh_node *node,
                                     float out_near[BVH_WIDTH])
{
  four_floats near = four_floats_all(0), far = four_floats_all(end), first, last;
  four_mask child;
  for (int k = 0; k < 3; k++) {
    memcpy(&first, node_row(node, ray->sides.first[k]), sizeof first);
    memcpy(&last, node_row(node, ray->sides.last[k]), sizeof last);
    near = four_floats_max(first * ray->inverse[k] + ray->early[k], near);
    far = four_floats_min(last * ray->inverse[k] + ray->late[k], far);
  }
  memcpy(&child, node->child, sizeof child), memcpy(out_near, &near, sizeof near);
  return four_mask_bits((near <= far * DEPTH_GROWTH) & (child != 0));
}

#endif
