/* All that a ray may meet in a region of a patch, by recursive halving.
 *
 * A box of parameters is dropped where some linear combination of the two plane polynomials keeps one sign on it
 * (the convex hull property), solved where the certificate finds a root that is alone in it, and halved otherwise.
 * The box that begins first along the ray is next, and those behind the nearest hit so far are dropped. Where a
 * combination is indistinguishable from zero on a box, the surface is seen edge-on there, nearer to tangency than about
 * 1e-7: a fold is looked for (fold.h), and else the box is searched by itself, with polynomials made for it in wide
 * arithmetic (zoom.h), which scales what is too small to tell. Where some combination is zero in wide arithmetic, all over
 * the patch, the ray lies in the plane of a flat patch, or as good as that, and meets curves: what comes first on them lies
 * on borders of boxes (box.h). What even that leaves (a double root, a ray in the surface), and poles met exactly, are
 * told to the judge as undecided.
 */
#include "intersect/exact/box.h"
#include "intersect/exact/fold.h"
#include "intersect/exact/judge.h"

#include <math.h>
#include <string.h>

#include "base/real.h"
#include "geometry/patch.h"
#include "intersect/prepare/leaf.h"
#include "intersect/point.h"

/* The fraction of the patch's extent below which an undecidable box is not halved further: UNDECIDED_ERRORS of some
 * hundred roundings each, the distance from the ray at which the planes tell nothing any more. */
#define SEARCH_RESOLUTION 0x1p-44

/* How often a box may halve in all: LEAST_SIZE of the whole box either way. */
enum { SEARCH_HALVINGS = 104 };
#define LEAST_SIZE 0x1p-52

/* So many boxes may wait to be looked at in the order in which the ray comes to them: at first, and under the glass. More
 * than these wait only in the order of halving, and so no more than one box can be halved. */
enum { SEARCH_AHEAD = 128, CLOSER_AHEAD = 64, SEARCH_STACK = SEARCH_HALVINGS + 2 };

/* How often a box may be put under the glass, one in the other. */
enum { ZOOM_DEPTH = 12, TANGENT_DEPTH = 4 };

/* A box is put under the glass again where it is so small a part of what was. */
#define ZOOM_AGAIN 0x1p-16

/* A box at a border that is one point is put under the glass where it reaches no farther from it, of the patch. A
 * choice of speed. */
#define ZOOM_POLE 0x1p-10

/* A box at a border that is one point is put under the glass again where it is so small a part, away from the border,
 * of what was: see ZOOM_POLE_NEAREST. */
#define ZOOM_AGAIN_POLE 0x1p-10

/* What may be roots and is no farther than this from a fold, of the box, is told as one place. */
#define FOLD_NEAR 0x1p-36

enum { NO_BORDER = -1, TWO_BORDERS = -2 };

struct search {
  struct judge *judge;
  int depth;            /* how often the whole box has been put under the glass */
  int ahead;            /* boxes that may wait in the order of the ray */
  int divided;          /* the border by the distance to which the first net is divided (zoom_pole_box), or NO_BORDER */
  wide low[2], size[2]; /* of the whole box, in parameters of the patch */
  bool dependent;       /* some combination is zero, which it then is everywhere: there is nothing to see of it */
  bool met;             /* the pole there may be met: nothing is said of what is next to it */
  double unit, start[2], to_t; /* t = ((unit w + start[1]) + start[0]) to_t: see local_ray.h */
  double error[2];             /* bounds on the errors of coefficients of the first two nets before any halving */
  double depth_error;          /* of w */
  double extent[2];            /* bounds on the derivatives by the whole box's parameters */
  double resolution;           /* of t */
  bool pole[4];                /* borders of the whole box (geometry/edges.h) that are one point */
};

static double depth_to_t(const struct search *s, double w)
{
  return ((s->unit * w + s->start[1]) + s->start[0]) * s->to_t;
}

