/* The rays of a packet: loaded, oriented, and taken to the frame of a patch.
 *
 * Compiled once per instruction set.
 */
#include <math.h>

#include "intersect/lanes/packet.h"

/* Loads the rays. The array has LANES of them, of which those from `count` on repeat the first, or a single one if
 * `count` is 1. */
LANES_INLINE void packet_start(struct packet *p, struct tracer *tracer, const struct ray *rays, size_t count, bool any,
                               struct postponed *postponed)
{
  p->postponed = postponed;
  p->tracer = tracer, p->model = tracer->model, p->rays = rays, p->count = count, p->any = any;
  p->outer = NULL, p->gather = NULL, p->net_error = 0, p->t_error = lanes_all(0);
  p->live = lanes_mask((1u << count) - 1);
  lanes *o = p->origin, *d = p->direction;
  if (count == 1) {
    for (int k = 0; k < 3; k++) o[k] = lanes_all(rays->origin[k]), d[k] = lanes_all(rays->direction[k]);
    p->t_min = lanes_all(rays->t_min), p->t_max = lanes_all(rays->t_max);
  } else {
    lanes_load4(rays->origin, RAY_STRIDE, &o[0], &o[1], &o[2], &d[0]);
    lanes_load4(&rays->direction[1], RAY_STRIDE, &d[1], &d[2], &p->t_min, &p->t_max);
  }
  p->t_far = p->t_max;
  packet_untried(p);
}

/* Directions whose longest component is outside these are scaled by a power of two, to a longest component from 1 to 2.
 * That is exact: numbers are 0 or from 1e-100 to 1e100. */
#define DIRECTION_MIN 0x1p-16
#define DIRECTION_MAX 0x1p16

static struct ray ray_scaled(const struct ray *ray, int *out_exponent)
{
  const double *d = ray->direction, largest = fabs(d[dominant_axis(d)]);
  struct ray r = *ray;
  *out_exponent = 0;
  if (largest >= DIRECTION_MIN && largest <= DIRECTION_MAX) return r;
  frexp(largest, out_exponent);
  --*out_exponent;
  for (int k = 0; k < 3; k++) r.direction[k] = ldexp(d[k], -*out_exponent);
  r.t_min = ldexp(r.t_min, *out_exponent), r.t_max = ldexp(r.t_max, *out_exponent);
  return r;
}

/* Makes the packet from copies of its rays. Out of line, because it is rare. */
__attribute__((noinline)) static void packet_copied(struct packet *p, struct ready *ready, struct tracer *tracer,
                                                    size_t count, const struct ray rays[], bool any)
{
  ready->copied = true;
  for (size_t l = 0; l < count; l++) ready->copy[l] = ray_scaled(&rays[l], &ready->exponent[l]);
  for (size_t l = count; l < LANES; l++) ready->copy[l] = ready->copy[0];
  packet_start(p, tracer, ready->copy, count, any, &ready->postponed);
}

void packet_begin(struct packet *p, struct ready *ready, struct tracer *tracer, size_t count, const struct ray rays[],
                  bool any, int budget)
{
  struct postponed *postponed = &ready->postponed;
  ready->copied = false;
  postponed->left = budget + (lane_mask){0}, postponed->cut_from = lanes_all(INFINITY);
  postponed->open = postponed->exhausted = 0;
  for (int l = 0; l < LANES; l++) postponed->count[l] = 0;
  if (count == 1 || count == LANES) {
    packet_start(p, tracer, rays, count, any, postponed);
    if (!lanes_any((p->longest < DIRECTION_MIN) | (p->longest > DIRECTION_MAX))) return;
  }
  packet_copied(p, ready, tracer, count, rays, any);
}

void packet_orient(struct packet *p)
{
  lanes size[3];
  for (int k = 0; k < 3; k++) size[k] = lanes_abs(p->direction[k]);
  p->oriented = true, p->t_end = p->t_far;
  /* As dominant_axis does. */
  const lane_mask first = (size[0] >= size[1]) & (size[0] >= size[2]), second = ~first & (size[1] >= size[2]);
  p->on_axis[0] = p->live & first, p->on_axis[1] = p->live & second, p->on_axis[2] = p->live & ~first & ~second;
  p->axes = 0;
  for (int k = 0; k < 3; k++) {
    if (!lanes_any(p->on_axis[k])) continue;
    p->axes |= 1u << k;
    p->reciprocal[k] = 1 / p->direction[k];
    for (int s = 0; s < 2; s++) {
      const lanes d = p->direction[(k + 1 + s) % 3], slope = d * p->reciprocal[k];
      p->line[k].slope[s] = lanes_select(p->on_axis[k], slope, lanes_all(0));
      p->line[k].slope_rest[s] = -lanes_product_error(slope, p->direction[k], d) * p->reciprocal[k];
    }
  }
  p->best.u = p->best.v = p->best.radius_u = p->best.radius_v = lanes_all(0), p->best.t = lanes_all(INFINITY);
  p->best.patch = p->best.leaf = NO_PATCH + (lane_mask){0};
  p->best.certain = p->best.final = p->best.doubt = (lane_mask){0};
}

void packet_set_patch(struct packet *p, const struct model_patch *patch, uint32_t index)
{
  lanes hi[3], lo[3];
  const double inverse = 1 / patch->scale;
  if (!p->oriented) packet_orient(p);
  for (int k = 0; k < 3; k++) {
    const struct double_lanes from = double_lanes_sum(p->origin[k], lanes_all(-patch->center[k]));
    hi[k] = from.hi * inverse, lo[k] = from.lo * inverse;
  }
  for (int k = 0; k < 3; k++) {
    if (!(p->axes & 1u << k)) continue;
    struct line *line = &p->line[k];
    lanes far[2];
    for (int s = 0; s < 2; s++) {
      const int i = (k + 1 + s) % 3;
      far[s] = MOMENT_ERROR(lanes_abs(hi[i]), lanes_abs(hi[k] * line->slope[s]));
      const lanes plus = hi[i] * p->direction[k], minus = hi[k] * p->direction[i];
      const lanes plus_error = lanes_product_error(hi[i], p->direction[k], plus);
      const lanes minus_error = lanes_product_error(hi[k], p->direction[i], minus);
      struct double_lanes sum = double_lanes_sum(plus, -minus);
      sum.lo += (plus_error - minus_error) + (lo[i] * p->direction[k] - lo[k] * p->direction[i]);
      const lanes moment = (sum.hi + sum.lo) * p->reciprocal[k];
      line->moment[s] = moment;
      line->moment_rest[s] = (sum.lo - lanes_product_error(moment, p->direction[k], sum.hi)) * p->reciprocal[k];
    }
    line->start[0] = -hi[k], line->start[1] = -lo[k];
    line->to_t = patch->scale * p->reciprocal[k];
    line->error = PLANE_ERROR(lanes_abs(line->moment[0]), lanes_abs(line->moment[1])) + lanes_max(far[0], far[1]) +
                  2 * p->net_error * inverse;
  }
  p->patch = index;
}
