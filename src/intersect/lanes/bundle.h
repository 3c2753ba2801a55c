/* A bundle: packets whose rays go through a tree together, their view of it, their share of work, and the leaves that
 * they put off.
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
  int depth;     /* of its tree: the number of frames around it, including those around the copy */
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

/* Gives up rays that have used up their looks. Out of line, because it is rare. */
__attribute__((noinline)) static void bundle_let_go(struct bundle *b, unsigned rays)
{
  for (struct packet *p = b->packet; rays; p++, rays >>= LANES) {
    const unsigned here = rays & lanes_bits(p->live);
    if (here && !p->oriented) packet_orient(p);
    if (here) packet_give_up(p, here);
  }
  bundle_update(b);
}

/* Counts boxes that the rays have looked at together. Each ray is charged for all of them, for those that it would look
 * at alone are among them. */
static void bundle_looked(struct bundle *b, int64_t looks)
{
  unsigned worn = 0;
  for (int h = 0; h < b->packets; h++) {
    const lane_mask left = packet_spend(&b->packet[h], looks + (lane_mask){0});
    worn |= lanes_bits(left < 0) << h * LANES;
  }
  if (worn & b->live) bundle_let_go(b, worn & b->live);
}

/* Counts a box that one ray looks at. Returns whether it may. */
LANES_INLINE bool ray_looks(struct bundle *b, unsigned lane)
{
  if (--b->packet[lane / LANES].postponed->looks[lane % LANES] >= 0) return true;
  bundle_let_go(b, 1u << lane);
  return false;
}

/* Sets whether leaves are put off from here on. */
LANES_INLINE void bundle_set_later(struct bundle *b, bool later)
{
  b->later.count = 0;
  for (int h = 0; h < b->packets; h++)
    b->packet[h].later = later ? &b->later : NULL, b->packet[h].first_ray = (unsigned)h * LANES;
}

/* Puts the leaf off for packets all of whose rays start in its slab. Returns the rays to be tried on it now. */
LANES_INLINE unsigned bundle_put_off(struct bundle *b, uint32_t index, unsigned rays)
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