/* What dw on x_k is on the ray. */
static double length_to_t(const struct search *s, double dw) { return error_to_t(s->to_t, s->unit * dw); }

/* The bound on rounding in a coefficient of the box's nets: each halving adds three additions on values of the
 * whole box's size. */
static void box_error(const struct search *s, const struct box *box, double out[2])
{
  for (int k = 0; k < 2; k++) out[k] = s->error[k] + box->halvings * 4 * UNIT_ROUNDOFF;
}

static void box_reach(const struct search *s, struct box *box)
{
  double lo = box->net[2][0][0], hi = lo;
  for (int n = 1; n < 16; n++)
    lo = real_min(lo, box->net[2][n / 4][n % 4]), hi = real_max(hi, box->net[2][n / 4][n % 4]);
  const double p = depth_to_t(s, lo), q = depth_to_t(s, hi);
  const double slack = length_to_t(s, s->depth_error) + 8 * UNIT_ROUNDOFF * real_max(fabs(p), fabs(q));
  box->near = real_min(p, q) - slack, box->far = real_max(p, q) + slack;
}

/* The box's root, wherever it lies: one just outside the box is the neighbour's as well, and the same. */
static struct exact_root box_root(const struct search *s, struct box *box, const double at[2], const double radius[2])
{
  const struct patch_jet w = patch_evaluate(box->net[2], at[0], at[1]);
  double bend[3];
  box_bends(box->net[2], bend);
  const double t = depth_to_t(s, w.value), sum = radius[0] + radius[1];
  const double off = fabs(w.du) * radius[0] + fabs(w.dv) * radius[1] +
                     BOX_MARGIN_GROWTH * (bend[0] + 2 * bend[1] + bend[2]) * sum * sum;
  struct exact_root root = {.t = t};
  root.t_error = length_to_t(s, off + s->depth_error) + 8 * UNIT_ROUNDOFF * (fabs(t) + length_to_t(s, fabs(w.value)));
  if (s->depth > 0) {
    root.u = s->low[0] + s->size[0] * ((wide)box->u + (wide)box->size_u * at[0]);
    root.v = s->low[1] + s->size[1] * ((wide)box->v + (wide)box->size_v * at[1]);
    root.t = zoom_t(judge_zoom(s->judge), root.u, root.v);
    root.t_error = length_to_t(s, off + judge_zoom(s->judge)->depth_error) +
                   8 * (double)WIDE_ROUNDOFF * fabs((double)root.t);
  } else {
    root.u = (double)s->low[0] + (double)s->size[0] * (box->u + box->size_u * at[0]);
    root.v = (double)s->low[1] + (double)s->size[1] * (box->v + box->size_v * at[1]);
  }
  const double rounding = s->depth > 0 ? 0 : 4 * UNIT_ROUNDOFF;
  root.radius_u = radius[0] * box->size_u * (double)s->size[0] * (1 + 4 * UNIT_ROUNDOFF) + rounding;
  root.radius_v = radius[1] * box->size_v * (double)s->size[1] * (1 + 4 * UNIT_ROUNDOFF) + rounding;
  return root;
}

/* Tells of a point of a box that cannot be decided: the one next to its middle that is on the ray, which stands for all of
 * a small one. A box that is not small is a doubt, whether or not it has such a point. */
static void box_tell_maybe(struct search *s, struct box *box, bool small)
{
  double u = 0.5, v = 0.5, error[2];
  box_error(s, box, error);
  if (!small) judge_undecided(s->judge, box->near);
  if (!box_onto_ray(box, error, &u, &v) && !small) return;
  const double t = depth_to_t(s, patch_evaluate(box->net[2], u, v).value);
  judge_maybe(s->judge, (double)(s->low[0] + s->size[0] * (box->u + box->size_u * u)),
              (double)(s->low[1] + s->size[1] * (box->v + box->size_v * v)), t,
              real_min(box->far - box->near, s->resolution));
}

