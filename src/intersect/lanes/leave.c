/* Where rays that leave hits start, a few at a time: tracer_leave says why there.
 *
 * Compiled once per instruction set and without contraction.
 */
#include <string.h>

#include "intersect/lanes/packet.h"

/* At less than this sine between ray and surface, the way back along the ray is no longer than the clearance over this.
 */
#define LEAST_SLANT 0x1p-20

/* A hit as near as this to a border of its patch, in parameters, may have another surface beside it. */
#define BESIDE_BORDER 0x1p-20

/* How a hit with that patch and certainty begins. */
LANES_INLINE int64_t start_of(uint32_t patch, enum certainty certainty)
{
  const struct hit hit = {.patch = patch, .certainty = certainty};
  int64_t start;
  memcpy(&start, &hit, sizeof start);
  return start;
}

/* The ray's point at t, along one axis: rounded, then one or two doubles nearer to the ray's origin. */
LANES_INLINE lanes short_of(lanes origin, lanes direction, lanes t)
{
  const lanes at = lanes_product_error(t, direction, -origin), step = 0x1p-52 * lanes_abs(at);
  return lanes_select(direction == 0, at, at - lanes_select(direction < 0, -step, step));
}

LANES_INLINE lanes from_border(lanes u, lanes v) { return lanes_min(lanes_min(u, 1 - u), lanes_min(v, 1 - v)); }

/* LANES rays at once; returns what leave_some does. */
LANES_INLINE struct left leave_lanes(const struct ray rays[], const struct hit hits[], const struct leaving *to,
                                     struct ray out[])
{
  lanes ox, oy, oz, dx, dy, dz, t_min, t_max, both, t, u, v, px, py, pz, error, clearance, nx, ny, nz;
  lanes_load4(rays->origin, RAY_STRIDE, &ox, &oy, &oz, &dx);
  lanes_load4(&rays->direction[1], RAY_STRIDE, &dy, &dz, &t_min, &t_max);
  lanes_load4((const double *)(const void *)hits, HIT_STRIDE, &both, &t, &u, &v);
  lanes_load4(hits->point, HIT_STRIDE, &px, &py, &pz, &error);
  lanes_load4(&hits->clearance, HIT_STRIDE, &clearance, &nx, &ny, &nz);
  const lanes o[3] = {ox, oy, oz}, d[3] = {dx, dy, dz}, point[3] = {px, py, pz}, normal[3] = {nx, ny, nz};
  const lane_mask hit = ((lane_mask)both & start_of(HIT_NONE, 0)) != start_of(HIT_NONE, 0);
  const lane_mask certain = ((lane_mask)both & start_of(0, (enum certainty) - 1)) == start_of(0, CERTAINTY_CERTAIN);
  lanes way[3], facing = lanes_all(0), slant = lanes_all(0), longest = lanes_all(0);
  for (int c = 0; c < 3; c++) {
    way[c] = to->is_point ? to->to[c] - point[c] : lanes_all(to->to[c]);
    facing += way[c] * normal[c], slant += normal[c] * d[c];
    longest = lanes_max(lanes_abs(d[c]), longest);
  }
  const lane_mask through = facing < 0;
  lanes back = to->longer * clearance / lanes_max(lanes_abs(slant), LEAST_SLANT * longest);
  back = lanes_select(through, -back, back), t = lanes_max(t - back, t_min);
  lanes start[3], on[3], moves = lanes_all(0);
  for (int c = 0; c < 3; c++) {
    start[c] = lanes_select(certain, short_of(o[c], d[c], t), point[c] - back * d[c]);
    on[c] = to->is_point ? to->to[c] - start[c] : way[c];
    moves = lanes_max(lanes_abs(on[c]), moves);
  }
  for (int c = 0; c < 3; c++) on[c] = lanes_select(moves > 0, on[c], way[c]); /* the start is the very point */
  lanes_store4(start[0], start[1], start[2], on[0], out->origin, RAY_STRIDE);
  lanes_store4(on[1], on[2], lanes_all(0), lanes_all(to->end), &out->direction[1], RAY_STRIDE);
  return (struct left){lanes_bits(hit & (facing > 0)),
                       lanes_bits(hit & certain & ~through & (from_border(u, v) <= BESIDE_BORDER))};
}

struct left leave_some(size_t count, const struct ray rays[], const struct hit hits[], const struct leaving *to,
                       struct ray out[])
{
  struct left left = {0, 0};
  for (size_t first = 0; first < count; first += LANES) {
    struct ray from[LANES], some[LANES];
    struct hit at[LANES];
    const bool whole = count - first >= LANES;
    for (size_t l = 0; l < LANES && !whole; l++) { /* those beyond the last repeat it */
      const size_t k = first + l < count ? first + l : count - 1;
      from[l] = rays[k], at[l] = hits[k];
    }
    const struct left of = leave_lanes(whole ? rays + first : from, whole ? hits + first : at, to,
                                       whole ? out + first : some);
    for (size_t l = 0; first + l < count && !whole; l++) out[first + l] = some[l];
    const unsigned there = whole ? ~0u : (1u << (count - first)) - 1;
    left.facing |= (of.facing & there) << first, left.beside |= (of.beside & there) << first;
  }
  return left;
}
