/* What rays that go through a hierarchy together have yet to visit, in the order in which they reach it.
 *
 * Internal to src/intersect/lanes: walk.c includes it.
 */
#ifndef PSCN_INTERSECT_LANES_WAITING_H
#define PSCN_INTERSECT_LANES_WAITING_H

#include "base/float_lanes.h"
#include "geometry/bvh.h"

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

#endif