/* The border that is one point and that the box lies at. */
static int box_pole(const struct search *s, const struct box *box)
{
  const bool at[4] = {box->u == 0, box->u + box->size_u == 1, box->v == 0, box->v + box->size_v == 1};
  int pole = NO_BORDER;
  for (int k = 0; k < 4; k++)
    if (s->pole[k] && at[k]) pole = pole == NO_BORDER ? k : TWO_BORDERS;
  return pole;
}

/* A box at a pole no wider than this along the border, of the patch, is made smaller towards the
 * pole only: the place along the border is known no better than the direction in which the ray passes the pole. A
 * choice of speed. */
#define NARROW_AT_POLE 0x1p-5

static bool narrow_at_pole(const struct search *s, const struct box *box)
{
  if (s->divided == NO_BORDER || box_pole(s, box) != s->divided) return false;
  return (double)(s->divided < 2 ? s->size[1] * box->size_v : s->size[0] * box->size_u) <= NARROW_AT_POLE;
}

/* Halves across the parameter along which the box is longer as seen along the ray, for that is what hull tests and
 * Newton's process need: at a tangency boxes get long along the ray and narrow across it. Where it is seen as a
 * point, across the one along which it is longer on the ray; and where the polynomials are dependent, in space. */
static void box_halve(const struct search *s, struct box *box, struct box out[2])
{
  double along_u, along_v, error[2];
  box_variation(box, 0, 1, &along_u, &along_v);
  box_error(s, box, error);
  if (real_max(along_u, along_v) <= FLAT_ERRORS * real_max(error[0], error[1]))
    box_variation(box, 2, 2, &along_u, &along_v);
  bool across_u = along_u == along_v ? box->size_u >= box->size_v : along_u > along_v;
  if (narrow_at_pole(s, box)) across_u = s->divided < 2;
  if (s->dependent) across_u = s->extent[0] * box->size_u >= s->extent[1] * box->size_v;
  if (across_u ? box->size_u <= LEAST_SIZE : box->size_v <= LEAST_SIZE) across_u = !across_u;
  box_cut(box, across_u, out);
  for (int h = 0; h < 2; h++) box_reach(s, &out[h]);
}

static void search_run(struct search *s, const struct box *whole, struct box waiting[]);

/* The search of the box alone. */
static struct search closer_search(const struct search *s, const struct box *box)
{
  struct search closer = {.judge = s->judge,
                          .depth = s->depth + 1,
                          .ahead = s->judge->all ? 0 : CLOSER_AHEAD,
                          .divided = NO_BORDER,
                          .unit = s->unit,
                          .to_t = (double)(judge_zoom(s->judge)->to_t / s->unit),
                          .resolution = s->resolution};
  closer.size[0] = s->size[0] * box->size_u, closer.size[1] = s->size[1] * box->size_v;
  closer.low[0] = s->low[0] + s->size[0] * box->u, closer.low[1] = s->low[1] + s->size[1] * box->v;
  closer.extent[0] = s->extent[0] * box->size_u, closer.extent[1] = s->extent[1] * box->size_v;
  closer.pole[0] = s->pole[0] && box->u == 0, closer.pole[1] = s->pole[1] && box->u + box->size_u == 1;
  closer.pole[2] = s->pole[2] && box->v == 0, closer.pole[3] = s->pole[3] && box->v + box->size_v == 1;
  return closer;
}

static void closer_run(struct search *closer, const struct zoomed *zoomed)
{
  double size = 0;
  for (int n = 0; n < 16; n++) size = real_max(size, fabs(zoomed->net[2][n / 4][n % 4]));
  const wide start = zoomed->start * closer->unit;
  closer->start[0] = (double)start, closer->start[1] = (double)(start - closer->start[0]);
  for (int k = 0; k < 2; k++) closer->error[k] = zoomed->error[k];
  closer->depth_error = 32 * UNIT_ROUNDOFF * size + judge_zoom(closer->judge)->depth_error;
  struct box whole = {.u = 0, .v = 0, .size_u = 1, .size_v = 1, .halvings = 0}, waiting[CLOSER_AHEAD + SEARCH_STACK];
  memcpy(whole.net, zoomed->net, sizeof whole.net);
  search_run(closer, &whole, waiting);
}

