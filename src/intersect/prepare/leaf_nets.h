/* Nets of several leaves, one leaf to a lane: shared by the sources that make the numbers of leaves.
 *
 * Internal to src/intersect/prepare; included by sources that are compiled once per instruction set, without
 * contraction and without fused multiply-add, so that every leaf has the same bits.
 */
#ifndef PSCN_INTERSECT_PREPARE_LEAF_NETS_H
#define PSCN_INTERSECT_PREPARE_LEAF_NETS_H

#include <assert.h>
#include <stddef.h>

#include "base/kernel.h"
#include "base/lanes.h"
#include "intersect/model.h"

/* One of three coordinates, or any other function of the surface: net[i][j], as in geometry/patch.h. */
typedef lanes lane_net[4][4];

/* As struct leaf_slab. */
struct lane_slab {
  lanes g[3], offset, half;
};

/* ---- parts ---- */

/* A range of a parameter, from < 1. `whole`: [0,1] on all lanes, so that nets are copied. */
struct lane_range {
  lanes from, to;
  bool whole;
  bool ends; /* on some lane `to` is 1 */
};

/* leaf_nets.c: the net over these ranges, by blossoms, equal to the last bit to that of geometry/patch.c. */
#define subnet KERNEL(subnet)
void subnet(const lane_net net, const struct lane_range *u, const struct lane_range *v, lane_net out);

/* leaf_nets.c: the net over [-margin, 1 + margin] in both parameters. */
#define subnet_widened KERNEL(subnet_widened)
void subnet_widened(const lane_net net, double margin, lane_net out);

/* ---- Taylor's polynomial ---- */

/* Coefficients about the middle of a cubic in Bernstein form. */
LANES_INLINE void taylor(lanes b0, lanes b1, lanes b2, lanes b3, lanes out[4])
{
  out[0] = ((b0 + b3) + 3 * (b1 + b2)) / 8, out[1] = 0.75 * ((b3 - b0) + (b2 - b1));
  out[2] = 1.5 * ((b0 + b3) - (b1 + b2)), out[3] = (b3 - b0) - 3 * (b2 - b1);
}

/* The coefficient of s^i t^j goes to out[4 * i + j]. */
LANES_INLINE void taylor_net(const lane_net x, lanes out[16])
{
  lanes rows[4][4], column[4];
  for (int i = 0; i < 4; i++) taylor(x[i][0], x[i][1], x[i][2], x[i][3], rows[i]);
  for (int j = 0; j < 4; j++) {
    taylor(rows[0][j], rows[1][j], rows[2][j], rows[3][j], column);
    for (int i = 0; i < 4; i++) out[4 * i + j] = column[i];
  }
}

/* ---- stored ---- */

enum { LEAF = sizeof(struct leaf) / sizeof(double) };
static_assert(sizeof(struct leaf) == LEAF * sizeof(double), "leaves are so many doubles apart");

/* Writes value[k] of the first `here` lanes to to[k], each lane `stride` doubles behind the one before; count is at
 * least 4. */
LANES_INLINE void lanes_scatter(const lanes value[], int count, size_t here, double *to, size_t stride)
{
  for (int k = 0; k < count && here == LANES; k += 4) {
    const int at = k + 4 <= count ? k : count - 4; /* the last four, some of them twice */
    lanes_store4(value[at], value[at + 1], value[at + 2], value[at + 3], to + at, stride);
  }
  for (size_t lane = 0; lane < here && here < LANES; lane++)
    for (int k = 0; k < count; k++) to[lane * stride + (size_t)k] = value[k][lane];
}

/* Reads what lanes_scatter writes. Lanes from `here` on get the first's. */
LANES_INLINE void lanes_gather(lanes value[], int count, size_t here, const double *from, size_t stride)
{
  for (size_t lane = 0; lane < LANES; lane++)
    for (int k = 0; k < count; k++) value[k][lane] = from[(lane < here ? lane : 0) * stride + (size_t)k];
}

/* quadric.c: leaf_quadrics, leaf.h. */
#define quadrics_make KERNEL(quadrics_make)
void quadrics_make(size_t count, struct leaf leaves[]);

#endif
