/* Newton's method on a leaf, to the last places. And the root that is tried first.
 *
 * Compiled once per instruction set, without contraction. The surface is evaluated as the sum of the leaf's parts
 * (model.h), and the planes' residuals keep what their leading terms lose to rounding. So Newton's method ends at a
 * root that is right to the rounding of the bend of its leaf. Point and normal come from one more
 * evaluation, at the root.
 * Parameters are s = u - 1/2 and t = v - 1/2.
 */
#include <math.h>

#include "base/double_lanes.h"
#include "base/lane_points.h"
#include "intersect/certificate.h"
#include "intersect/lanes/candidate.h"

/* ---- the surface ---- */

/* One coordinate of the leaf: its derivatives, and its value as hi + lo, where |lo| is of the size of the leaf's
 * bend. */
struct coordinate {
  lanes hi, lo, ds, dt;
};

/* A point, split. The products of heads of absolute value at most 4 with multiples of LEAF_GRAIN are exact, and so are
 * their sums up to 8. */
struct split_point {
  lanes s, t;
  struct split_lanes split_s, split_t, split_st;
};

/* A term of coordinate c, or of all three, side by side, if c is SIDE_BY_SIDE. */
enum { SIDE_BY_SIDE = 3 };

LANES_INLINE lanes term(const double of[3], int c)
{
#if LANE_POINTS > 0
  if (c == SIDE_BY_SIDE) return lane_points_load(of);
#endif
  return lanes_all(of[c]);
}

LANES_INLINE struct coordinate coordinate_at(const struct leaf_parts *parts, int c, const struct split_point *at)
{
  const double(*base)[3] = parts->base, (*r)[3] = parts->rest;
  const lanes A = term(base[1], c), B = term(base[2], c), C = term(base[3], c), s = at->s, t = at->t;
  struct coordinate x;
  x.hi = lanes_multiply_add(at->split_s.head, A, term(base[0], c));
  x.hi = lanes_multiply_add(at->split_st.head, C, lanes_multiply_add(at->split_t.head, B, x.hi));
  x.lo = lanes_multiply_add(at->split_t.tail, B, at->split_s.tail * A);
  x.lo = lanes_multiply_add(at->split_st.tail, C, x.lo);
  x.ds = lanes_multiply_add(t, C, A), x.dt = lanes_multiply_add(s, C, B);
  /* Horner's scheme and its derivative, in each row and over the rows. */
  lanes bend = {0}, bend_ds = {0}, bend_dt = {0};
#pragma GCC unroll 4
  for (int i = 3; i >= 0; i--) {
    const int n = 4 * i;
    lanes row_dt = term(r[n + 3], c), row = lanes_multiply_add(row_dt, t, term(r[n + 2], c));
    row_dt = lanes_multiply_add(row_dt, t, row), row = lanes_multiply_add(row, t, term(r[n + 1], c));
    row_dt = lanes_multiply_add(row_dt, t, row), row = lanes_multiply_add(row, t, term(r[n], c));
    bend_ds = i == 3 ? bend_ds : lanes_multiply_add(bend_ds, s, bend);
    bend = i == 3 ? row : lanes_multiply_add(bend, s, row);
    bend_dt = i == 3 ? row_dt : lanes_multiply_add(bend_dt, s, row_dt);
  }
  x.lo += bend, x.ds += bend_ds, x.dt += bend_dt;
  return x;
}

LANES_INLINE struct split_point split_point_of(lanes s, lanes t)
{
  const lanes st = s * t;
  struct split_point at = {s, t, split_lanes_of(s), split_lanes_of(t), split_lanes_of(st)};
  at.split_st.tail += lanes_product_error(s, t, st);
  return at;
}

/* Out of line: inlined into a loop, it would first copy all coefficients to the stack. */
__attribute__((noinline)) static void surface_of_many(const struct leaf_parts *parts, lanes s, lanes t,
                                                      struct coordinate out[3])
{
  const struct split_point at = split_point_of(s, t);
  for (int c = 0; c < 3; c++) out[c] = coordinate_at(parts, c, &at);
}

/* The lanes whose points are wanted, as bits, if they are so few that a point's coordinates are computed side by side;
 * otherwise 0, for lane by lane. Each coordinate takes the same operations, and gets the same bits. */
