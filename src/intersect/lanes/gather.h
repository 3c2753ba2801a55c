/* All roots of the rays of a packet, where nearest.h would keep only the first of each; and their answers.
 *
 * Internal to src/intersect/lanes.
 */
#ifndef PSCN_INTERSECT_LANES_GATHER_H
#define PSCN_INTERSECT_LANES_GATHER_H

#include "intersect/lanes/packet.h"

/* One root: what struct best has of a lane, in rows as lanes_store4 writes them. */
enum gathered_row {
  ROW_UV,       /* u, v, radius_u, radius_v */
  ROW_DISTANCE, /* t, its error, error of the point, 0; of the last two and all below something where `final` */
  ROW_POINT,    /* x, y, z, clearance */
  ROW_NORMAL,   /* x, y, z, tangent */
  ROWS
};

struct gathered {
  double row[ROWS][4];
  int64_t leaf; /* that and the patch order roots of equal t, as struct best's */
  uint32_t patch;
  uint8_t lane;
  bool certain, final;
};

/* What was left open, of a lane. */
struct gathered_region {
  struct exact_region region;
  unsigned lane;
};

/* The packet, which has just been started, gathers there from now on, beginning with nothing. */
void gather_start(struct packet *p, struct gather *gather);

/* Adds roots of the lanes of `taken`, at t within error of the packet's rays; `patch` is the scene's, `leaf` the
 * packet's model's. */
void gather_take(struct packet *p, lane_mask taken, const lanes at[2], const lanes radius[2], lanes t, lanes error,
                 int64_t patch, int64_t leaf, bool certain);

/* What is known of the surface at those that were added last, which were of the same lanes, and which of them are
 * final. */
void gather_surface(struct gather *gather, lane_mask taken, const struct surface_point *point, const lanes normal[3],
                    lanes tangent, lane_mask final);

/* Leaves a region to the last resort on these lanes, as bits. */
void gather_postpone(struct gather *gather, const struct exact_region *region, unsigned on);

/* The lists of the packet's rays but for `hits`, which are added to tracer->hits one behind the other; t times
 * 2^-exponents[lane] where that is not NULL. Returns whether there was memory. */
bool gather_finish(struct packet *p, const int *exponents, struct hit_list out[]);

#endif
