/* What a ray's two planes tell of a leaf: of the slabs along it, of its polynomials a and b (paper eq 2 and 3), and of
 * rays that start in its pole or in a corner of the patch.
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

/* Lanes on which neither polynomial keeps one sign on its whole net. */
static lane_mask planes_hull(struct candidate *it, lane_mask active)
{
  lanes a_low, a_high, b_low, b_high;
  for (int n = 0; n < 16; n++) {
    const lanes a = it->a[n], b = it->b[n];
    a_low = n ? lanes_min(a, a_low) : a, a_high = n ? lanes_max(a, a_high) : a;
    b_low = n ? lanes_min(b, b_low) : b, b_high = n ? lanes_max(b, b_high) : b;
  }
  const lanes e = it->line->error;
  it->alpha = lanes_max(-a_low, a_high), it->beta = lanes_max(-b_low, b_high);
  return active & (a_low <= e) & (a_high >= -e) & (b_low <= e) & (b_high >= -e);
}

/* Sets the polynomials. Returns the lanes on which neither keeps one sign. */
static lane_mask planes_make(struct candidate *it, lane_mask active)
{
  for (int n = 0; n < 16; n++) plane_values(it->line, it->axis, it->leaf->x, n, &it->a[n], &it->b[n]);
  return planes_hull(it, active);
}

/* Lanes on which the net is above 0 in one corner and below in another. */
LANES_INLINE lane_mask corners_differ(const lanes net[16], lanes e)
{
  const lanes low = lanes_min(lanes_min(net[0], net[3]), lanes_min(net[12], net[15]));
  const lanes high = lanes_max(lanes_max(net[0], net[3]), lanes_max(net[12], net[15]));
  return (low < -e) & (high > e);
}

/* The error of A a + B b, over |A| + |B|. */
LANES_INLINE lanes combination_error(const struct candidate *it)
{
  return it->line->error + 4 * UNIT_ROUNDOFF * (it->alpha + it->beta);
}

/* The lanes on which neither of the two combinations of a and b that aim along the leaf's parameters keeps one sign.
 * Near the middle they are like u - u0 and v - v0, for the point (u0,v0) where the ray meets the tangent plane, so they
 * detect rays that miss the leaf. Where both are nothing but rounding all over the leaf, a and b are one polynomial,
 * and the ray meets curves. */
static lane_mask planes_aligned(struct candidate *it, lane_mask active)
{
  const lanes *a = it->a, *b = it->b;
  const lanes au = (a[13] + a[14]) - (a[1] + a[2]), av = (a[7] + a[11]) - (a[4] + a[8]);
  const lanes bu = (b[13] + b[14]) - (b[1] + b[2]), bv = (b[7] + b[11]) - (b[4] + b[8]);
  lanes u_low = bv * a[0] - av * b[0], v_low = au * b[0] - bu * a[0], u_high = u_low, v_high = v_low;
  for (int n = 1; n < 16; n++) {
    const lanes u = bv * a[n] - av * b[n], v = au * b[n] - bu * a[n];
    u_low = lanes_min(u, u_low), u_high = lanes_max(u, u_high);
    v_low = lanes_min(v, v_low), v_high = lanes_max(v, v_high);
  }
  /* The combination's own three roundings come on top of the coefficients' error. */
  const lanes e = combination_error(it);
  const lanes u_error = e * (lanes_abs(bv) + lanes_abs(av)), v_error = e * (lanes_abs(au) + lanes_abs(bu));
  it->along = active & (u_low >= -u_error) & (u_high <= u_error) & (v_low >= -v_error) & (v_high <= v_error);
  if (lanes_any(it->along)) it->along &= corners_differ(a, e) | corners_differ(b, e);
  return active & (u_low <= u_error) & (u_high >= -u_error) & (v_low <= v_error) & (v_high >= -v_error);
}

/* The place in a net of entry k of the row `steps` away from the pole's border. */
LANES_INLINE int from_pole(const struct leaf *leaf, int steps, int k)
{
  const int border = leaf->pole - 1;
  return edge_at(border, k) + steps * edge_inward(border);
}

/* The least value of A a + B b on the net without the pole's border. */
static lanes least_beyond_pole(const struct candidate *it, lanes A, lanes B)
{
  lanes least = lanes_all(INFINITY);
  for (int steps = 1; steps < 4; steps++)
    for (int k = 0; k < 4; k++) {
      const int n = from_pole(it->leaf, steps, k);
      least = lanes_min(A * it->a[n] + B * it->b[n], least);
    }
  return least;
}

/* Lanes that may meet a leaf with a pole. On its border a and b are constants a0 and b0, up to e, and the combination G
 * = a0 b - b0 a is no more than e (|a0| + |b0|). Let d be the distance from the pole. Where all other coefficients of G
 * are beyond that bound, by m, G has no zero from d = bound/m on. Nearer to the pole H = a0 a + b0 b has none, if its
 * derivative by d, at most 6 times its coefficients, takes less than H at the pole on that way. */
