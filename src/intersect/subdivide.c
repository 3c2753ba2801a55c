/* The last resort: the nearest root of (a, b) in a leaf by recursive halving.
 *
 * A box of parameters is dropped where some linear combination of the two plane polynomials keeps one sign on it
 * (the convex hull property), solved where the Newton-Kantorovich test finds a root that is alone in it, and halved
 * otherwise. Boxes are taken nearest first and dropped behind the best root found, so curves of roots (a ray in the
 * plane of a flat patch) cost no more than points. Where a combination is indistinguishable from zero on a box, the
 * surface is seen edge-on there, nearer to tangency than about 1e-7: then the box is searched by itself, with
 * polynomials made for it in wide arithmetic (zoom.h), which scales what is too small to tell. What even that leaves
 * (a double root, a ray in the surface), and poles, are answered by a hit that is not certain.
 */
#include "intersect/subdivide.h"

#include <math.h>
#include <string.h>

#include "base/real.h"
#include "geometry/patch.h"
#include "intersect/zoom.h"

/* How far outside a box, in its own parameters, its root may lie and still be told from having none (then the
 * neighbour has it); and the growth of second-derivative bounds, quartic in the extent, when they are used that far
 * outside: (1 + 2/16)^4 = 1.602. */
#define BOX_MARGIN 0.0625
#define BOX_MARGIN_GROWTH 1.61

/* Newton's last step in box parameters: its square, all that the next one would be, is below the rounding of the
 * values. Not a tolerance of the answer, whose radius is computed. */
#define LAST_STEP 0x1p-28

/* A combination whose computed values are within this many of its error bounds all over a box says nothing about it. */
#define FLAT_ERRORS (UNDECIDED_ERRORS - 1)

/* A leaf is as wide at this distance from a collapsed border, in its parameters, as some tens of the planes' error
 * bounds: what cannot be decided there in double is the pole itself. */
#define POLE_REACH 0x1p-40

/* The fraction of the leaf's extent along the ray below which an undecidable box is not halved further:
 * UNDECIDED_ERRORS of some hundred roundings each, the distance from the ray at which the planes tell nothing any
 * more. */
#define SEARCH_RESOLUTION 0x1p-44

/* How often a box may halve in all: 2^-50 of the leaf either way, and some across. How many boxes may be looked at,
 * of the leaf and of a box under the glass, and how many of those there may be: far above what isolated roots need,
 * which is some hundreds, some tens and a few; only surfaces that lie along the ray over an area come there. */
enum { SEARCH_HALVINGS = 120, SEARCH_BOXES = 20000, ZOOMED_BOXES = 2000, SEARCH_ZOOMS = 200 };

enum verdict {
  VERDICT_EMPTY, /* no root in the box */
  VERDICT_FLAT,  /* some combination, but not all, is indistinguishable from zero on it */
  VERDICT_POINT, /* all are: the box is a point on the ray as far as can be told */
  VERDICT_OPEN
};

struct box {
  double net[3][4][4];         /* a, b, w */
  double u, v, size_u, size_v; /* in leaf parameters */
  double near, far;          /* hull of t */
  int halvings;
};

struct search {
  const struct subdivide_task *task;
  struct zoom *zoom;     /* NULL: the box that is searched is under the glass already */
  double start[2], to_t; /* t = ((w + start[1]) + start[0]) to_t */
  double place;          /* x_k where w is 0 */
  double error[2];       /* bounds on the errors of coefficients of the first two nets before any halving */
  double t_min, t_max, resolution;
  int most_boxes, zooms;
  bool found;
  bool *doubt; /* some root could not be told from t_min */
  double best_t;
  struct leaf_hit best;
};

static double place_to_t(const struct search *s, double w)
{
  return ((w + s->start[1]) + s->start[0]) * s->to_t;
}

/* The bound on rounding in a coefficient of the box's nets: each halving adds three additions on values of the
 * leaf's size. */
static void box_error(const struct search *s, const struct box *box, double out[2])
{
  for (int k = 0; k < 2; k++) out[k] = s->error[k] + box->halvings * 4 * UNIT_ROUNDOFF;
}

static void box_place(const struct search *s, struct box *box)
{
  double lo = box->net[2][0][0], hi = lo;
  for (int n = 1; n < 16; n++)
    lo = real_min(lo, box->net[2][n / 4][n % 4]), hi = real_max(hi, box->net[2][n / 4][n % 4]);
  const double p = place_to_t(s, lo), q = place_to_t(s, hi);
  box->near = real_min(p, q), box->far = real_max(p, q);
}

