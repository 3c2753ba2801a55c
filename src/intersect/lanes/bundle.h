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

/* Defers the leaf for these rays. Returns false if there is no room. */
static inline bool later_add(struct later *later, uint32_t leaf, unsigned rays)
{
  unsigned k = 0;
  while (k < later->count && later->at[k].leaf != leaf) k++;
  if (k == MOST_LATER) return false;
  if (k == later->count) later->at[later->count++].leaf = leaf, later->at[k].rays = 0;
  later->at[k].rays |= rays;
  return true;
}

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

/* Defers the leaf for packets all of whose rays start in its slab. Returns the rays to be tried on it now. */
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
  return rays != now && later_add(&b->later, index, rays & ~now) ? now : rays;
}

#endif