static lane_mask planes_at_pole(const struct candidate *it, lane_mask active)
{
  const int at = from_pole(it->leaf, 0, 0);
  const lanes a0 = it->a[at], b0 = it->b[at];
  const lanes least = lanes_max(least_beyond_pole(it, -b0, a0), least_beyond_pole(it, b0, -a0));
  const lanes size_a = lanes_abs(a0), size_b = lanes_abs(b0);
  const lanes off = combination_error(it) * (size_a + size_b);
  const lanes beyond = least - off, reach = size_a * it->alpha + size_b * it->beta;
  return active & ~((beyond > 0) & ((a0 * a0 + b0 * b0 - off) * beyond > 8 * reach * off));
}

/* Whether these control points of the patch are equal numbers. */
static bool same_points(double P[4][4][3], int m, int n)
{
  const double *a = P[m / 4][m % 4], *b = P[n / 4][n % 4];
  return a[0] == b[0] && a[1] == b[1] && a[2] == b[2];
}

/* Sets a combination A a + B b that aims at the middle of what is not `still` of the net. Returns its least value there. */
static lanes aim(const struct candidate *it, const bool still[16], lanes *out_A, lanes *out_B)
{
  lanes A = {0}, B = {0}, least = lanes_all(INFINITY);
  for (int n = 0; n < 16; n++)
    if (!still[n]) A += it->a[n], B += it->b[n];
  for (int n = 0; n < 16; n++)
    if (!still[n]) least = lanes_min(A * it->a[n] + B * it->b[n], least);
  *out_A = A, *out_B = B;
  return least;
}

/* How far x_k of what is not `still` reaches below and above that of the control point `at`. */
static void depth_range(const struct candidate *it, const bool still[16], int at, double *out_low, double *out_high)
{
  const double *x = it->leaf->x[it->axis];
  *out_low = INFINITY, *out_high = -INFINITY;
  for (int n = 0; n < 16; n++)
    if (!still[n]) *out_low = real_min(*out_low, x[n] - x[at]), *out_high = real_max(*out_high, x[n] - x[at]);
}

/* Lanes whose ray starts in control point `at` and meets no other point of the leaf. Where the net is `still` there, a
 * and b are 0. Either one combination of them, which aims at the middle of the rest, is above 0 on all of the rest; or
 * all of the rest is behind, where a difference of two coordinates is off by less than 2 e. */
static lane_mask leaves_start(const struct packet *p, const struct candidate *it, int at, const bool still[16])
{
  lanes A, B;
  double low, high;
  const lanes least = aim(it, still, &A, &B);
  depth_range(it, still, at, &low, &high);
  const lanes off = combination_error(it) * (lanes_abs(A) + lanes_abs(B));
  const lanes up = p->direction[it->axis], nearest = lanes_select(up > 0, lanes_all(-high), lanes_all(low));
  return (least > off) | (nearest > 2 * it->line->error);
}

/* Whether that control point of the leaf's patch is known to be in the leaf's pole. */
static bool is_in_pole(const struct packet *p, const struct candidate *it, int at)
{
  if (p->outer) return false;
  return same_points(p->model->scene->patches[it->leaf->patch].P, at, from_pole(it->leaf, 0, 0));
}

/* Sets `still` for the pole. Rows behind its border may be in the pole, too: a cone's handles, where they are at its ends.
 * What holds for the patch holds for its leaves. In a copy only the border itself is known to be. */
static void still_at_pole(const struct packet *p, const struct candidate *it, bool still[16])
{
  bool row = true;
  for (int steps = 0; steps < 4; steps++) {
    for (int k = 0; k < 4 && steps > 0; k++) row &= is_in_pole(p, it, from_pole(it->leaf, steps, k));
    for (int k = 0; k < 4; k++) still[from_pole(it->leaf, steps, k)] = row;
  }
}

/* A ray that passes the pole within this part of a leaf's length comes to all leaves round the pole, and its Newton steps
 * prove nothing of most: the planes are asked first. A choice of speed. */
#define PASSES_POLE 0x1p-4

lane_mask stage_pole(const struct packet *p, struct candidate *it, lane_mask open)
{
  const int at = from_pole(it->leaf, 0, 0);
  lanes a0, b0;
  plane_values(it->line, it->axis, it->leaf->x, at, &a0, &b0);
  const double length = it->leaf->first[(it->leaf->pole - 1) / 2];
  const lane_mask near = open & (lanes_max(lanes_abs(a0), lanes_abs(b0)) <= PASSES_POLE * length);
  if (!lanes_any(near)) return open;
  lane_mask missed = near & ~planes_make(it, near);
  missed |= near & ~planes_at_pole(it, near & ~missed);
  const lane_mask starts = near & ~missed & packet_starts_at(p, it->leaf->patch, at);
  if (!lanes_any(starts)) return open & ~missed;
  bool still[16];
  still_at_pole(p, it, still);
  return open & ~missed & ~(starts & leaves_start(p, it, at, still));
}

