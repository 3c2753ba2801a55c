/* A bundle: packets whose rays go through a tree together, their view of it, whether their budgets last, and the leaves
 * that they defer.
 *
 * Internal to src/intersect/lanes: walk.c includes it.
 */
#ifndef PSCN_INTERSECT_LANES_BUNDLE_H
#define PSCN_INTERSECT_LANES_BUNDLE_H

#include "intersect/lanes/view.h"

struct bundle {
  struct packet packet[PACKETS];
  int packets; /* those that are not empty */
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

/* Sets whether leaves are deferred from here on. */
LANES_INLINE void bundle_set_later(struct bundle *b, bool later)
{
  b->later.count = 0;
  for (int h = 0; h < b->packets; h++)
    b->packet[h].later = later ? &b->later : NULL, b->packet[h].first_ray = (unsigned)h * LANES;
}

/* Defers the leaf for packets all of whose rays start in its slab. Returns the rays to be tried on it now. */
LANES_INLINE unsigned bundle_defer(struct bundle *b, uint32_t index, unsigned rays)
{
  const struct model *model = b->packet[0].model;
  if (!b->packet[0].later || index >= model->leaf_count) return rays;
  const unsigned others = rays & ~view_starts(&b->view, &model->oriented[index]);
  unsigned now = 0;
  for (int h = 0; h < PACKETS; h++) {
    const unsigned all = (unsigned)ALL_LANES << h * LANES;
    if (others & all) now |= rays & all;
  }
  return rays != now && later_add(&b->later, index, rays & ~now) ? now : rays;
}

#endif
