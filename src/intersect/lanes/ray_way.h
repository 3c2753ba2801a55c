/* How rays go from node to node of a tree: in which order, what is prefetched, and the way of a single ray.
 *
 * Internal to src/intersect/lanes: walk.c includes it.
 */
#ifndef PSCN_INTERSECT_LANES_RAY_WAY_H
#define PSCN_INTERSECT_LANES_RAY_WAY_H

#include "intersect/lanes/bundle.h"
#include "intersect/lanes/waiting.h"

/* What goes on the stack is needed soon, and rays of a large scene visit other boxes than those before them. So it is
 * prefetched meanwhile. */
LANES_INLINE void fetch_child(const struct model *model, const struct model_tree *tree, uint32_t child)
{
  const uint32_t box = child & ~BVH_LEAF;
  if (child == box) {
    __builtin_prefetch(&tree->bvh.nodes[child]);
    __builtin_prefetch(&tree->bvh.nodes[child].child);
  } else if (box < model->leaf_count) {
    __builtin_prefetch(&model->oriented[box]);
  }
}

/* Whether rays take what waits in the order in which they reach it, whichever node it is below, so that little is tried
 * behind a hit. Any hit is found the sooner the less waits, and for all hits the order does not matter. */
LANES_INLINE bool nearest_first(const struct bundle *b) { return !b->packet[0].any && !b->packet[0].gather; }

/* The place in the stack, with `top` entries waiting, from which new ones are sorted in. No more than BVH_STACK may
 * wait in that order; beyond that, what is below one of them goes node by node. */
LANES_INLINE size_t sorted_from(bool nearest, size_t top) { return nearest && top < BVH_STACK ? 0 : top; }

/* One ray on its way through a subtree. */
struct ray_way {
  struct ray_view ray;
  unsigned lane;
  bool nearest;   /* nearest_first */
  uint32_t child; /* where it is */
  size_t top;
  struct {
    float near;
    uint32_t child;
  } stack[MOST_WAITING];
};

LANES_INLINE void ray_begin(const struct bundle *b, uint32_t child, unsigned lane, struct ray_way *way)
{
  way->ray = ray_view_of(&b->view, lane), way->lane = lane, way->child = child, way->top = 0;
  way->nearest = nearest_first(b);
}

/* Goes on from a leaf, or from a node none of whose children is passed, to the nearest entry of the stack. Returns
 * whether there is one that the ray reaches. */
LANES_INLINE bool ray_next(const struct bundle *b, struct ray_way *way)
{
  do {
    if (way->top == 0) return false;
    way->top--;
  } while (way->stack[way->top].near > b->view.far[way->lane]);
  way->child = way->stack[way->top].child;
  return true;
}

LANES_INLINE void ray_wait(struct ray_way *way, size_t from, float near, uint32_t child)
{
  size_t n = way->top++;
  for (; n > from && way->stack[n - 1].near < near; n--) way->stack[n] = way->stack[n - 1];
  way->stack[n].near = near, way->stack[n].child = child;
}

/* Goes down from a node to the nearest of its children, testing one ray on four boxes; the other children wait. Returns
 * whether the ray goes on. */
LANES_INLINE bool ray_down(const struct bundle *b, const struct model_tree *tree, struct ray_way *way)
{
  const struct bvh_node *node = &tree->bvh.nodes[way->child];
  const size_t from = sorted_from(way->nearest, way->top);
  float near[BVH_WIDTH];
  unsigned sides = ray_view_boxes(&way->ray, b->view.far[way->lane], node, near);
  if (sides == 0) return ray_next(b, way);
  int next = __builtin_ctz(sides);
  for (sides &= sides - 1; sides; sides &= sides - 1) {
    const int side = __builtin_ctz(sides), farther = near[side] <= near[next] ? next : side;
    next = farther == side ? next : side;
    ray_wait(way, from, near[farther], node->child[farther]);
    fetch_child(b->packet[0].model, tree, node->child[farther]);
  }
  if (way->top > from && way->stack[way->top - 1].near < near[next]) {
    ray_wait(way, from, near[next], node->child[next]);
    return ray_next(b, way);
  }
  way->child = node->child[next];
  fetch_child(b->packet[0].model, tree, way->child);
  return true;
}

#endif
