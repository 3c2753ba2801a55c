/* The last resort: the nearest root of (a, b) in a leaf by recursive halving.
 *
 * A box of parameters is dropped where some linear combination of the two plane polynomials keeps one sign on it (the convex
 * hull property), solved where the Newton-Kantorovich test finds a root that is alone in it, and halved otherwise. Boxes are
 * taken nearest first and dropped behind the best root found, so curves of roots (a ray in the plane of a flat patch) cost no
 * more than points. A box on which a combination is indistinguishable from zero, and which is small along the ray, cannot
 * be decided in double precision: it is answered as a hit that is not certain.
 */
#include <math.h>
#include <string.h>

#include "base/real.h"
#include "geometry/patch.h"
#include "intersect/tracer.h"

/* A box halves at most this often in all: 2^-50 of the leaf either way. Halving a net adds one unit roundoff of its size. */
enum { MAX_HALVINGS = 100 };

/* Boxes looked at before the search settles for the nearest one left: far above what isolated roots need (some hundreds),
 * so only surfaces that lie along the ray over an area come here. */
enum { MAX_BOXES = 20000 };

/* The fraction of the leaf's own extent along the ray below which an undecidable box is not halved further. */
#define PLACE_RESOLUTION 0x1p-44

/* How far outside a box, in its own parameters, its root may lie and still be told from having none (then the neighbour has it);
 * and the growth of second-derivative bounds, quartic in the extent, when they are used that far outside. */
#define BOX_MARGIN 0.0625
#define BOX_MARGIN_GROWTH 1.61

struct box {
  double net[3][4][4]; /* a, b, w */
  double u, v, size_u, size_v; /* in leaf parameters */
  double near, far;            /* hull of t */
  int halvings;
};

struct search {
  const struct leaf *leaf;
  const struct local_ray *ray;
  double t_min, t_max, resolution;
  bool found;
  double best_t;
  struct leaf_hit best;
};

static void hull(double net[4][4], double *lo, double *hi)
{
  *lo = *hi = net[0][0];
  for (int i = 0; i < 4; i++)
    for (int j = 0; j < 4; j++) *lo = real_min(*lo, net[i][j]), *hi = real_max(*hi, net[i][j]);
}

static double place_to_t(const struct search *s, double w)
{
  return ((w + s->ray->start[1]) + s->ray->start[0]) * s->ray->to_t;
}

/* The bound on rounding in a coefficient of the box's nets. */
static double box_error(const struct search *s, const struct box *box)
{
  return s->ray->error + box->halvings * 4 * UNIT_ROUNDOFF;
}

static void box_place(const struct search *s, struct box *box)
{
  double lo, hi;
  hull(box->net[2], &lo, &hi);
  const double p = place_to_t(s, lo), q = place_to_t(s, hi);
  box->near = real_min(p, q), box->far = real_max(p, q);
}

/* Where p a + q b stands on the box: out[0..1] its hull, in units of its error bound. */
static void combination(struct box *box, double p, double q, double error, double out[2])
{
  out[0] = INFINITY, out[1] = -INFINITY;
  const double unit = 1 / ((fabs(p) + fabs(q)) * (error + UNIT_ROUNDOFF * 4));
  for (int i = 0; i < 4; i++) {
    for (int j = 0; j < 4; j++) {
      const double value = (p * box->net[0][i][j] + q * box->net[1][i][j]) * unit;
      out[0] = real_min(out[0], value), out[1] = real_max(out[1], value);
    }
  }
}

enum verdict { EMPTY, FLAT, OPEN };

/* Tries the combinations a, b and the two rows of the adjugate Jacobian in the middle, which aim along the parameters, or, where
 * the Jacobian is singular, at the one direction in which the surface is seen edge-on. */
static enum verdict box_test(struct box *box, double error)
{
  const struct patch_jet a = patch_evaluate(box->net[0], 0.5, 0.5), b = patch_evaluate(box->net[1], 0.5, 0.5);
  const double rows[4][2] = {{1, 0}, {0, 1}, {b.dv, -a.dv}, {-b.du, a.du}};
  bool flat = false;
  for (int k = 0; k < 4; k++) {
    if (rows[k][0] == 0 && rows[k][1] == 0) continue;
    double range[2];
    combination(box, rows[k][0], rows[k][1], error, range);
    if (range[0] > 1 || range[1] < -1) return EMPTY;
    flat |= range[0] > -4 && range[1] < 4;
  }
  return flat ? FLAT : OPEN;
}