LANES_INLINE unsigned few_lanes(lane_mask active)
{
  const unsigned bits = lanes_bits(active);
  return __builtin_popcount(bits) <= LANE_POINTS ? bits : 0;
}

LANES_INLINE void surface_at(const struct leaf_parts *parts, lanes s, lanes t, unsigned few, struct coordinate out[3])
{
#if LANE_POINTS > 0
  if (few) {
    const struct lane_points points = lane_points_of(few);
    const struct split_point at = split_point_of(lane_points_spread(&points, s), lane_points_spread(&points, t));
    const struct coordinate all = coordinate_at(parts, SIDE_BY_SIDE, &at);
    for (int c = 0; c < 3; c++) {
      out[c].hi = lane_points_collect(&points, all.hi, c), out[c].lo = lane_points_collect(&points, all.lo, c);
      out[c].ds = lane_points_collect(&points, all.ds, c), out[c].dt = lane_points_collect(&points, all.dt, c);
    }
    return;
  }
#else
  (void)few;
#endif
  surface_of_many(parts, s, t, out);
}

/* ---- the planes ---- */

/* Value and derivatives of the polynomial of the plane x_i - slope x_k = moment. */
struct plane {
  lanes value, ds, dt;
};

LANES_INLINE struct plane plane_at(const struct line *line, int number, const struct coordinate *i,
                                   const struct coordinate *k)
{
  const lanes slope = line->slope[number];
  const lanes along = slope * k->hi, along_error = lanes_product_error(slope, k->hi, along);
  const struct double_lanes side = double_lanes_sum(i->hi, -line->moment[number]);
  const lanes rest = (i->lo - line->moment_rest[number]) -
                     lanes_multiply_add(slope, k->lo, line->slope_rest[number] * k->hi);
  return (struct plane){(side.hi - along) + (rest + (side.lo - along_error)), i->ds - slope * k->ds,
                        i->dt - slope * k->dt};
}

/* ---- the proof ---- */

/* The inverse Jacobian M: steps are M (a, b). */
struct inverse {
  lanes ua, ub, va, vb;
};

/* The length of a row of the inverse Jacobian as a covector of space: a bound on how fast that parameter moves with the
 * surface. */
LANES_INLINE lanes row_length(lanes p, lanes q, const lanes slope[2])
{
  const lanes r = p * slope[0] + q * slope[1];
  return lanes_sqrt(p * p + q * q + r * r);
}

/* A root may be this far outside the leaf: then the leaf's bounds hold wherever the certificate needs them. */
#define NEWTON_MARGIN (LEAF_MARGIN - CERTIFICATE_REACH)

/* A value at a distance m beside the leaf is off by (1 + 2 m)^6 times the error of coefficients. As far as
 * NEWTON_BESIDE the theorem has room for that, and as far as LEAF_MARGIN it is at most NEWTON_BESIDE_GROWTH. */
#define NEWTON_BESIDE 0x1p-7
#define NEWTON_BESIDE_GROWTH 4

/* The certificate (certificate.h). Sets all but u and v of *r, which are where the last steps went on the lanes that
 * `settled`; step is the longer one, `bound` bounds the errors of values in the leaf. */
LANES_INLINE void prove(const struct leaf *leaf, const struct inverse *m, const lanes slope[2], lanes bound, lanes step,
                        lane_mask settled, struct newton_root *r)
{
  const lanes away[2] = {lanes_abs(r->u - 0.5), lanes_abs(r->v - 0.5)}, farthest = lanes_max(away[0], away[1]);
  const lanes error = lanes_select(farthest > 0.5 + NEWTON_BESIDE, NEWTON_BESIDE_GROWTH * bound, bound);
  const lanes length[2] = {row_length(m->ua, m->ub, slope), row_length(m->va, m->vb, slope)};
  const double *second = leaf->second;
  const lanes size = lanes_max(length[0], length[1]), bend = size * (second[0] + 2 * second[1] + second[2]);
  const lanes off = size * error;
  const lane_mask near = (away[0] < 0.5 + NEWTON_MARGIN) & (away[1] < 0.5 + NEWTON_MARGIN);
  r->exists = settled & near & certificate_holds(bend, step, off);
  r->radius_u = certificate_radius(bend, step, length[0] * error);
  r->radius_v = certificate_radius(bend, step, length[1] * error);
  const lanes reach[2] = {0.5 + away[0], 0.5 + away[1]};
  const lanes q = length[0] * (second[0] * reach[0] + second[1] * reach[1]) +
                  length[1] * (second[1] * reach[0] + second[2] * reach[1]);
  r->alone = r->exists & certificate_alone(q, off);
}