/* Where p a + q b stands on the box: its hull in units of its error bound. */
static void combination(struct box *box, double p, double q, const double error[2], double out[2])
{
  const double unit = 1 / (fabs(p) * (error[0] + UNIT_ROUNDOFF * 4) + fabs(q) * (error[1] + UNIT_ROUNDOFF * 4));
  for (int n = 0; n < 16; n++) {
    const double value = (p * box->net[0][n / 4][n % 4] + q * box->net[1][n / 4][n % 4]) * unit;
    out[0] = n ? real_min(out[0], value) : value, out[1] = n ? real_max(out[1], value) : value;
  }
}

/* Tries the combinations a, b and the two rows of the adjugate Jacobian in the middle, which aim along the
 * parameters, or, where the Jacobian is singular, at the one direction in which the surface is seen edge-on. */
static enum verdict box_test(struct box *box, const double error[2])
{
  const struct patch_jet a = patch_evaluate(box->net[0], 0.5, 0.5);
  const struct patch_jet b = patch_evaluate(box->net[1], 0.5, 0.5);
  const double rows[4][2] = {{1, 0}, {0, 1}, {b.dv, -a.dv}, {-b.du, a.du}};
  bool flat = false, steep = false;
  for (int k = 0; k < 4; k++) {
    if (rows[k][0] == 0 && rows[k][1] == 0) continue;
    double range[2] = {0, 0};
    combination(box, rows[k][0], rows[k][1], error, range);
    if (range[0] > 1 || range[1] < -1) return VERDICT_EMPTY;
    if (range[0] > -FLAT_ERRORS && range[1] < FLAT_ERRORS) flat = true;
    else steep = true;
  }
  return !flat ? VERDICT_OPEN : steep ? VERDICT_FLAT : VERDICT_POINT;
}

/* The largest |(p a + q b)''| of each kind on the box. */
static void second_bounds(struct box *box, double p, double q, double out[3])
{
  double n[4][4];
  for (int k = 0; k < 16; k++) n[k / 4][k % 4] = p * box->net[0][k / 4][k % 4] + q * box->net[1][k / 4][k % 4];
  out[0] = out[1] = out[2] = 0;
  for (int i = 0; i < 4; i++) {
    for (int j = 0; j < 4; j++) {
      if (i < 2) out[0] = real_max(out[0], 6 * fabs(n[i + 2][j] - 2 * n[i + 1][j] + n[i][j]));
      if (i < 3 && j < 3) out[1] = real_max(out[1], 9 * fabs(n[i + 1][j + 1] - n[i + 1][j] - n[i][j + 1] + n[i][j]));
      if (j < 2) out[2] = real_max(out[2], 6 * fabs(n[i][j + 2] - 2 * n[i][j + 1] + n[i][j]));
    }
  }
}

/* Newton from the middle, then the test of refine.h in the box's own parameters, with the second derivatives of the
 * plane polynomials themselves. Writes the root in box parameters with its radii; returns whether it is proven and
 * alone. */
static bool box_solve(struct box *box, const double error[2], double root[2], double radius[2])
{
  double u = 0.5, v = 0.5, step = 2, m[2][2] = {{0}};
  for (int n = 0; n < 12 && step > LAST_STEP; n++) {
    const struct patch_jet a = patch_evaluate(box->net[0], u, v), b = patch_evaluate(box->net[1], u, v);
    const double determinant = a.du * b.dv - a.dv * b.du;
    if (determinant == 0) return false;
    const double inverse = 1 / determinant;
    m[0][0] = b.dv * inverse, m[0][1] = -a.dv * inverse, m[1][0] = -b.du * inverse, m[1][1] = a.du * inverse;
    const double su = m[0][0] * a.value + m[0][1] * b.value, sv = m[1][0] * a.value + m[1][1] * b.value;
    step = real_max(fabs(su), fabs(sv));
    u -= su, v -= sv;
    if (!(fabs(u - 0.5) < 1 && fabs(v - 0.5) < 1)) return false;
  }
  if (!(step <= LAST_STEP)) return false;
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
    radius[k] = 2 * (fabs(m[k][0]) * error[0] + fabs(m[k][1]) * error[1]);
    size = real_max(size, radius[k] / 2);
  }
  for (int k = 0; k < 2; k++) radius[k] += 2 * lipschitz * step * step;
  root[0] = u, root[1] = v;
  return lipschitz * (step + size) <= 0.125 && q < 1.9;
}

static void offer(struct search *s, struct leaf_hit *hit)
{
  /* As the packet judges it: a root it would refuse at t_min must not stand in the way of the next one. */
  const enum leaf_hit_side side = leaf_hit_side(s->task->model, s->task->leaf, s->task->world, hit);
  if (side == SIDE_UNKNOWN) *s->doubt = true;
  if (side != SIDE_BEHIND || !(hit->t < s->t_max) || (s->found && hit->t >= s->best_t)) return;
  s->found = true, s->best_t = hit->t, s->best = *hit;
}

/* Offers the box's root, where it lies in the leaf; one just outside the box is the neighbour's as well, and the
 * same. */
