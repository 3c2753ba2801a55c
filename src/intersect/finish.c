/* From the winning root to the answer: the last Newton step, the point, the normal, the certainty.
 *
 * The root comes from a leaf's net, cut from the patch and rounded. Where the ray is steep it is right to a few last places.
 * Where it grazes, rounding is magnified: then one or two Newton steps on the patch itself, with the residuals a(u,v), b(u,v)
 * evaluated in double-double, make U, V and T right to the last places again.
 */
#include <math.h>
#include <string.h>

#include "base/double_double.h"
#include "base/lanes.h"
#include "base/real.h"
#include "geometry/patch.h"
#include "geometry/vector.h"
#include "intersect/tracer.h"

enum { FINISH_STEPS = 3 };

/* The error bound of t, relative to t, up to which the leaf's root is kept as it is. The bound is a worst case, some fifty times the
 * error itself, which is then a few units in the last place. It is more where the ray grazes, and where the patch is large beside
 * its distance: there the better residuals are worth their time. */
#define PLAIN_ERROR (256 * UNIT_ROUNDOFF)

/* A Newton step longer than this, in patch parameters, is followed by another: the next one is about its square. */
#define FINISH_STEP 0x1p-28

/* |Su x Sv| relative to the squared derivatives down to which it is the normal without further thought. */
#define PLAIN_NORMAL 0x1p-20

/* The weights B_i(u) B_j(v) of the sixteen control values as hi + lo. */
struct weights {
  double hi[16], lo[16];
};

static void cubic_weights(double t, struct double_double w[4])
{
  const struct double_double s = dd_two_sum(1, -t), tt = dd_two_product(t, t), ss = dd_multiply(s, s);
  w[0] = dd_multiply(ss, s), w[1] = dd_scale(dd_scale(ss, t), 3);
  w[2] = dd_scale(dd_multiply(s, tt), 3), w[3] = dd_scale(tt, t);
}

static void weights_at(double u, double v, struct weights *out)
{
  struct double_double wu[4], wv[4];
  cubic_weights(u, wu);
  cubic_weights(v, wv);
  for (int n = 0; n < 16; n++) {
    const struct double_double a = wu[n / 4], b = wv[n % 4], p = dd_two_product(a.hi, b.hi);
    out->hi[n] = p.hi, out->lo[n] = p.lo + (a.hi * b.lo + a.lo * b.hi);
  }
}

/* sum w[n] net[n], as if summed in twice the precision (Ogita, Rump and Oishi, Accurate Sum and Dot Product, 2005: Dot2). */
static struct double_double evaluate(double net[4][4], const struct weights *w)
{
  lanes sum = {0}, rest = {0};
  for (int n = 0; n < 16; n += LANES) {
    lanes x, hi, lo;
    memcpy(&x, &net[0][0] + n, sizeof x);
    memcpy(&hi, w->hi + n, sizeof hi);
    memcpy(&lo, w->lo + n, sizeof lo);
    const lanes product = hi * x, error = lanes_product_error(hi, x, product);
    const lanes total = sum + product, back = total - sum;
    rest += ((sum - (total - back)) + (product - back)) + (error + lo * x);
    sum = total;
  }
  struct double_double all = {sum[0], rest[0]};
  for (int l = 1; l < LANES; l++) {
    const struct double_double t = dd_two_sum(all.hi, sum[l]);
    all = (struct double_double){t.hi, all.lo + (t.lo + rest[l])};
  }
  return dd_normal(all.hi, all.lo);
}

/* The patch, the ray through it, both as they are: nothing rounded. */
struct exact {
  struct model_patch *patch;
  struct double_double start[3]; /* (origin - center)/scale */
  const double *d;
  int k;
};

/* The plane residual (S_i - o_i) - (d_i/d_k)(S_k - o_k), S - o in double-double. */
static double residual(const struct exact *e, const struct double_double s[3], int i)
{
  const struct double_double x = dd_scale(s[i], e->d[e->k]), y = dd_scale(s[e->k], e->d[i]);
  return dd_add(x, dd_negate(y)).hi / e->d[e->k];
}

static void offset_from_start(const struct exact *e, double u, double v, struct double_double out[3])
{
  struct weights w;
  weights_at(u, v, &w);
  for (int c = 0; c < 3; c++) out[c] = dd_add(evaluate(e->patch->x[c], &w), dd_negate(e->start[c]));
}