/* Sets `still` for a corner: the points that equal it, as do all between. */
static void still_at_corner(double P[4][4][3], int corner, bool still[16])
{
  const int down = corner & 12 ? -4 : 4, right = corner & 3 ? -1 : 1;
  for (int i = 0; i < 4; i++)
    for (int j = 0; j < 4; j++) {
      const int n = corner + i * down + j * right;
      still[n] = same_points(P, n, corner) && (i == 0 || still[n - down]) && (j == 0 || still[n - right]);
    }
}

lane_mask leaves_corner(const struct packet *p, struct candidate *it, lane_mask open)
{
  lane_mask leaves = {0};
  for (int corner = 0; corner < 4; corner++) {
    const int u = corner / 2, v = corner % 2, at = 12 * u + 3 * v;
    const lane_mask starts = open & starts_at_corner(p, it, u, v);
    if (!lanes_any(starts)) continue;
    bool still[16];
    still_at_corner(p->model->scene->patches[it->leaf->patch].P, at, still);
    (void)planes_make(it, starts);
    leaves |= starts & leaves_start(p, it, at, still);
  }
  return leaves;
}

/* Control points of a leaf nearer to one another than this, in the patch's frame, are taken for one place: a tip whose
 * points differ by roundings. A choice of speed; what is proven holds for any points. */
#define TIP_SIZE 0x1p-44

/* Whether control point n is so near to point `at`. */
static bool in_tip(const struct leaf *leaf, int at, int n)
{
  for (int k = 0; k < 3; k++)
    if (!(fabs(leaf->x[k][n] - leaf->x[k][at]) <= TIP_SIZE)) return false;
  return true;
}

/* Whether the border of the leaf is a point, but for roundings. */
static bool is_tip(const struct leaf *leaf, int border)
{
  for (int n = 1; n < 4; n++)
    if (!in_tip(leaf, edge_at(border, 0), edge_at(border, n))) return false;
  return true;
}

/* Lanes that may meet a leaf, one border of which is a pole, or a tip that is one but for roundings, within the ray's
 * range. A shadow ray whose light is in a cone's tip does not: it ends just before the tip. Let G be the combination
 * that aims at what is not in the tip, m its least value there and g its greatest size on what is in it, with errors.
 * With W the weight of what is not, G is above 0 from W = g/m on. Nearer to the tip, x_k differs from a value in the
 * tip by at most W times the most that it does anywhere. The factor 2 is for roundings of the products; those of x_k are
 * in `off`.
 *
 * Where the ray meets all of the border, as far as doubles tell, it is `along`. Boxes at a pole are never cleared,
 * because a and b are constant along its border, and every combination is less than its error there. Also r has a
 * coefficient there that may be zero. */
static lane_mask planes_near_tip(const struct packet *p, struct candidate *it, int border, lane_mask open)
{
  const int at = edge_at(border, 0);
  const lanes e = it->line->error;
  const double *x = it->leaf->x[it->axis];
  bool still[16];
  double first = x[at], last = x[at], low, high;
  lanes from, to, off, A, B, size = {0}, g = {0};
  for (int n = 0; n < 16; n++) {
    still[n] = in_tip(it->leaf, at, n);
    if (still[n]) first = real_min(first, x[n]), last = real_max(last, x[n]);
  }
  for (int k = 0; k < 4; k++) {
    const int n = edge_at(border, k);
    size = lanes_max(size, lanes_max(lanes_abs(it->a[n]), lanes_abs(it->b[n])));
  }
  ray_ends(p, it, p->t_max, &from, &to, &off);
  off += 2 * e;
  const lanes outside = lanes_max(from - off - last, first - to - off);
  it->along |= open & (size <= e) & (outside <= 0);
  if (!lanes_any(open & (outside > 0))) return open;
  const lanes least = aim(it, still, &A, &B), wrong = combination_error(it) * (lanes_abs(A) + lanes_abs(B));
  for (int n = 0; n < 16; n++)
    if (still[n]) g = lanes_max(g, lanes_abs(A * it->a[n] + B * it->b[n]) + wrong);
  depth_range(it, still, at, &low, &high);
  const double way = real_max(last - x[at] - low, high + x[at] - first);
  const lanes beyond = least - wrong;
  return open & ~((outside > 0) & (beyond > 0) & (outside * beyond > 2 * way * g));
}

lane_mask stage_planes(const struct packet *p, struct candidate *it, lane_mask open)
{
  lane_mask near = planes_make(it, open);
  it->along = (lane_mask){0};
  if (!it->patch->method->polish) return open;
  if (it->leaf->pole && lanes_any(near)) near = planes_at_pole(it, near);
  if (lanes_any(near)) near = planes_aligned(it, near);
  for (int border = 0; border < 4; border++)
    if (lanes_any(near) && is_tip(it->leaf, border)) near = planes_near_tip(p, it, border, near);
  return near;
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