/* The largest |(p a + q b)''| of each kind on the box. */
static void second_bounds(struct box *box, double p, double q, double out[3])
{
  double n[4][4];
  for (int i = 0; i < 4; i++)
    for (int j = 0; j < 4; j++) n[i][j] = p * box->net[0][i][j] + q * box->net[1][i][j];
  out[0] = out[1] = out[2] = 0;
  for (int i = 0; i < 4; i++) {
    for (int j = 0; j < 4; j++) {
      if (i < 2) out[0] = real_max(out[0], 6 * fabs(n[i + 2][j] - 2 * n[i + 1][j] + n[i][j]));
      if (i < 3 && j < 3) out[1] = real_max(out[1], 9 * fabs(n[i + 1][j + 1] - n[i + 1][j] - n[i][j + 1] + n[i][j]));
      if (j < 2) out[2] = real_max(out[2], 6 * fabs(n[i][j + 2] - 2 * n[i][j + 1] + n[i][j]));
    }
  }
}

/* Newton from the middle, then the test of refine.h in the box's own parameters, with the second derivatives of the plane
 * polynomials themselves. Writes the root in box parameters with its radii; returns whether it is proven and alone. */
static bool box_solve(struct box *box, double error, double root[2], double radius[2])
{
  double u = 0.5, v = 0.5, step = INFINITY, m[2][2] = {{0}};
  for (int n = 0; n < 12 && step > 0x1p-28; n++) {
    const struct patch_jet a = patch_evaluate(box->net[0], u, v), b = patch_evaluate(box->net[1], u, v);
    const double inverse = 1 / (a.du * b.dv - a.dv * b.du);
    m[0][0] = b.dv * inverse, m[0][1] = -a.dv * inverse, m[1][0] = -b.du * inverse, m[1][1] = a.du * inverse;
    const double su = m[0][0] * a.value + m[0][1] * b.value, sv = m[1][0] * a.value + m[1][1] * b.value;
    step = real_max(fabs(su), fabs(sv));
    u -= su, v -= sv;
    if (!(fabs(u - 0.5) < 1.5 && fabs(v - 0.5) < 1.5)) return false;
  }
  if (!(step <= 0x1p-28)) return false;
  const double out_u = real_max(-u, u - 1), out_v = real_max(-v, v - 1);
  if (!(out_u < BOX_MARGIN && out_v < BOX_MARGIN)) return false;
  const double growth = out_u > 0 || out_v > 0 ? BOX_MARGIN_GROWTH : 1;
  const double reach_u = 0.5 + fabs(u - 0.5), reach_v = 0.5 + fabs(v - 0.5);
  double lipschitz = 0, q = 0, size = 0;
  for (int k = 0; k < 2; k++) {
    double s[3];
    second_bounds(box, m[k][0], m[k][1], s);
    lipschitz = real_max(lipschitz, growth * (s[0] + 2 * s[1] + s[2]));
    q = real_max(q, growth * ((s[0] + s[1]) * reach_u + (s[1] + s[2]) * reach_v));
    radius[k] = 2 * (fabs(m[k][0]) + fabs(m[k][1])) * error;
    size = real_max(size, radius[k] / 2);
  }
  for (int k = 0; k < 2; k++) radius[k] += 2 * lipschitz * step * step;
  root[0] = u, root[1] = v;
  return lipschitz * (step + size) <= 0.125 && q < 1.9;
}

static void offer(struct search *s, const struct leaf_hit *hit)
{
  const double t = place_to_t(s, hit->w);
  if (!(t > s->t_min && t < s->t_max) || (s->found && t >= s->best_t)) return;
  s->found = true, s->best_t = t, s->best = *hit;
}

/* Offers the box's root, where it lies in the leaf; one just outside the box is the neighbour's as well, and the same. */
static void box_offer(struct search *s, struct box *box, const double root[2], const double radius[2])
{
  struct leaf_hit hit = {box->u + box->size_u * root[0], box->v + box->size_v * root[1],
                         radius[0] * box->size_u + UNIT_ROUNDOFF, radius[1] * box->size_v + UNIT_ROUNDOFF,
                         patch_evaluate(box->net[2], root[0], root[1]).value, true};
  if (hit.u < -hit.radius_u || hit.u > 1 + hit.radius_u || hit.v < -hit.radius_v || hit.v > 1 + hit.radius_v) return;
  offer(s, &hit);
}