/* The rounding of a derivative and of its products with a row of M, in units of UNIT_ROUNDOFF, for derivatives of size
 * 1: that of the net, and some twenty operations. */
#define DERIVATIVE_ROUNDINGS 64

/* ---- the steps ---- */

/* After FREE_STEPS a step that is not less than half of the one before is no progress. */
enum { MOST_STEPS = 10, FREE_STEPS = 3 };

/* 1/2 + s - step with one rounding, so that a small parameter loses nothing. */
LANES_INLINE lanes from_middle(lanes s, lanes step)
{
  const lanes moved = 0.5 + s;
  return moved + ((s - (moved - 0.5)) - step);
}

void newton_solve(const struct packet *p, const struct leaf *leaf, int axis, const lanes start[2], lane_mask active,
                  struct leaf_root *out)
{
  const struct leaf_parts *parts = &leaf->parts;
  const struct line *line = &p->line[axis];
  const int k = axis;
  struct coordinate x[3];
  struct inverse m;
  lanes s = start[0], t = start[1], step_s, step_t, step = lanes_all(INFINITY);
  lane_mask settled, moving = active;
  const unsigned few = few_lanes(active);
  for (int n = 1;; n++) {
    surface_at(parts, s, t, few, x);
    const struct plane a = plane_at(line, 0, &x[(k + 1) % 3], &x[k]), b = plane_at(line, 1, &x[(k + 2) % 3], &x[k]);
    const lanes inverse = 1 / (a.ds * b.dt - a.dt * b.ds);
    m = (struct inverse){b.dt * inverse, -a.dt * inverse, -b.ds * inverse, a.ds * inverse};
    step_s = m.ua * a.value + m.ub * b.value, step_t = m.va * a.value + m.vb * b.value;
    const lanes before = step;
    step = lanes_max(lanes_abs(step_s), lanes_abs(step_t));
    if (n > FREE_STEPS) moving &= step < 0.5 * before;
    settled = active & (step <= parts->last_step);
    /* A root far outside the leaf is not sought further, nor one without progress (NaN compares false). */
    moving &= ~settled & (lanes_abs(s - step_s) < 2) & (lanes_abs(t - step_t) < 2);
    if (n == MOST_STEPS || !lanes_any(moving)) break;
    /* A lane that is done stays where it is, so that its result does not depend on the others. */
    s = lanes_select(moving, s - step_s, s), t = lanes_select(moving, t - step_t, t);
  }
  out->at.u = from_middle(s, step_s), out->at.v = from_middle(t, step_t);
  prove(leaf, &m, line->slope, line->error + parts->error, step, settled, &out->at);
  const struct double_lanes way = double_lanes_sum(x[k].hi, line->start[0]);
  const lanes rest = x[k].lo - (x[k].ds * step_s + x[k].dt * step_t);
  out->w = x[k].hi + rest;
  out->t = (way.hi + (rest + (way.lo + line->start[1]))) * line->to_t;
  if (p->any) return;
  const double second = leaf->second[0] + 2 * leaf->second[1] + leaf->second[2];
  out->left = (0.5 * second * step + DERIVATIVE_ROUNDINGS * UNIT_ROUNDOFF * (leaf->first[0] + leaf->first[1])) * step;
  surface_at(parts, s - step_s, t - step_t, few, x);
  for (int c = 0; c < 3; c++) out->point[c] = x[c].hi + x[c].lo, out->su[c] = x[c].ds, out->sv[c] = x[c].dt;
}

/* ---- the root of the bilinear part ---- */

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
  struct leaf_root *root = &it->known.root[0];
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

/* ---- rays that leave ---- */

/* A ray that starts farther from the root than this, in the patch's frame, hardly ever comes here. A choice of speed. */
#define STARTS_NEAR 0x1p-20

