/* What rays that go together through a hierarchy have still to go to, in the order in which they come to it.
 *
 * Internal to src/intersect/lanes: walk.c includes it.
 */
#ifndef PSCN_INTERSECT_LANES_WAITING_H
#define PSCN_INTERSECT_LANES_WAITING_H

#include "base/float_lanes.h"
#include "geometry/bvh.h"

/* Twice what a walk of node by node may leave, and the children of one more node. */
enum { MOST_WAITING = 2 * BVH_STACK + BVH_WIDTH };

/* Where rays that go together have still to go. What comes next is on top; `room` tells where near[] has the places at which the rays
 * enter, so that sorting moves little. The rooms of keys from `top` to `rooms` are free. */
struct waiting {
  size_t top, rooms;
  struct waiting_key {
    float first;   /* where the first of the rays enters */
    unsigned rays; /* a leaf's test on one ray must not depend on its neighbours, so each ray goes its own way */
    uint32_t child, room;
  } key[MOST_WAITING];
  float_lanes near[MOST_WAITING];
};

/* Puts it on, from `from` on in the order in which it is come to. */
LANES_INLINE void waiting_add(struct waiting *w, size_t from, struct waiting_key key, const float_lanes *near)
{
  size_t n = w->top++;
  if (n == w->rooms) w->key[w->rooms++].room = (uint32_t)n;
  key.room = w->key[n].room;
  for (; n > from && w->key[n - 1].first < key.first; n--) w->key[n] = w->key[n - 1];
  w->key[n] = key, w->near[key.room] = *near;
}

#endif