/* Searches the box by itself under the glass. Returns whether that could be done. */
static bool box_zoom(struct search *s, const struct box *box)
{
  struct search closer = closer_search(s, box);
  struct zoomed zoomed;
  judge_spend(s->judge, WORK_ZOOM);
  if (!zoom_box(judge_zoom(s->judge), closer.low, closer.size, &zoomed)) {
    s->dependent = true;
    return false;
  }
  closer_run(&closer, &zoomed);
  return true;
}

/* The same at a border that is one point. */
static bool box_zoom_pole(struct search *s, const struct box *box, int border)
{
  struct search closer = closer_search(s, box);
  struct zoomed zoomed;
  enum zoom_pole pole;
  judge_spend(s->judge, WORK_ZOOM);
  const bool done = zoom_pole_box(judge_zoom(s->judge), closer.low, closer.size, border, &zoomed, &pole);
  closer.met = pole == POLE_MET && !judge_pole(s->judge, border);
  s->dependent |= !done;
  if (!done) return false;
  closer.divided = border;
  for (int k = 0; k < 2 && closer.met; k++) zoomed.error[k] += zoomed.met[k];
  closer_run(&closer, &zoomed);
  return true;
}

/* Whether a box that double precision cannot decide is to be put under the glass: once, and again where it is a small
 * part of what was, for the roots next to a tangency are as far apart as the square root of what separates it from
 * one. */
static bool box_asks_zoom(const struct search *s, const struct box *box)
{
  if (s->dependent) return false;
  if (s->divided != NO_BORDER) return s->depth == 1;
  return s->depth == 0 || (s->depth < TANGENT_DEPTH && box->size_u * box->size_v <= ZOOM_AGAIN);
}

/* Whether the box is to be put under the glass for the pole it lies at: as soon as it is not most of the patch, and
 * whenever it has become small. */
static bool box_asks_pole(const struct search *s, const struct box *box, int border)
{
  if (border < 0 || s->met || s->dependent || s->depth >= ZOOM_DEPTH) return false;
  const double size = border < 2 ? box->size_u : box->size_v;
  if (s->divided != border) return size * (double)s->size[border / 2] <= ZOOM_POLE;
  return size <= ZOOM_AGAIN_POLE;
}

/* Whether the root, in the box's parameters, is far enough from the border that the first net is divided by. */
static bool far_from_pole(const struct search *s, const struct box *box, const double root[2])
{
  const double u = box->u + box->size_u * root[0], v = box->v + box->size_v * root[1];
  const double distance[4] = {u, 1 - u, v, 1 - v};
  return s->divided < 0 || distance[s->divided] >= ZOOM_POLE_NEAREST;
}

/* ---- folds ---- */

/* The parameter of the patch where the fold's parameter is x. */
static wide fold_place(const struct search *s, const struct box *box, int k, double x)
{
  const double at = k ? box->v : box->u, size = k ? box->size_v : box->size_u;
  return s->low[k] + s->size[k] * ((wide)at + (wide)size * (0.5 + 0.5 * x));
}

