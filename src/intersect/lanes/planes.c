/* The slabs along a leaf, and its polynomials a and b, as a ray's two planes see them (paper eq 2 and 3).
 *
 * Compiled once per instruction set. The error bounds hold with and without fused multiply-add.
 */
#include <math.h>

#include "base/real.h"
#include "intersect/lanes/candidate.h"

/* Let e be the bound on a plane's error (local_ray.h), so that u <= e/36. Then a is off by less than 2.5 e, b w by 8u,
 * w by its two roundings and that of the start, what is made of them by e + 6u, and the net by 32u. */
lane_mask stage_slab(const struct packet *p, const struct candidate *it, lane_mask open)
{
  const struct leaf_slab *slab = &it->leaf->slab[0];
  const struct line *line = it->line;
  lanes a, b;
  slab_values(line, it->axis, slab, &a, &b);
  lanes from, to, off;
  ray_ends(p, it, p->t_far, &from, &to, &off);
  const lanes out = slab->half + 10 * line->error + off, at[2] = {a + b * from, a + b * to};
  return open & ~((lanes_min(at[0], at[1]) > out) | (lanes_max(at[0], at[1]) < -out));
}

/* In y = w to_t/|to_t|, which grows along the ray, a slab begins at -(a sign + its half)/|b|, the sign being b's in y.
 * Errors are those of stage_slab. The quotient's three roundings are 6u of |y| <= FRAME_END, for which the error of x_k
 * has room. The error of t is that of a root there. */
lanes slab_begin(const struct packet *p, const struct candidate *it)
{
  const struct line *line = it->line;
  lanes begin = lanes_all(-FRAME_END);
  for (int q = 0; q < 3; q++) {
    lanes a, b;
    slab_values(line, it->axis, &it->leaf->slab[q], &a, &b);
    const lanes along = lanes_select(line->to_t < 0, -b, b), out = it->leaf->slab[q].half + 10 * line->error;
    const lanes at = (-lanes_select(along < 0, -a, a) - out) / lanes_abs(b);
    begin = lanes_select((at > begin) & (lanes_abs(b) > 0), at, begin);
  }
  const lanes w = lanes_min(begin, lanes_all(FRAME_END)), size = lanes_abs(line->to_t);
  const lanes at = (lanes_select(line->to_t < 0, -w, w) + line->start[1] + line->start[0]) * line->to_t;
  return lanes_max(at - (size * line->error + 8 * UNIT_ROUNDOFF * (lanes_abs(at) + FRAME_END * size) + p->t_error),
                   p->t_min);
}

void planes_set(struct candidate *it)
{
  for (int n = 0; n < 16; n++) plane_values(it->line, it->axis, it->leaf->x, n, &it->a[n], &it->b[n]);
}

LANES_INLINE void weights_at(lanes t, lanes w[4])
{
  const lanes s = 1 - t, ss = s * s, tt = t * t, st = s * t;
  w[0] = ss * s, w[1] = 3 * (ss * t), w[2] = 3 * (st * t), w[3] = tt * t;
}

lanes plane_depth(const struct candidate *it, lanes u, lanes v)
{
  lanes wu[4], wv[4], w = {0};
  weights_at(u, wu), weights_at(v, wv);
  const double *x = it->leaf->x[it->axis];
  for (int i = 0; i < 4; i++)
    w += wu[i] * (x[4 * i] * wv[0] + x[4 * i + 1] * wv[1] + x[4 * i + 2] * wv[2] + x[4 * i + 3] * wv[3]);
  return w;
}
