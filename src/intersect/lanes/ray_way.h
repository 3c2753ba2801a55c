/* How rays go from node to node of a tree: in which order, what is sent for from memory, and one ray's way.
 *
 * Internal to src/intersect/lanes: walk.c includes it.
 */
#ifndef PSCN_INTERSECT_LANES_RAY_WAY_H
#define PSCN_INTERSECT_LANES_RAY_WAY_H

#include "intersect/lanes/bundle.h"
#include "intersect/lanes/waiting.h"

/* What is on the stack is wanted soon, and the rays of a large scene come by other boxes than those before them: it is
 * brought from memory meanwhile. */
LANES_INLINE void fetch_child(const struct model *model, const struct bvh *bvh, uint32_t child)
{
  const uint32_t box = child & ~(uint32_t)BVH_LEAF;
  if (child == box) {
    __builtin_prefetch(&bvh->nodes[child]);
    __builtin_prefetch(&bvh->nodes[child].child);
  } else if (box < model->leaf_count) {
    __builtin_prefetch(&model->oriented[box]);
  }
}

/* Where rays cross so many surfaces, what waits is taken in the order in which rays come to it, whatever node it is below, so
 * that little is tried that lies behind a hit. Elsewhere that is not worth the sorting; and any hit is found the sooner the
 * less waits. */
enum { MANY_CROSSINGS = 4 };

LANES_INLINE bool nearest_first(const struct bundle *b, const struct model_tree *tree)
{
  return tree->crossings >= MANY_CROSSINGS && !b->packet[0].any && !b->packet[0].gather;
}

/* From where on what comes to the `top` that wait is sorted in: in that order no more than BVH_STACK may wait, and what is below
 * one of them then goes node by node. */
LANES_INLINE size_t sorted_from(bool nearest, size_t top) { return nearest && top < BVH_STACK ? 0 : top; }

/* One ray on its way through what is below some node. */
struct ray_way {
  struct ray_view ray;
  unsigned lane;
  bool nearest;   /* see nearest_first */
  uint32_t child; /* where it is */
  size_t top;
  struct {
    float near;
    uint32_t child;
  } stack[MOST_WAITING];
};

LANES_INLINE void ray_begin(const struct bundle *b, const struct model_tree *tree, uint32_t child, unsigned lane,
                            struct ray_way *way)
{
  way->ray = ray_view_of(&b->view, lane), way->lane = lane, way->child = child, way->top = 0;
  way->nearest = nearest_first(b, tree);
}

/* From a leaf, or a node none of whose children is passed, to what is nearest of what is on the stack. Returns whether the ray
 * goes on. */
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

/* From a node to the nearest of its children, four boxes at a time instead of all rays; the others wait. Returns whether the ray
 * goes on. */
LANES_INLINE bool ray_down(const struct bundle *b, const struct bvh *bvh, struct ray_way *way)
{
  const struct bvh_node *node = &bvh->nodes[way->child];
  const size_t from = sorted_from(way->nearest, way->top);
  float near[BVH_WIDTH];
  unsigned sides = ray_view_boxes(&way->ray, b->view.far[way->lane], node, near);
  if (sides == 0) return ray_next(b, way);
  int next = __builtin_ctz(sides);
  for (sides &= sides - 1; sides; sides &= sides - 1) {
    const int side = __builtin_ctz(sides), farther = near[side] <= near[next] ? next : side;
    next = farther == side ? next : side;
    ray_wait(way, from, near[farther], node->child[farther]);
    fetch_child(b->packet[0].model, bvh, node->child[farther]);
  }
  if (way->top > from && way->stack[way->top - 1].near < near[next]) {
    ray_wait(way, from, near[next], node->child[next]);
    return ray_next(b, way);
  }
  way->child = node->child[next];
  fetch_child(b->packet[0].model, bvh, way->child);
  return true;
}

#endif