/* One Newton step on the patch from (u,v), and x_k - o_k where it ends; the change is returned as its size. */
static double step(const struct exact *e, double *u, double *v, double *out_place)
{
  const int k = e->k, i = (k + 1) % 3, j = (k + 2) % 3;
  struct double_double s[3];
  offset_from_start(e, *u, *v, s);
  const double a = residual(e, s, i), b = residual(e, s, j);
  struct patch_jet jet[3];
  for (int c = 0; c < 3; c++) jet[c] = patch_evaluate(e->patch->x[c], *u, *v);
  const double ri = e->d[i] / e->d[k], rj = e->d[j] / e->d[k];
  const double au = jet[i].du - ri * jet[k].du, av = jet[i].dv - ri * jet[k].dv;
  const double bu = jet[j].du - rj * jet[k].du, bv = jet[j].dv - rj * jet[k].dv;
  const double determinant = au * bv - av * bu;
  const double du = (bv * a - av * b) / determinant, dv = (au * b - bu * a) / determinant;
  if (!(fabs(du) < 1 && fabs(dv) < 1)) return INFINITY;
  *u -= du, *v -= dv;
  *out_place = s[k].hi + (s[k].lo - (jet[k].du * du + jet[k].dv * dv));
  return real_max(fabs(du), fabs(dv));
}

static double clamp01(double t) { return t < 0 ? 0 : t > 1 ? 1 : t; }

/* The borders of the patch (see geometry/edges.h) that the root lies on within its radius, as bits; a leaf's own borders inside
 * the patch are none. */
static unsigned borders_of(const struct model_patch *patch, const struct leaf *leaf, const struct leaf_hit *root)
{
  const int last = patch->split - 1;
  return (unsigned)(leaf->column_u == 0 && root->u < root->radius_u) << 0 |
         (unsigned)(leaf->column_u == last && root->u > 1 - root->radius_u) << 1 |
         (unsigned)(leaf->column_v == 0 && root->v < root->radius_v) << 2 |
         (unsigned)(leaf->column_v == last && root->v > 1 - root->radius_v) << 3;
}

/* The side of the border's curve, as seen along d, on which the patch lies at `along`: the sign of det(d, tangent, inward), 0
 * where it is too small a part of what it could be to be sure of. The tangent runs along the border's parameter. */
static int inner_side(struct model_patch *patch, int border, double along, const double d[3])
{
  /* Derivatives are right to some units in the last place of the patch's size 1; the side is sure well above that. */
  static const double sure = 0x1p-40;
  const double u = border == 0 ? 0 : border == 1 ? 1 : along, v = border == 2 ? 0 : border == 3 ? 1 : along;
  const double inward = border == 0 || border == 2 ? 1 : -1;
  double tangent[3], in[3], normal[3];
  for (int c = 0; c < 3; c++) {
    const struct patch_jet jet = patch_evaluate(patch->x[c], u, v);
    tangent[c] = border < 2 ? jet.dv : jet.du;
    in[c] = inward * (border < 2 ? jet.du : jet.dv);
  }
  vector_cross(tangent, in, normal);
  const double side = vector_dot(normal, d);
  return side > sure ? 1 : side < -sure ? -1 : 0;
}

/* A root on a border is proven where the border is shared and the two patches lie on either side of it as seen along the ray:
 * then the ray, wherever it passes within the radius, meets one of them. */
static bool passes_border(const struct model *model, uint32_t index, unsigned borders, double u, double v, const double d[3])
{
  if (borders & (borders - 1)) return false; /* a corner */
  const int border = __builtin_ctz(borders);
  const struct edge_neighbour *other = &model->neighbours[4 * (size_t)index + (size_t)border];
  if (other->patch == EDGE_NONE) return false;
  const double along = border < 2 ? v : u;
  const int here = inner_side(&model->patches[index], border, along, d);
  int there = inner_side(&model->patches[other->patch], other->border, other->reversed ? 1 - along : along, d);
  if (other->reversed) there = -there;
  return here * there == -1;
}

/* The point, its error bound and the normal. */
static void set_surface(struct model_patch *patch, const double direction[3], struct hit *out)
{
  double tangent = 0, magnitude = 0, su[3], sv[3];
  for (int c = 0; c < 3; c++) {
    const struct patch_jet jet = patch_evaluate(patch->x[c], out->u, out->v);
    out->point[c] = patch->center[c] + patch->scale * jet.value;
    su[c] = jet.du, sv[c] = jet.dv;
    tangent = real_max(tangent, fabs(jet.du) + fabs(jet.dv));
    magnitude = real_max(magnitude, fabs(out->point[c]));
  }
  /* The point: its value (ten roundings on coefficients below one), the last places of u and v, one rounding of the sum; in
   * each coordinate, so up to sqrt(3) of it in distance. */
  out->point_error = 2 * ((12 + 2 * tangent) * UNIT_ROUNDOFF * patch->scale + UNIT_ROUNDOFF * magnitude);
  vector_cross(su, sv, out->normal);
  const double length = vector_length(out->normal);
  if (length > PLAIN_NORMAL * tangent * tangent) vector_scale(1 / length, out->normal, out->normal);
  else patch_normal(patch->x, out->u, out->v, out->normal);
  if (vector_dot(out->normal, direction) > 0) vector_scale(-1, out->normal, out->normal);
}