static void box_offer(struct search *s, struct box *box, const double root[2], const double radius[2])
{
  const double u = box->u + box->size_u * root[0], v = box->v + box->size_v * root[1];
  const double radius_u = radius[0] * box->size_u + UNIT_ROUNDOFF, radius_v = radius[1] * box->size_v + UNIT_ROUNDOFF;
  if (u < -radius_u || u > 1 + radius_u || v < -radius_v || v > 1 + radius_v) return;
  const double w = patch_evaluate(box->net[2], root[0], root[1]).value;
  struct leaf_hit hit = {u, v, radius_u, radius_v, s->place + w, place_to_t(s, w), 0, true, false};
  hit.t_error = leaf_hit_t_error(s->task->leaf, &hit, s->to_t);
  offer(s, &hit);
}

/* Offers the middle of a box that cannot be decided. */
static void box_offer_undecided(struct search *s, struct box *box)
{
  const double w = patch_evaluate(box->net[2], 0.5, 0.5).value, t = place_to_t(s, w);
  struct leaf_hit hit = {box->u + box->size_u / 2, box->v + box->size_v / 2, box->size_u, box->size_v, s->place + w, t,
                         box->far - box->near + 8 * UNIT_ROUNDOFF * fabs(t), false, false};
  offer(s, &hit);
}

static void cubic_halves(const double *c, int stride, double *low, double *high)
{
  const double half = 0.5, c1 = c[stride], c2 = c[2 * stride];
  const double q0 = half * (c[0] + c1), q1 = half * (c1 + c2), q2 = half * (c2 + c[3 * stride]);
  const double r0 = half * (q0 + q1), r1 = half * (q1 + q2);
  low[0] = c[0], low[stride] = q0, low[2 * stride] = r0;
  low[3 * stride] = high[0] = half * (r0 + r1);
  high[stride] = r1, high[2 * stride] = q2, high[3 * stride] = c[3 * stride];
}

/* The largest change of the nets first..last from one coefficient to the next, along u and along v. */
static void variation(const struct box *box, int first, int last, double *along_u, double *along_v)
{
  *along_u = *along_v = 0;
  for (int k = first; k <= last; k++) {
    for (int i = 0; i < 4; i++) {
      for (int j = 0; j < 3; j++) {
        *along_v = real_max(*along_v, fabs(box->net[k][i][j + 1] - box->net[k][i][j]));
        *along_u = real_max(*along_u, fabs(box->net[k][j + 1][i] - box->net[k][j][i]));
      }
    }
  }
}

/* Halves across the parameter along which the box is longer as seen along the ray, for that is what hull tests and
 * Newton's process need: at a tangency boxes get long along the ray and narrow across it. Where it is seen as a
 * point, across the one along which it is longer on the ray. */
static void box_halve(const struct search *s, struct box *box, struct box out[2])
{
  double along_u, along_v, error[2];
  variation(box, 0, 1, &along_u, &along_v);
  box_error(s, box, error);
  if (real_max(along_u, along_v) <= FLAT_ERRORS * real_max(error[0], error[1]))
    variation(box, 2, 2, &along_u, &along_v);
  const bool across_u = along_u == along_v ? box->size_u >= box->size_v : along_u > along_v;
  for (int h = 0; h < 2; h++) {
    out[h].u = box->u, out[h].v = box->v, out[h].size_u = box->size_u, out[h].size_v = box->size_v;
    if (across_u) out[h].size_u /= 2, out[h].u += h * out[h].size_u;
    else out[h].size_v /= 2, out[h].v += h * out[h].size_v;
    out[h].halvings = box->halvings + 1;
  }
  for (int k = 0; k < 3; k++)
    for (int n = 0; n < 4; n++)
      if (across_u) cubic_halves(&box->net[k][0][n], 4, &out[0].net[k][0][n], &out[1].net[k][0][n]);
      else cubic_halves(box->net[k][n], 1, out[0].net[k][n], out[1].net[k][n]);
  for (int h = 0; h < 2; h++) box_place(s, &out[h]);
}

/* Whether the box lies at a border of the leaf that is one point, or so near to it that it is one in double
 * precision. */
static bool box_has_pole(const struct search *s, const struct box *box)
{
  const bool at[4] = {box->u == 0 || box->u + box->size_u <= POLE_REACH,
                      box->u + box->size_u == 1 || box->u >= 1 - POLE_REACH,
                      box->v == 0 || box->v + box->size_v <= POLE_REACH,
                      box->v + box->size_v == 1 || box->v >= 1 - POLE_REACH};
  for (int border = 0; border < 4; border++) {
    const int first = border == 1 ? 12 : border == 3 ? 3 : 0, stride = border < 2 ? 1 : 4;
    bool equal = at[border];
    for (int c = 0; equal && c < 3; c++)
      for (int n = 1; n < 4; n++) equal &= s->task->leaf->x[c][first + n * stride] == s->task->leaf->x[c][first];
    if (equal) return true;
  }
  return false;
}