/* The root on one side of the fold; false where it is not proven. error: of the box's nets, or NULL under the glass. */
static bool fold_root(struct search *s, struct box *box, const struct fold *fold, const double *error, double side,
                      struct exact_root *out)
{
  double x[2], root[2], radius[2];
  for (int k = 0; k < 2; k++) x[k] = fold->at[k] + side * fold->way[k], root[k] = 0.5 + 0.5 * x[k];
  if (error) {
    if (!box_solve(box, error, false, root, radius)) return false;
    *out = box_root(s, box, root, radius);
    return true;
  }
  *out = (struct exact_root){
    .u = fold_place(s, box, 0, x[0]), .v = fold_place(s, box, 1, x[1]), .radius_u = INFINITY, .radius_v = INFINITY};
  judge_spend(s->judge, WORK_SHARPEN);
  if (!zoom_sharpen(judge_zoom(s->judge), out)) return false;
  for (int k = 0; k < 2; k++) {
    const wide at = k ? out->v : out->u;
    if (!(at >= fold_place(s, box, k, -FOLD_REACH) && at <= fold_place(s, box, k, FOLD_REACH))) return false;
  }
  return true;
}

static bool apart(wide a, wide b, double radii) { return fabs((double)(a - b)) > radii; }

/* Tells of the two roots on either side of a fold; false where they are not proven, and nothing is told. */
static bool fold_roots(struct search *s, struct box *box, const struct fold *fold, const double *error)
{
  struct exact_root root[2];
  for (int n = 0; n < 2; n++)
    if (!fold_root(s, box, fold, error, n ? fold->half : -fold->half, &root[n])) return false;
  if (!apart(root[0].u, root[1].u, root[0].radius_u + root[1].radius_u) &&
      !apart(root[0].v, root[1].v, root[0].radius_v + root[1].radius_v))
    return false;
  for (int n = 0; n < 2; n++) judge_root(s->judge, &root[n]);
  return true;
}

/* A double root, two or none: the fold itself may be a hit, where it is in the box. */
static bool fold_maybe(struct search *s, struct box *box, const struct fold *fold)
{
  double at[2];
  const double way = real_max(fabs(fold->way[0]), fabs(fold->way[1]));
  const double reach = 2 * (fold->half * way + fold->uncertain); /* the arc bends */
  if (!(reach <= FOLD_NEAR)) return false;
  for (int k = 0; k < 2; k++) {
    if (fabs(fold->at[k]) > 1 + reach) return true;
    at[k] = 0.5 + 0.5 * real_min(real_max(fold->at[k], -1), 1);
  }
  const struct patch_jet w = patch_evaluate(box->net[2], at[0], at[1]);
  const double t = depth_to_t(s, w.value), off = (fabs(w.du) + fabs(w.dv)) * reach;
  judge_maybe(s->judge, (double)fold_place(s, box, 0, 2 * at[0] - 1), (double)fold_place(s, box, 1, 2 * at[1] - 1), t,
              length_to_t(s, off + s->depth_error) + 8 * UNIT_ROUNDOFF * (fabs(t) + length_to_t(s, fabs(w.value))));
  return true;
}

/* Decides the box where it has a fold. */
static bool box_fold(struct search *s, struct box *box, const struct fold_pair *pair, const double error[2])
{
  struct fold fold;
  judge_spend(s->judge, WORK_FOLD);
  if (!fold_find(pair, error, &fold)) return false;
  enum fold_verdict verdict = fold_weigh_box(&fold, box, error);
  if (verdict == FOLD_EMPTY || (verdict == FOLD_ROOTS && fold_roots(s, box, &fold, error))) return true;
  if (judge_zoom(s->judge)->axis != s->judge->local.axis) return false; /* of other planes */
  double values[2][3];
  const double size[2] = {box->size_u * (double)s->size[0], box->size_v * (double)s->size[1]};
  const double off = zoom_combinations(judge_zoom(s->judge), fold_place(s, box, 0, fold.at[0]),
                                       fold_place(s, box, 1, fold.at[1]), size, fold.row, values);
  verdict = fold_weigh(&fold, values[0], values[1], off);
  if (verdict == FOLD_EMPTY || (verdict == FOLD_ROOTS && fold_roots(s, box, &fold, NULL))) return true;
  return fold_maybe(s, box, &fold);
}