/* Newton on the patch itself, and t from where it ends. */
static void improve(struct model_patch *patch, const struct ray *ray, double *u, double *v, double *t)
{
  struct exact e = {patch, {{0, 0}}, ray->direction, dominant_axis(ray->direction)};
  for (int c = 0; c < 3; c++) {
    const struct double_double q = dd_two_sum(ray->origin[c], -patch->center[c]);
    e.start[c] = (struct double_double){q.hi / patch->scale, q.lo / patch->scale};
  }
  double place, x = *u, y = *v;
  for (int n = 0; n < FINISH_STEPS; n++) {
    const double size = step(&e, &x, &y, &place);
    if (!(size < 1)) return;
    if (size <= FINISH_STEP) break;
  }
  *u = clamp01(x), *v = clamp01(y);
  *t = place * (patch->scale / e.d[e.k]);
}

/* Gives a root on a shared border to the patch that stands first in the scene, so that which of the two has it does not depend on
 * the last bits. A corner is left where it was found. */
static void settle_border(const struct model *model, unsigned borders, struct hit *hit)
{
  if (borders == 0 || (borders & (borders - 1))) return;
  const int border = __builtin_ctz(borders);
  const struct edge_neighbour *other = &model->neighbours[4 * (size_t)hit->patch + (size_t)border];
  if (other->patch >= hit->patch) return; /* EDGE_NONE is the largest */
  const double found = border < 2 ? hit->v : hit->u, along = other->reversed ? 1 - found : found, side = other->border & 1;
  hit->patch = other->patch;
  hit->u = other->border < 2 ? side : along;
  hit->v = other->border < 2 ? along : side;
}

/* A ray that starts nearer to the surface than this cannot be told from one that starts on it: the point's own error and the
 * rounding of the new origin, and the distance within which subdivision cannot exclude a root: UNDECIDED_ERRORS error bounds of
 * either plane, with moments of at most 2 as for all rays that start in the patch's box; doubled for the planes' being
 * oblique. On a border the neighbour's size counts as well. */
static double clearance(const struct model *model, uint32_t index, unsigned borders, const struct hit *hit)
{
  double scale = model->patches[index].scale, magnitude = 0;
  for (int border = 0; border < 4; border++) {
    const uint32_t other = model->neighbours[4 * (size_t)index + (size_t)border].patch;
    if ((borders >> border & 1) && other != EDGE_NONE) scale = real_max(scale, model->patches[other].scale);
  }
  for (int k = 0; k < 3; k++) magnitude = real_max(magnitude, fabs(hit->point[k]));
  return hit->point_error + 4 * UNIT_ROUNDOFF * magnitude + 2 * UNDECIDED_ERRORS * PLANE_ERROR(2, 2) * scale;
}

void finish_hit(const struct model *model, const struct ray *ray, const struct best *best, struct hit *out)
{
  out->patch = HIT_NONE;
  out->certainty = model->unproven ? CERTAINTY_GRAZING : CERTAINTY_CERTAIN;
  if (!best->leaf) return;
  const struct leaf *leaf = best->leaf;
  struct model_patch *patch = &model->patches[leaf->patch];
  out->patch = leaf->patch;
  out->t = best->root.t;
  out->u = clamp01(leaf_to_patch(patch->split, leaf->column_u, best->root.u));
  out->v = clamp01(leaf_to_patch(patch->split, leaf->column_v, best->root.v));
  if (best->root.certain && best->root.t_error > PLAIN_ERROR * fabs(best->root.t)) improve(patch, ray, &out->u, &out->v, &out->t);
  /* The improvement may have taken the last bits of t to the end of the interval. */
  if (!(out->t > ray->t_min)) out->t = nextafter(ray->t_min, INFINITY);
  if (!(out->t < ray->t_max)) out->t = nextafter(ray->t_max, -INFINITY);
  const unsigned borders = borders_of(patch, leaf, &best->root);
  if (!best->root.certain || (borders && !passes_border(model, leaf->patch, borders, out->u, out->v, ray->direction)))
    out->certainty = CERTAINTY_GRAZING;
  settle_border(model, borders, out);
  set_surface(&model->patches[out->patch], ray->direction, out);
  out->clearance = clearance(model, leaf->patch, borders, out);
}