/* Let f be the height over a plane through a point z of the leaf, next to the first root, on the side to which the ray
 * leaves: the product of a point's way from z with the computed normal n at z. If the Hessian of f is negative definite
 * all over the leaf, which is convex, f is no more there than its slope at z, which is 0 but for rounding. The ray is
 * higher where it starts: at the same x_k as z it misses z by the planes' values there. The elements of the Hessian
 * lie within 6, 9 and 6 times the second differences of coefficients. In a copy this is so of the object's leaf, and
 * line->error has room for both the copy and the ray. */
lane_mask stage_leaves(const struct packet *p, const struct candidate *it, lane_mask open)
{
  const struct leaf *leaf = it->leaf;
  const struct leaf_root *root = &it->known.root[0];
  const struct newton_root *r = &root->at;
  const struct line *line = it->line;
  const int k = it->axis, i = (k + 1) % 3, j = (k + 2) % 3;
  lanes from, to, off, n[3], f[16];
  ray_ends(p, it, p->t_max, &from, &to, &off);
  const lane_mask up = p->direction[k] > 0;
  const lanes start = lanes_select(up, from, to), past = lanes_select(up, start - root->w, root->w - start);
  open &= r->exists & (past > 0) & (past <= STARTS_NEAR) & (lanes_abs(r->u - 0.5) <= 0.5) &
          (lanes_abs(r->v - 0.5) <= 0.5);
  if (!lanes_any(open)) return open;
  struct coordinate x[3];
  surface_at(&leaf->parts, r->u - 0.5, r->v - 0.5, few_lanes(open), x);
  const struct plane a = plane_at(line, 0, &x[i], &x[k]), b = plane_at(line, 1, &x[j], &x[k]);
  for (int c = 0; c < 3; c++) {
    const struct coordinate *y = &x[(c + 1) % 3], *z = &x[(c + 2) % 3];
    n[c] = y->ds * z->dt - z->ds * y->dt;
  }
  const lanes rise = n[i] * line->slope[0] + (n[j] * line->slope[1] + n[k]);
  const lanes size = lanes_abs(n[0]) + (lanes_abs(n[1]) + lanes_abs(n[2]));
  const lanes ahead = start - (x[k].hi + x[k].lo);
  const lanes way = lanes_select(up, ahead, -ahead) - (off + leaf->parts.error + 4 * UNIT_ROUNDOFF);
  /* derivatives, which are off by 16 times the error of a value besides, and their product */
  const double rounded = UNIT_ROUNDOFF * (leaf->first[0] + leaf->first[1]);
  const lanes slope = size * (2 * DERIVATIVE_ROUNDINGS * rounded + 32 * leaf->parts.error) +
                      16 * rounded * leaf->first[0] * leaf->first[1];
  const lanes missed = lanes_abs(n[i] * a.value) + lanes_abs(n[j] * b.value) + size * (line->error + leaf->parts.error);
  open &= (way > 0) &
          (way * (lanes_abs(rise) - 16 * UNIT_ROUNDOFF * size) > (1 + 8 * UNIT_ROUNDOFF) * (slope + missed));
  if (!lanes_any(open)) return open;
  const lane_mask below = (rise > 0) ^ up; /* the normal points to the other side */
  for (int c = 0; c < 3; c++) n[c] = lanes_select(below, -n[c], n[c]);
  for (int m = 0; m < 16; m++) f[m] = n[0] * leaf->x[0][m] + (n[1] * leaf->x[1][m] + n[2] * leaf->x[2][m]);
  lanes uu = lanes_all(-INFINITY), vv = uu, uv = lanes_all(0);
  for (int m = 0; m < 8; m++) {
    const lanes *g = &f[m], *h = &f[4 * (m / 2) + m % 2];
    uu = lanes_max((g[8] - g[4]) - (g[4] - g[0]), uu), vv = lanes_max((h[2] - h[1]) - (h[1] - h[0]), vv);
  }
  for (int m = 0; m < 9; m++) {
    const lanes *g = &f[4 * (m / 3) + m % 3];
    uv = lanes_max(lanes_abs((g[5] - g[4]) - (g[1] - g[0])), uv);
  }
  const lanes error = size * (4 * line->error + 16 * UNIT_ROUNDOFF); /* of a second difference */
  uu += error, vv += error, uv += error;
  return open & (uu < 0) & (vv < 0) & (36 * (uu * vv) > 82 * (uv * uv));
}