/* Decides the box where the ray touches the surface, or nearly; `folds`: and by its fold. */
static bool box_touched(struct search *s, struct box *box, const double error[2], bool folds)
{
  struct fold_pair pair;
  fold_combine(box, &pair);
  return fold_bent_apart(&pair, box, error) || (folds && box_fold(s, box, &pair, error));
}

/* Whether the box is as small as an undecided one is to be: along the ray, and in all directions or at least as
 * seen. */
static bool box_small(const struct search *s, const struct box *box, enum verdict verdict)
{
  return box->far - box->near <= s->resolution &&
         (verdict == VERDICT_POINT || s->extent[0] * box->size_u + s->extent[1] * box->size_v <= SEARCH_RESOLUTION);
}

/* Decides the box where the two polynomials are one, and the ray meets curves, if that can be told: what comes first on
 * them may be a hit. Where that is before the ray's start it is what comes next to that, or halving finds it. */
static bool box_flat(struct search *s, struct box *box, const double error[2])
{
  double u = 0, v = 0, off = 0;
  const enum box_curves curves = box_curves_begin(box, error, s->to_t < 0 ? -1 : 1, &u, &v, &off);
  if (curves != BOX_CURVES_BEGIN) return curves == BOX_CURVES_NONE;
  if (!(length_to_t(s, off) <= s->resolution)) return false;
  const double begin = s->judge->asked->ray->t_min + s->resolution;
  double t = depth_to_t(s, patch_evaluate(box->net[2], u, v).value);
  if (!(t > begin)) {
    const double next = (((begin + s->resolution) / s->to_t - s->start[0]) - s->start[1]) / s->unit;
    if (!box_curves_at(box, error, next, &u, &v)) return false;
    t = depth_to_t(s, patch_evaluate(box->net[2], u, v).value);
    if (!(t > begin && t < s->judge->asked->ray->t_max)) return false;
  }
  judge_maybe(s->judge, (double)(s->low[0] + s->size[0] * (box->u + box->size_u * u)),
              (double)(s->low[1] + s->size[1] * (box->v + box->size_v * v)), t, s->resolution);
  return true;
}

/* Decides the box: true where nothing is left to do with it. */
static bool box_decide(struct search *s, struct box *box)
{
  if (box->near > s->judge->limit || box->far < s->judge->asked->ray->t_min) return true;
  const int border = box_pole(s, box);
  if (s->met && border == s->divided && (border < 2 ? box->size_u : box->size_v) <= ZOOM_POLE_MET) return true;
  if (box_asks_pole(s, box, border) && box_zoom_pole(s, box, border)) return true;
  double error[2];
  box_error(s, box, error);
  const enum verdict verdict = box_test(box, error);
  if (verdict == VERDICT_EMPTY || (s->dependent && s->depth == 0 && box_flat(s, box, error))) return true;
  double root[2] = {0.5, 0.5}, radius[2];
  if (verdict == VERDICT_OPEN && box_solve(box, error, true, root, radius) && far_from_pole(s, box, root)) {
    struct exact_root found = box_root(s, box, root, radius);
    judge_root(s->judge, &found);
    return true;
  }
  if (!s->dependent && box_touched(s, box, error, s->depth == 0 && border == NO_BORDER)) return true;
  const bool small = verdict != VERDICT_OPEN && box_small(s, box, verdict);
  if (verdict != VERDICT_OPEN && box_asks_zoom(s, box) && border == NO_BORDER && box_zoom(s, box)) return true;
  if (!small && box->halvings < SEARCH_HALVINGS) return false;
  box_tell_maybe(s, box, small);
  return true;
}

/* The box to look at: the one that begins first along the ray; of those that begin at one place the last one. */
static int next_box(const struct search *s, const struct box waiting[], int count)
{
  int next = count - 1;
  double before = waiting[next].near - s->resolution;
  for (int n = next; n-- > 0 && count <= s->ahead;)
    if (waiting[n].near < before) next = n, before = waiting[n].near - s->resolution;
  return next;
}

