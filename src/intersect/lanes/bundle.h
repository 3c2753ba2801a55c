/* A bundle: packets whose rays go through a tree together, their view of it, whether their budgets last, and the leaves
 * that they defer.
 *
 * Internal to src/intersect/lanes: walk.c includes it.
 */
#ifndef PSCN_INTERSECT_LANES_BUNDLE_H
#define PSCN_INTERSECT_LANES_BUNDLE_H

#include "intersect/lanes/view.h"

/* For any hit: leaves that are deferred until all others have been tried. These are leaves that rays start in, and
 * seldom hit. A ray that has found a hit by then need not be tried on them. */
enum { MOST_LATER = 32 };
struct later {
  unsigned count;
  struct {
    uint32_t leaf;
    unsigned rays; /* as bits, of all packets of the bundle */
  } at[MOST_LATER];
};

struct bundle {
  struct packet packet[PACKETS];
  int packets; /* those that are not empty */
  bool defers; /* leaves to `later` */
  struct later later;
  struct view view;
  unsigned live; /* bit k: ray k still seeks a hit */
};

/* Takes over the ends of its packets' rays. */
static void bundle_update(struct bundle *b)
{
  b->live = 0;
  for (int h = 0; h < b->packets; h++) b->live |= lanes_bits(b->packet[h].live) << h * LANES;
  view_set_ends(&b->view, b->packet, b->packets);
}

/* Converts the rays to the frame of that tree. */
static void bundle_start(struct bundle *b, const struct model_tree *tree)
{
  view_set(&b->view, b->packet, b->packets, tree);
  bundle_update(b);
}

/* Stops rays that have exhausted their budgets. Out of line, because it is rare. */
__attribute__((noinline)) static void bundle_exhaust(struct bundle *b, unsigned rays)
{
  for (struct packet *p = b->packet; rays; p++, rays >>= LANES) {
    const unsigned here = rays & lanes_bits(p->live);
    if (here && !p->oriented) packet_orient(p);
    if (here) packet_exhaust(p, here);
  }
  bundle_update(b);
}

/* Charges boxes that the rays have tested together. Each ray is charged for all of them, because those that it would
 * test alone are among them. */
static void bundle_charge(struct bundle *b, int64_t boxes)
{
  unsigned exhausted = 0;
  for (int h = 0; h < b->packets; h++) {
    packet_charge(&b->packet[h], boxes + (lane_mask){0});
    exhausted |= lanes_bits(b->packet[h].postponed->left < 0) << h * LANES;
  }
  if (exhausted & b->live) bundle_exhaust(b, exhausted & b->live);
}

/* Charges a box that one ray tests. Returns whether its budget lasts. */
LANES_INLINE bool ray_charge(struct bundle *b, unsigned lane)
{
  if (--b->packet[lane / LANES].postponed->left[lane % LANES] >= 0) return true;
  bundle_exhaust(b, 1u << lane);
  return false;
}

/* Defers the leaf for packets all of whose rays start in its slab, as long as there is room. Returns the rays to be
 * tried on it now. */
LANES_INLINE unsigned bundle_defer(struct bundle *b, uint32_t index, unsigned rays)
{
  const struct model *model = b->packet[0].model;
  if (!b->defers || index >= model->leaf_count) return rays;
  const unsigned others = rays & ~view_starts(&b->view, &model->oriented[index]);
  unsigned now = 0;
  for (int h = 0; h < PACKETS; h++) {
    const unsigned all = (unsigned)ALL_LANES << h * LANES;
    if (others & all) now |= rays & all;
  }
  struct later *later = &b->later;
  unsigned k = 0;
  while (k < later->count && later->at[k].leaf != index) k++;
  if (rays == now || k == MOST_LATER) return rays;
  if (k == later->count) later->at[later->count++].leaf = index, later->at[k].rays = 0;
  later->at[k].rays |= rays & ~now;
  return now;
}

/* ---- what waits ---- */

/* Twice what a node-by-node walk may leave, and the children of one more node. */
enum { MOST_WAITING = 2 * BVH_STACK + BVH_WIDTH };

/* A stack of what the rays have yet to visit; what comes next is on top. `room` is the place in near[] of the depths at
 * which the rays enter, so that sorting moves only keys. The rooms of keys from `top` to `rooms` are free. */
struct waiting {
  size_t top, rooms;
  struct waiting_key {
    float first;   /* where the first of the rays enters */
    unsigned rays; /* those that enter: what is tried on a ray must not depend on its neighbours */
    uint32_t child, room;
  } key[MOST_WAITING];
  float_lanes near[MOST_WAITING];
};

/* Pushes the key, sorted by depth into the entries from `from` on. */
LANES_INLINE void waiting_add(struct waiting *w, size_t from, struct waiting_key key, const float_lanes *near)
{
  size_t n = w->top++;
  if (n == w->rooms) w->key[w->rooms++].room = (uint32_t)n;
  key.room = w->key[n].room;
  for (; n > from && w->key[n - 1].first < key.first; n--) w->key[n] = w->key[n - 1];
  w->key[n] = key, w->near[key.room] = *near;
}

/* ---- the way of a single ray ---- */

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
