/* All roots of the rays of a packet, where nearest.h would keep only the nearest of each, and their answers.
 *
 * Internal to src/intersect/lanes.
 */
#ifndef PSCN_INTERSECT_LANES_GATHER_H
#define PSCN_INTERSECT_LANES_GATHER_H

#include "intersect/lanes/packet.h"

/* Has the packet, which has just been started, gather there, beginning with nothing. */
void gather_start(struct packet *p, struct gather *gather);

/* Adds the packet's best roots, which were just taken on the lanes of `taken`, with their answers. Then there is no
 * best again. */
void gather_best(struct packet *p, lane_mask taken);

/* Leaves a patch of the scene to the last resort on that lane. */
void gather_postpone(struct gather *gather, uint32_t patch, unsigned lane);

/* Writes the lists of the packet's rays, except for `hits`: these are added to tracer->hits, one list after the other.
 * t is multiplied by 2^-exponents[lane] if `exponents` is not NULL. Returns whether there was memory. */
bool gather_finish(struct packet *p, const int *exponents, struct hit_list out[]);

#endif
