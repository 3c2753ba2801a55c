/* Nets of several leaves, a leaf a lane: what the sources share that make the numbers of leaves.
 *
 * Internal to src/intersect/prepare; included by sources that are compiled once per instruction set, without contraction and
 * without fused multiply-add, so that every leaf has the same bits.
 */
#ifndef PSCN_INTERSECT_PREPARE_LEAF_NETS_H
#define PSCN_INTERSECT_PREPARE_LEAF_NETS_H

#include "base/kernel.h"
#include "base/lanes.h"
#include "intersect/model.h"

/* One of three coordinates, or of any other function of the surface: net[i][j], as in geometry/patch.h. */
typedef lanes lane_net[4][4];

/* As struct leaf_slab has it. */
struct lane_slab {
  lanes g[3], offset, half;
};

/* As struct leaf_quadric has it. */
struct lane_quadric {
  lanes c[6], off, turn[2], turn_wide[2], slack;
};

/* Coefficients about the middle, of a cubic in Bernstein form. */
LANES_INLINE void taylor(lanes b0, lanes b1, lanes b2, lanes b3, lanes out[4])
{
  out[0] = ((b0 + b3) + 3 * (b1 + b2)) / 8, out[1] = 0.75 * ((b3 - b0) + (b2 - b1));
  out[2] = 1.5 * ((b0 + b3) - (b1 + b2)), out[3] = (b3 - b0) - 3 * (b2 - b1);
}

/* That of s^i t^j at out[4 * i + j]. */
LANES_INLINE void taylor_net(const lane_net x, lanes out[16])
{
  lanes rows[4][4], column[4];
  for (int i = 0; i < 4; i++) taylor(x[i][0], x[i][1], x[i][2], x[i][3], rows[i]);
  for (int j = 0; j < 4; j++) {
    taylor(rows[0][j], rows[1][j], rows[2][j], rows[3][j], column);
    for (int i = 0; i < 4; i++) out[4 * i + j] = column[i];
  }
}

/* quadric.c: the quadric of leaves with nets x, which are `wide` where they are widened by LEAF_MARGIN. */
#define quadric_set KERNEL(quadric_set)
void quadric_set(const lane_net x[3], const lane_net wide[3], const struct lane_slab slab[3], struct lane_quadric *out);

#endif