/* Offers a box that cannot be decided: its point where the plane polynomials are least, by a step along their gradient. */
static void box_offer_undecided(struct search *s, struct box *box)
{
  struct leaf_hit hit = {box->u + 0.5 * box->size_u, box->v + 0.5 * box->size_v, box->size_u, box->size_v,
                         patch_evaluate(box->net[2], 0.5, 0.5).value, false};
  offer(s, &hit);
}

/* Halves across the parameter along which the surface is longer, as seen along the ray and along it. */
static void box_halve(const struct search *s, struct box *box, struct box out[2])
{
  double along_u = 0, along_v = 0;
  for (int k = 0; k < 3; k++) {
    for (int i = 0; i < 4; i++) {
      for (int j = 0; j < 3; j++) {
        along_v = real_max(along_v, fabs(box->net[k][i][j + 1] - box->net[k][i][j]));
        along_u = real_max(along_u, fabs(box->net[k][j + 1][i] - box->net[k][j][i]));
      }
    }
  }
  const bool u = along_u == along_v ? box->size_u >= box->size_v : along_u > along_v;
  for (int h = 0; h < 2; h++) {
    out[h].u = box->u, out[h].v = box->v, out[h].size_u = box->size_u, out[h].size_v = box->size_v;
    out[h].halvings = box->halvings + 1;
  }
  for (int k = 0; k < 3; k++) {
    if (u) patch_split_u(box->net[k], out[0].net[k], out[1].net[k]);
    else patch_split_v(box->net[k], out[0].net[k], out[1].net[k]);
  }
  for (int h = 0; h < 2; h++) {
    if (u) out[h].size_u *= 0.5, out[h].u += h * out[h].size_u;
    else out[h].size_v *= 0.5, out[h].v += h * out[h].size_v;
    box_place(s, &out[h]);
  }
}

/* Decides the box: true where nothing is left to do with it. */
static bool box_decide(struct search *s, struct box *box)
{
  if (box->near >= s->t_max || box->far <= s->t_min || (s->found && box->near >= s->best_t)) return true;
  const double error = box_error(s, box);
  const enum verdict verdict = box_test(box, error);
  if (verdict == EMPTY) return true;
  double root[2], radius[2];
  if (verdict == OPEN && box_solve(box, error, root, radius)) {
    box_offer(s, box, root, radius);
    return true;
  }
  if ((verdict == FLAT && box->far - box->near <= s->resolution) || box->halvings >= MAX_HALVINGS) {
    box_offer_undecided(s, box);
    return true;
  }
  return false;
}

bool subdivide_closest(const struct leaf *leaf, const struct local_ray *ray, double t_min, double t_max, struct leaf_hit *out)
{
  struct search s = {.leaf = leaf, .ray = ray, .t_min = t_min, .t_max = t_max};
  struct box stack[MAX_HALVINGS + 2];
  double nets[3][16];
  local_ray_nets(ray, leaf->x, nets[0], nets[1], nets[2]);
  memcpy(stack[0].net, nets, sizeof nets);
  stack[0].u = stack[0].v = 0, stack[0].size_u = stack[0].size_v = 1, stack[0].halvings = 0;
  box_place(&s, &stack[0]);
  s.resolution = real_max((stack[0].far - stack[0].near) * PLACE_RESOLUTION, 8 * UNIT_ROUNDOFF * real_max(fabs(stack[0].near), fabs(stack[0].far)));
  int top = 1;
  for (int n = 0; top > 0; n++) {
    struct box box = stack[--top];
    if (box_decide(&s, &box)) continue;
    if (n >= MAX_BOXES) {
      box_offer_undecided(&s, &box);
      break;
    }
    struct box half[2];
    box_halve(&s, &box, half);
    const int nearer = half[1].near < half[0].near;
    stack[top++] = half[!nearer];
    stack[top++] = half[nearer];
  }
  *out = s.best;
  return s.found;
}
