/* Parts of nets. See leaf_nets.h.
 *
 * Compiled once per instruction set, without contraction and without fused multiply-add.
 */
#include "intersect/prepare/leaf_nets.h"

#include <string.h>

/* What follows does as geometry/patch.c does for one net, to the last bit. `ends`: t may be 1. */
LANES_INLINE lanes mix(lanes a, lanes b, lanes t, bool ends)
{
  const lanes mixed = a + t * (b - a);
  return ends ? lanes_select(t == 1, b, mixed) : mixed;
}

/* The control points: the cubic's blossom at from, from, from; from, from, to; and so on. */
LANES_INLINE void cubic_range(const lanes c[4], const struct lane_range *range, bool ends, lanes out[4])
{
  const lanes from = range->from, to = range->to;
  lanes low[3], high[3], lower[2], between[2], higher[2];
  for (int k = 0; k < 3; k++) low[k] = mix(c[k], c[k + 1], from, false), high[k] = mix(c[k], c[k + 1], to, ends);
  for (int k = 0; k < 2; k++) {
    lower[k] = mix(low[k], low[k + 1], from, false), between[k] = mix(low[k], low[k + 1], to, ends);
    higher[k] = mix(high[k], high[k + 1], to, ends);
  }
  out[0] = mix(lower[0], lower[1], from, false), out[1] = mix(lower[0], lower[1], to, ends);
  out[2] = mix(between[0], between[1], to, ends), out[3] = mix(higher[0], higher[1], to, ends);
}

LANES_INLINE void cubic_part(const lanes c[4], const struct lane_range *range, lanes out[4])
{
  if (range->whole) memcpy(out, c, 4 * sizeof *out);
  else if (range->ends) cubic_range(c, range, true, out);
  else cubic_range(c, range, false, out);
}

void subnet(const lane_net net, const struct lane_range *u, const struct lane_range *v, lane_net out)
{
  lane_net rows;
  for (int i = 0; i < 4; i++) cubic_part(net[i], v, rows[i]);
  for (int j = 0; j < 4; j++) {
    const lanes column[4] = {rows[0][j], rows[1][j], rows[2][j], rows[3][j]};
    lanes cut[4];
    cubic_part(column, u, cut);
    for (int i = 0; i < 4; i++) out[i][j] = cut[i];
  }
}

void subnet_widened(const lane_net net, double margin, lane_net out)
{
  const struct lane_range range = {lanes_all(-margin), lanes_all(1 + margin), false, false};
  subnet(net, &range, &range, out);
}