static void search_run(struct search *s, const struct box *whole);

/* Searches the box by itself under the glass. Returns whether that could be done. */
static bool box_zoom(struct search *s, const struct box *box)
{
  const double low[2] = {box->u, box->v}, size[2] = {box->size_u, box->size_v};
  const struct subdivide_task *task = s->task;
  if (s->zooms == 0) zoom_start(task->patch, task->P, task->world, task->local->axis, s->zoom);
  struct zoomed zoomed;
  if (++s->zooms > SEARCH_ZOOMS || !zoom_box(s->zoom, task->leaf, task->patch->split, low, size, &zoomed)) return false;
  struct search closer = {.task = task,
                          .start = {zoomed.start[0], zoomed.start[1]},
                          .to_t = s->to_t,
                          .place = zoomed.place,
                          .error = {zoomed.error[0], zoomed.error[1]},
                          .t_min = s->t_min,
                          .t_max = s->found ? s->best_t : s->t_max,
                          .resolution = s->resolution,
                          .most_boxes = ZOOMED_BOXES,
                          .doubt = s->doubt};
  struct box whole = {.u = box->u, .v = box->v, .size_u = box->size_u, .size_v = box->size_v, .halvings = 0};
  memcpy(whole.net, zoomed.net, sizeof whole.net);
  search_run(&closer, &whole);
  if (closer.found) offer(s, &closer.best);
  return true;
}

/* Whether the box is as small as an undecided one is to be: along the ray, and in all directions or at least as
 * seen. */
static bool box_small(const struct search *s, const struct box *box, enum verdict verdict)
{
  const double *first = s->task->leaf->first;
  return box->far - box->near <= s->resolution &&
         (verdict == VERDICT_POINT || first[0] * box->size_u + first[1] * box->size_v <= SEARCH_RESOLUTION);
}

/* Decides the box: true where nothing is left to do with it. */
static bool box_decide(struct search *s, struct box *box)
{
  if (box->near >= s->t_max || box->far <= s->t_min || (s->found && box->near >= s->best_t)) return true;
  double error[2];
  box_error(s, box, error);
  const enum verdict verdict = box_test(box, error);
  if (verdict == VERDICT_EMPTY) return true;
  double root[2], radius[2];
  if (verdict == VERDICT_OPEN && box_solve(box, error, root, radius)) {
    box_offer(s, box, root, radius);
    return true;
  }
  /* At a pole there is no more to be had under the glass: the edge is as degenerate there. */
  if (verdict != VERDICT_OPEN && s->zoom && !box_has_pole(s, box) && box_zoom(s, box)) return true;
  if ((verdict != VERDICT_OPEN && box_small(s, box, verdict)) || box->halvings >= SEARCH_HALVINGS) {
    box_offer_undecided(s, box);
    return true;
  }
  return false;
}

/* Searches the box `whole`, whose nets, and all that the search starts with, are set. */
static void search_run(struct search *s, const struct box *whole)
{
  struct box stack[SEARCH_HALVINGS + 2];
  stack[0] = *whole;
  box_place(s, &stack[0]);
  int top = 1;
  for (int n = 0; top > 0; n++) {
    struct box box = stack[--top];
    const bool decided = box_decide(s, &box);
    if (decided) continue;
    if (n >= s->most_boxes) {
      box_offer_undecided(s, &box);
      return;
    }
    struct box half[2];
    box_halve(s, &box, half);
    const int nearer = half[1].near < half[0].near;
    stack[top++] = half[!nearer];
    stack[top++] = half[nearer];
  }
}

bool subdivide_closest(const struct subdivide_task *task, struct leaf_hit *out, bool *doubt)
{
  const struct local_ray *ray = task->local;
  struct zoom zoom;
  struct search search = {.task = task,
                          .zoom = &zoom,
                          .start = {ray->start[0], ray->start[1]},
                          .to_t = ray->to_t,
                          .error = {ray->error, ray->error},
                          .t_min = task->t_min,
                          .t_max = task->t_max,
                          .most_boxes = SEARCH_BOXES,
                          .doubt = doubt};
  struct box whole = {.u = 0, .v = 0, .size_u = 1, .size_v = 1, .halvings = 0};
  double nets[3][16];
  local_ray_nets(ray, task->leaf->x, nets[0], nets[1], nets[2]);
  memcpy(whole.net, nets, sizeof nets);
  box_place(&search, &whole);
  search.resolution = real_max((whole.far - whole.near) * SEARCH_RESOLUTION,
                               8 * UNIT_ROUNDOFF * real_max(fabs(whole.near), fabs(whole.far)));
  search_run(&search, &whole);
  *out = search.best;
  return search.found;
}
