/* All roots of the rays of a packet, where nearest.h would keep only the first of each; and their answers.
 *
 * Internal to src/intersect/lanes.
 */
#ifndef PSCN_INTERSECT_LANES_GATHER_H
#define PSCN_INTERSECT_LANES_GATHER_H

#include "intersect/lanes/packet.h"

/* One root, as it was taken: u, v and their radii, t and its error; and the hit that it is. */
struct gathered {
  double uv[4], distance[4]; /* as lanes_store4 writes them; of the second two are used */
  struct hit hit;
  int64_t leaf; /* that and the hit's patch order roots of equal t, as struct best's */
  uint8_t lane;
  bool certain;
};

/* What was left open, of a lane. */
struct gathered_region {
  struct exact_region region;
  unsigned lane;
};

/* The packet, which has just been started, gathers there from now on, beginning with nothing. */
void gather_start(struct packet *p, struct gather *gather);

/* Adds the packet's best roots, which are those just taken on the lanes of `taken`, with their answers; then there is
 * no best again. */
void gather_best(struct packet *p, lane_mask taken);

/* Leaves a region to the last resort on these lanes, as bits. */
void gather_postpone(struct gather *gather, const struct exact_region *region, unsigned on);

/* The lists of the packet's rays but for `hits`, which are added to tracer->hits one behind the other; t times
 * 2^-exponents[lane] where that is not NULL. Returns whether there was memory. */
bool gather_finish(struct packet *p, const int *exponents, struct hit_list out[]);

#endif
