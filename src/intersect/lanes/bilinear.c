/* The root that is tried first on a candidate, from the bilinear part of its leaf.
 *
 * Compiled once per instruction set, without contraction. Parameters are s = u - 1/2 and t = v - 1/2.
 */
#include "intersect/lanes/nearest.h"

LANES_INLINE lanes plane_of(const struct line *line, int axis, int number, const double base[4][3], int n)
{
  return base[n][(axis + 1 + number) % 3] - line->slope[number] * base[n][axis];
}

/* t clamped to the leaf, or 0 if it is not a number. */
LANES_INLINE lanes near_middle(lanes t) { return lanes_clamp(lanes_select(t == t, t, lanes_all(0)), -0.5, 0.5); }

/* The root of the bilinear parts a = a0 + s a1 + t a2 + st a3, and b likewise, that is nearer to the middle. Bezout's
 * determinant (a0 + s a1)(b2 + s b3) - (a2 + s a3)(b0 + s b1) = r0 + r1 s + r2 s^2 eliminates t. A pair of complex
 * roots is replaced by its real part. The default method is in closed form; another one removes lanes from *open where
 * it finds no root. */
LANES_INLINE void bilinear_root(struct packet *p, const struct candidate *it, lane_mask *open, lanes start[2])
{
  lanes a[4], b[4], s;
  for (int n = 0; n < 4; n++) {
    a[n] = plane_of(it->line, it->axis, 0, it->leaf->parts.base, n);
    b[n] = plane_of(it->line, it->axis, 1, it->leaf->parts.base, n);
  }
  a[0] -= it->line->moment[0], b[0] -= it->line->moment[1];
  const lanes r0 = a[0] * b[2] - a[2] * b[0], r2 = a[1] * b[3] - a[3] * b[1];
  const lanes r1 = (a[0] * b[3] - a[3] * b[0]) + (a[1] * b[2] - a[2] * b[1]);
  if (it->patch->lanes == SOLVER_LANES_SIGNS) {
    const lanes root = lanes_sqrt(lanes_max(r1 * r1 - 4 * (r0 * r2), lanes_all(0)));
    s = -2 * r0 / (r1 + lanes_select(r1 < 0, -root, root));
  } else {
    s = method_quadratic_root(p, it, (lanes[3]){r0, r1, r2}, open);
  }
  s = near_middle(s);
  const lanes slope_a = a[2] + s * a[3], slope_b = b[2] + s * b[3];
  const lane_mask steep = lanes_abs(slope_a) > lanes_abs(slope_b);
  const lanes value = lanes_select(steep, a[0] + s * a[1], b[0] + s * b[1]);
  start[0] = s, start[1] = near_middle(-value / lanes_select(steep, slope_a, slope_b));
}

lane_mask stage_bilinear(struct packet *p, struct candidate *it, lane_mask active)
{
  struct leaf_root *root = &it->first;
  lanes start[2];
  lane_mask tried = active;
  bilinear_root(p, it, &tried, start);
  root->at.exists = (lane_mask){0};
  if (!lanes_any(tried)) return active;
  newton_solve(p, it->leaf, it->axis, start, tried, root);
  if (it->patch->lanes == SOLVER_LANES_SIGNS) p->tracer->counts.roots_found += lanes_count(root->at.alone);
  offer_root(p, it, root, (p->any ? root->at.exists : root->at.alone) & inside(&root->at));
  return active & ~root->at.alone & p->live;
}