/* Searches the box `whole`, whose nets, and all that the search starts with, are set. waiting: room for s->ahead and
 * SEARCH_STACK boxes. */
static void search_run(struct search *s, const struct box *whole, struct box waiting[])
{
  waiting[0] = *whole;
  box_reach(s, &waiting[0]);
  for (int count = 1; count > 0;) {
    const int next = next_box(s, waiting, count);
    struct box box = waiting[next];
    waiting[next] = waiting[--count];
    judge_spend(s->judge, 1);
    const bool decided = box_decide(s, &box);
    if (decided) continue;
    if (s->judge->work <= 0) {
      box_tell_maybe(s, &box, false);
      while (count-- > 0)
        if (waiting[count].near <= s->judge->limit) box_tell_maybe(s, &waiting[count], false);
      return;
    }
    box_halve(s, &box, &waiting[count]);
    count += 2;
  }
}

/* The quotient; without the dear division where it is a double. */
static wide part_of(int columns, int split)
{
  return (split & (split - 1)) == 0 ? (wide)((double)columns / split) : (wide)columns / split;
}

/* Whether the region is a leaf, kept or not. */
static bool is_leaf(const struct model *model, const struct exact_region *region)
{
  return region->span[0] == 1 && region->span[1] == 1 && !model->cuts[region->patch].copied;
}

/* The search of a region, and its whole box. */
static void search_begin(struct judge *j, const struct exact_region *region, struct search *s, struct box *whole)
{
  struct model_patch *patch = j->is;
  const struct local_ray *ray = &j->local;
  double x[3][16];
  if (region->leaf) memcpy(x, region->leaf->x, sizeof x);
  else leaf_net(patch, region->column, region->span, x);
  *s = (struct search){.judge = j,
                       .ahead = j->all ? 0 : SEARCH_AHEAD,
                       .unit = ray->unit,
                       .start = {ray->start[0], ray->start[1]},
                       .to_t = ray->to_t,
                       .error = {ray->error, ray->error},
                       .depth_error = PLANE_ERROR(0, 0),
                       .divided = NO_BORDER};
  for (int k = 0; k < 2; k++)
    s->low[k] = part_of(region->column[k], patch->split[k]), s->size[k] = part_of(region->span[k], patch->split[k]);
  for (int k = 0; k < 4; k++) s->pole[k] = leaf_border_is_point(patch, region->column, region->span, k);
  if (region->leaf) memcpy(s->extent, region->leaf->first, sizeof s->extent);
  else if (is_leaf(j->asked->model, region)) leaf_bounds(x, s->extent, (double[3]){0});
  else leaf_first_bounds(x, s->extent);
  double nets[3][16];
  local_ray_nets(ray, x, nets[0], nets[1], nets[2]);
  *whole = (struct box){.u = 0, .v = 0, .size_u = 1, .size_v = 1, .halvings = 0};
  memcpy(whole->net, nets, sizeof nets);
  box_reach(s, whole);
  const double slack = length_to_t(s, s->depth_error) +
                       8 * UNIT_ROUNDOFF * real_max(fabs(whole->near), fabs(whole->far));
  s->resolution = real_max((whole->far - whole->near) * SEARCH_RESOLUTION, 4 * slack);
}

double search_near(struct judge *j, const struct exact_region *region)
{
  struct search search;
  struct box whole;
  search_begin(j, region, &search, &whole);
  return whole.near;
}

void search_region(struct judge *j, const struct exact_region *region)
{
  struct search search;
  struct box whole, waiting[SEARCH_AHEAD + SEARCH_STACK];
  search_begin(j, region, &search, &whole);
  if (j->work > 0) search_run(&search, &whole, waiting);
  else box_tell_maybe(&search, &whole, false);
}
