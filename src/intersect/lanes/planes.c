/* What a ray's two planes tell of a leaf: of the slabs along it, of its polynomials a and b (paper eq 2 and 3), and of
 * rays that start in a vertex of the patch.
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

lane_mask planes_meet_pole(const struct candidate *it)
{
  if (!it->leaf->pole) return (lane_mask){0};
  const int at = edge_at(it->leaf->pole - 1, 0);
  return lanes_max(lanes_abs(it->a[at]), lanes_abs(it->b[at])) < POLE_MET * it->line->error;
}

/* Whether these control points of the patch are equal numbers. */
static bool same_points(double P[4][4][3], int m, int n)
{
  const double *a = P[m / 4][m % 4], *b = P[n / 4][n % 4];
  return a[0] == b[0] && a[1] == b[1] && a[2] == b[2];
}

/* Lanes whose ray starts in control point `at` and meets no other point of the leaf. Where the net is `still` there, a
 * and b are 0. Either one combination of them, which aims at the middle of the rest, is above 0 on all of the rest; or
 * all of the rest is behind, where a difference of two coordinates is off by less than 2 e. */
static lane_mask leaves_start(const struct packet *p, const struct candidate *it, int at, const bool still[16])
{
  const double *x = it->leaf->x[it->axis];
  double low = INFINITY, high = -INFINITY;
  lanes a[16], b[16], A = {0}, B = {0}, size = {0}, least = lanes_all(INFINITY);
  for (int n = 0; n < 16; n++) {
    plane_values(it->line, it->axis, it->leaf->x, n, &a[n], &b[n]);
    size = lanes_max(size, lanes_max(lanes_abs(a[n]), lanes_abs(b[n])));
    if (!still[n]) A += a[n], B += b[n];
    if (!still[n]) low = real_min(low, x[n] - x[at]), high = real_max(high, x[n] - x[at]);
  }
  for (int n = 0; n < 16; n++)
    if (!still[n]) least = lanes_min(A * a[n] + B * b[n], least);
  /* the combination's three roundings come on top of the coefficients' error */
  const lanes off = (it->line->error + 8 * UNIT_ROUNDOFF * size) * (lanes_abs(A) + lanes_abs(B));
  const lanes up = p->direction[it->axis], nearest = lanes_select(up > 0, lanes_all(-high), lanes_all(low));
  return (least > off) | (nearest > 2 * it->line->error);
}

/* Sets `still` for the points that equal that corner of the patch, as do all between. */
static void still_at_corner(double P[4][4][3], int corner, bool still[16])
{
  const int down = corner & 12 ? -4 : 4, right = corner & 3 ? -1 : 1;
  for (int i = 0; i < 4; i++)
    for (int j = 0; j < 4; j++) {
      const int n = corner + i * down + j * right;
      still[n] = same_points(P, n, corner) && (i == 0 || still[n - down]) && (j == 0 || still[n - right]);
    }
}

/* Keeps of `still` the rows from that border on that are in it as a whole. */
static void keep_whole_rows(int border, bool still[16])
{
  bool whole = true;
  for (int steps = 0; steps < 4; steps++) {
    const int inward = steps * edge_inward(border);
    for (int k = 0; k < 4; k++) whole &= still[edge_at(border, k) + inward];
    for (int k = 0; k < 4; k++) still[edge_at(border, k) + inward] = whole;
  }
}

/* What holds for the patch holds for its leaves: for one in that corner, and for all at a pole, whose rows are in it as
 * a whole. */
lane_mask leaves_vertex(const struct packet *p, const struct candidate *it, lane_mask open)
{
  const struct leaf *leaf = it->leaf;
  const uint16_t *split = it->patch->cut.split;
  const int pole = leaf->pole - 1;
  lane_mask leaves = {0};
  for (int corner = 0; corner < 4; corner++) {
    const int u = corner / 2, v = corner % 2, at = 12 * u + 3 * v;
    const bool in_leaf = leaf->column_u == u * (split[0] - 1) && leaf->column_v == v * (split[1] - 1);
    if (!in_leaf && !(pole >= 0 && edge_at(pole, 0) == at)) continue;
    const lane_mask starts = open & packet_starts_at(p, leaf->patch, at);
    if (!lanes_any(starts)) continue;
    bool still[16];
    still_at_corner(p->model->scene->patches[leaf->patch].P, at, still);
    if (!in_leaf) keep_whole_rows(pole, still);
    leaves |= starts & leaves_start(p, it, at, still);
  }
  return leaves;
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
