/* Turns what is found on one ray into its answer: the order of roots, the ray's start and end.
 *
 * A root counts if it lies in its patch and within the ray's range. Where double precision cannot tell, the root is
 * refined as far as wide arithmetic allows. A root that even then lies on a border goes to a list, which borders.c
 * settles.
 */
#include "intersect/exact/judge.h"

#include <math.h>

#include "base/real.h"
#include "geometry/patch.h"

/* Work that one ray's regions may take together. Isolated roots and folds need some tens, rays that pass a pole or
 * start there some hundreds. Only surfaces that lie along the ray over an area, and start where it does, need this
 * much. */
enum { JUDGE_WORK = 2560 };

/* Once something may be a hit, its region may take no more than this, or than the region's own share; the others then
 * get only theirs (regions.c), in whatever order they come. Most answers are then grazing, whatever else is found. */
enum { JUDGE_MAYBE_WORK = 128 };

/* If the ray starts exactly in the plane of the patch and leaves it, however slowly, the patch is tested with a ray
 * straight across the plane. The ray meets the plane at 0 and nowhere else, and whether there on the patch depends only
 * on its start. */
static void look_across(const struct model *model, uint32_t patch, struct ray *ray)
{
  const struct flat_plane *plane = model_flat_plane(model, patch);
  if (!plane) return;
  const double away = ray->direction[plane->axis];
  if (ray->origin[plane->axis] != plane->value || away == 0) return;
  for (int k = 0; k < 3; k++) ray->direction[k] = 0;
  ray->direction[plane->axis] = copysign(1, away);
}

/* How many rows of the net, from that border on, are in its first point. Of a patch that is one point, three. */
static int rows_in_point(double (*P)[4][3], int border)
{
  const double *net = P[0][0], *point = net + 3 * edge_at(border, 0);
  for (int row = 1; row < 3; row++) {
    for (int n = 0; n < 4; n++) {
      const double *x = net + 3 * (edge_at(border, n) + row * edge_inward(border));
      if (x[0] != point[0] || x[1] != point[1] || x[2] != point[2]) return row;
    }
  }
  return 3;
}

static void set_zeros(struct judge *j)
{
  double(*P)[4][3] = j->asked->model->scene->patches[j->patch].P;
  for (int k = 0; k < 4; k++) {
    const int at = edge_at(k, 0);
    const bool met = j->prepared->pole[k] && judge_passes(&j->ray, P[at / 4][at % 4]);
    j->zeros[k] = met ? rows_in_point(P, k) : 0;
  }
}

void judge_turn(struct judge *j, uint32_t patch)
{
  if (j->patch == patch) return;
  j->patch = patch, j->zoomed = false;
  j->prepared = model_patch_at(j->asked->model, patch, &j->room);
  j->ray = *j->asked->ray;
  look_across(j->asked->model, patch, &j->ray);
  local_ray_make(j->prepared, &j->ray, &j->local);
  set_zeros(j);
}

struct zoom *judge_zoom(struct judge *j)
{
  double(*P)[4][3] = j->asked->model->scene->patches[j->patch].P;
  if (j->zoomed) return &j->zoom;
  zoom_start(j->prepared, P, &j->ray, &j->zoom);
  judge_spend(j, WORK_ZOOM_START);
  j->zoomed = true;
  return &j->zoom;
}

/* ---- where a root lies ---- */

enum side { SIDE_OUTSIDE, SIDE_INSIDE, SIDE_UNKNOWN };

/* On which side of a border at 0 x lies, if known to within `error`; inside is above. */
static enum side side_of(wide x, double error)
{
  return x > error ? SIDE_INSIDE : x < -error ? SIDE_OUTSIDE : SIDE_UNKNOWN;
}

/* A root farther from a border than this plus its radius stays on the same side when rounded to double. */
#define CLEARLY 0x1p-40

/* On which side of its patch's borders the root lies. *borders: those it cannot be told from. */
static enum side root_in_patch(const struct exact_root *root, unsigned *borders)
{
  const double u = (double)root->u, v = (double)root->v;
  const double from_u = root->radius_u + CLEARLY, from_v = root->radius_v + CLEARLY;
  *borders = 0;
  if (u > from_u && 1 - u > from_u && v > from_v && 1 - v > from_v) return SIDE_INSIDE;
  const wide distance[4] = {root->u, 1 - root->u, root->v, 1 - root->v};
  for (unsigned k = 0; k < 4; k++) {
    const enum side side = side_of(distance[k], k < 2 ? root->radius_u : root->radius_v);
    if (side == SIDE_OUTSIDE) return SIDE_OUTSIDE;
    if (side == SIDE_UNKNOWN) *borders |= 1u << k;
  }
  return *borders ? SIDE_UNKNOWN : SIDE_INSIDE;
}

/* Whether the root lies between the ray's start and end, which do not belong to the range: a t known exactly is always
 * on one side. */
static enum side root_in_range(const struct judge *j, const struct exact_root *root)
{
  if (root->t_error == 0 && (root->t <= j->asked->ray->t_min || root->t >= j->asked->ray->t_max)) return SIDE_OUTSIDE;
  const double t = (double)root->t, clearly = root->t_error + 4 * UNIT_ROUNDOFF * fabs(t);
  if (t - j->asked->ray->t_min > clearly && j->asked->ray->t_max - t > clearly) return SIDE_INSIDE;
  const enum side start = side_of(root->t - j->asked->ray->t_min, root->t_error);
  const enum side end = side_of(j->asked->ray->t_max - root->t, root->t_error);
  return start == SIDE_OUTSIDE || end == SIDE_OUTSIDE ? SIDE_OUTSIDE
         : start == SIDE_INSIDE && end == SIDE_INSIDE ? SIDE_INSIDE
                                                      : SIDE_UNKNOWN;
}

/* ---- what is found ---- */

/* Nothing behind the nearest hit matters, nor anything within the error of the nearest maybe: it would be as
 * doubtful. */
static void set_limit(struct judge *j)
{
  double limit = j->asked->ray->t_max;
  if (j->rivals > 0) limit = real_min(limit, (double)j->nearest.t + 2 * j->nearest.t_error);
  if (j->doubtful) limit = real_min(limit, j->maybe.t - j->maybe.t_error);
  j->limit = limit + 4 * UNIT_ROUNDOFF * fabs(limit);
}

static bool list_root(struct judge *j, const struct exact_root *root, enum exact_kind kind, unsigned borders)
{
  const struct exact_found found = {.root = *root, .kind = kind, .borders = borders, .taken = -1};
  return exact_list_add(j->list, &found);
}

/* The least and the largest t that the root may have. */
static double least_t(const struct exact_root *root)
{
  const wide t = root->t - root->t_error;
  return (double)t > t ? nextafter((double)t, -INFINITY) : (double)t;
}

static double most_t(const struct exact_root *root)
{
  const wide t = root->t + root->t_error;
  return (double)t < t ? nextafter((double)t, INFINITY) : (double)t;
}

/* Whether rival a is the nearest wherever b could be: it stands before b, and whatever a is behind, b is behind as
 * well. */
static bool stands_for(const struct exact_root *a, const struct exact_root *b)
{
  return judge_stands_before(a, b) && a->t - a->t_error <= b->t - b->t_error;
}

/* Leaves out one rival, as there is one too many: one that another rival stands for. The one that ends first stays,
 * because a root may be proven to be behind it alone. If none can be left out so, the one left out might have been the
 * nearest. */
static void leave_out_rival(struct judge *j)
{
  struct exact_root *at = j->rival;
  size_t ends = 0, last = 0, out = j->rivals;
  for (size_t k = 1; k < j->rivals; k++)
    if (at[k].t + at[k].t_error < at[ends].t + at[ends].t_error) ends = k;
  if (ends == 0) last = 1;
  for (size_t k = 0; k < j->rivals; k++) {
    if (k == ends) continue;
    if (judge_stands_before(&at[last], &at[k])) last = k;
    for (size_t n = 0; n < j->rivals; n++)
      if (stands_for(&at[n], &at[k])) out = k;
  }
  if (out == j->rivals) out = last, j->tied_from = real_min(j->tied_from, least_t(&at[last]));
  at[out] = at[--j->rivals];
}

static void add_rival(struct judge *j, const struct exact_root *root)
{
  j->rival[j->rivals++] = *root;
  if (j->rivals > JUDGE_RIVALS_MAX) leave_out_rival(j);
  const struct exact_root *first = j->rival;
  for (size_t k = 1; k < j->rivals; k++)
    if (judge_stands_before(&j->rival[k], first)) first = &j->rival[k];
  j->nearest = *first;
}

bool judge_weigh_tie(struct judge *j, const struct exact_root *a, const struct exact_root *b)
{
  const bool fine = judge_tie_fine(a, b);
  if (!fine) j->tied_from = real_min(j->tied_from, real_min(least_t(a), least_t(b)));
  return fine;
}

void judge_keep(struct judge *j, struct exact_root *root)
{
  if (j->all) {
    (void)list_root(j, root, EXACT_INSIDE, 0); /* on failure, list->failed is set */
    return;
  }
  struct exact_root *at = j->rival;
  for (size_t k = 0; k < j->rivals; k++)
    if (root->patch == at[k].patch && exact_roots_meet(root, &at[k])) return;
  for (size_t k = 0; k < j->rivals; k++)
    if (judge_tie(root, &at[k])) judge_improve(j, &at[k]), judge_improve(j, root);
  judge_turn(j, root->patch); /* the patch of the region being searched */
  for (size_t k = 0; k < j->rivals; k++)
    if (!judge_tie(root, &at[k]) && at[k].t <= root->t) return;
  size_t kept = 0;
  for (size_t k = 0; k < j->rivals; k++) {
    if (!judge_tie(root, &at[k])) continue;
    (void)judge_weigh_tie(j, root, &at[k]);
    at[kept++] = at[k];
  }
  j->rivals = kept;
  add_rival(j, root);
  set_limit(j);
}

/* `from`: t at which what may be a hit begins. `in_range`: its t is proven to be in the ray's range, though it may be
 * so near an end that its double is not. */
static void keep_maybe(struct judge *j, const struct exact_maybe *maybe, double from, bool in_range)
{
  const struct ray *ray = j->asked->ray;
  if (!in_range && (maybe->t < ray->t_min - maybe->t_error || maybe->t > ray->t_max + maybe->t_error)) return;
  judge_undecided(j, from);
  if (!in_range && !(maybe->t > ray->t_min + maybe->t_error && maybe->t < ray->t_max)) return;
  if (j->all) {
    judge_add_open(j, maybe);
    return;
  }
  if (j->doubtful && !(maybe->t < j->maybe.t || (maybe->t == j->maybe.t && maybe->patch < j->maybe.patch))) return;
  j->maybe = *maybe, j->doubtful = true;
  const int most = j->own > JUDGE_MAYBE_WORK ? j->own : JUDGE_MAYBE_WORK;
  if (j->work > most) j->work = most;
  set_limit(j);
}

/* Tells of a place that may be a hit at a root not known to be in its patch: the nearest point of the patch, and its
 * t; or the root's, where that is known to be in the range, which doubles may not tell of the point's. */
static void tell_maybe(struct judge *j, unsigned borders, const struct exact_root *root)
{
  const double u = real_clamp((double)root->u, 0, 1), v = real_clamp((double)root->v, 0, 1);
  const double w = patch_evaluate(j->prepared->x[j->local.axis], u, v).value;
  const bool in_range = root_in_range(j, root) == SIDE_INSIDE, own = root->sharp || in_range;
  double t = (double)root->t, t_error = root->t_error;
  if (!own) {
    t = t_of_depth(&j->local.depth, w);
    t_error += 16 * UNIT_ROUNDOFF * (fabs(t) + fabs(j->local.depth.unit * j->local.depth.to_t));
  }
  const struct exact_maybe maybe = {j->patch, borders, u, v, t, t_error};
  keep_maybe(j, &maybe, own ? least_t(root) : t - t_error, in_range);
}

void judge_maybe(struct judge *j, double u, double v, double t, double t_error, double from)
{
  const struct exact_maybe maybe = {j->patch, 0, u, v, t, t_error};
  keep_maybe(j, &maybe, from, false);
}

void judge_open(struct judge *j, const struct exact_found *border)
{
  judge_turn(j, border->root.patch);
  tell_maybe(j, border->borders, &border->root);
}

/* A control point that is a point of the patch: its place in the net, and its parameters. */
struct net_point {
  int row, column;
  double u, v;
};

/* That of a border that is one point, its middle standing for all of it. */
static struct net_point pole_point(int border)
{
  double at[2];
  edge_place(border, 0.5, at);
  return (struct net_point){edge_at(border, 0) / 4, edge_at(border, 0) % 4, at[0], at[1]};
}

/* That of the corner nearest to the root. */
static struct net_point corner_point(const struct exact_root *root)
{
  const int u = root->u < 0.5 ? 0 : 1, v = root->v < 0.5 ? 0 : 1;
  return (struct net_point){3 * u, 3 * v, u, v};
}

static bool in_corner(unsigned borders) { return borders & 3 && borders & 12; }

/* Sets *out to the root at that point, if the ray meets it exactly; returns whether it does. */
static bool point_root(const struct judge *j, const struct net_point *at, struct exact_root *out)
{
  const struct ray *ray = j->asked->ray;
  const double *point = j->asked->model->scene->patches[j->patch].P[at->row][at->column];
  if (!judge_passes(ray, point)) return false;
  const int k = j->local.axis;
  *out = (struct exact_root){.patch = j->patch,
                             .sharp = true,
                             .well_known = true,
                             .u = at->u,
                             .v = at->v,
                             .t = ((wide)point[k] - ray->origin[k]) / ray->direction[k]};
  /* 0 below 2^-963: there the difference is exact, and no product of a double and d_k is so near to it that the
   * quotient, rounded once, could be on the wrong side of that double. */
  out->t_error = 4 * (double)(WIDE_ROUNDOFF * wide_abs(out->t));
  return true;
}

/* Tells of that root, which lies on those borders, if there is one; returns whether there is. */
static bool tell_point(struct judge *j, const struct net_point *at, unsigned borders)
{
  struct exact_root root;
  if (!point_root(j, at, &root)) return false;
  const enum side in_range = root_in_range(j, &root);
  if (in_range == SIDE_INSIDE && j->all) (void)list_root(j, &root, EXACT_BORDER, borders);
  else if (in_range == SIDE_INSIDE) judge_keep(j, &root);
  if (in_range == SIDE_UNKNOWN) judge_undecided(j, least_t(&root));
  return true;
}

void judge_pole_met(struct judge *j, int border)
{
  const struct net_point at = pole_point(border);
  (void)tell_point(j, &at, 1u << border); /* always */
}

void judge_pole(struct judge *j, int border, double reach)
{
  const struct net_point at = pole_point(border);
  const struct zoom *zoom = judge_zoom(j);
  const double t = (double)((j->prepared->x[zoom->axis][at.row][at.column] - zoom->origin) * zoom->to_t);
  const double t_error = 16 * UNIT_ROUNDOFF * fabs(t) + ZOOM_POLE_REACH * zoom->depth_error * fabs((double)zoom->to_t);
  const struct exact_maybe maybe = {j->patch, 1u << border, at.u, at.v, t, t_error};
  keep_maybe(j, &maybe, t - t_error - reach, false);
}

bool judge_corner(const struct judge *j, unsigned borders, const struct exact_root *root, struct exact_root *out)
{
  const struct net_point at = corner_point(root);
  return in_corner(borders) && point_root(j, &at, out);
}

bool judge_tell_corner(struct judge *j, const struct exact_found *found)
{
  const struct net_point at = corner_point(&found->root);
  return in_corner(found->borders) && tell_point(j, &at, found->borders);
}

/* Whether the root is in a corner in which the ray starts exactly. The corner is a root, and so it is the one found
 * there. */
static bool starts_in_corner(const struct judge *j, unsigned borders, const struct exact_root *root)
{
  struct exact_root corner;
  return judge_corner(j, borders, root, &corner) && root_in_range(j, &corner) == SIDE_OUTSIDE;
}

void judge_root(struct judge *j, struct exact_root *root)
{
  unsigned borders;
  root->patch = j->patch;
  enum side in_patch = root_in_patch(root, &borders), in_range = root_in_range(j, root);
  if ((double)root->t - root->t_error > j->limit || in_patch == SIDE_OUTSIDE || in_range == SIDE_OUTSIDE) return;
  if (in_patch == SIDE_UNKNOWN || in_range == SIDE_UNKNOWN) {
    if (!judge_sharpen(j, root)) {
      tell_maybe(j, borders, root);
      return;
    }
    in_patch = root_in_patch(root, &borders), in_range = root_in_range(j, root);
    if (in_patch == SIDE_OUTSIDE || in_range == SIDE_OUTSIDE) return;
  }
  if (in_range == SIDE_UNKNOWN) {
    /* Whether a ray that starts on the surface meets it cannot be told, except at a control point. */
    if (!starts_in_corner(j, borders, root)) judge_undecided(j, least_t(root));
  } else if (in_patch == SIDE_INSIDE) {
    judge_keep(j, root);
  } else if (!list_root(j, root, EXACT_BORDER, borders)) {
    tell_maybe(j, borders, root);
  }
}

/* ---- the case ---- */

void judge_run(struct judge *j, const struct exact_case *asked, bool all, struct exact_list *list)
{
  *j = (struct judge){.asked = asked,
                      .all = all,
                      .list = list,
                      .work = asked->limit < JUDGE_WORK ? (int)asked->limit : JUDGE_WORK,
                      .undecided = INFINITY,
                      .tied_from = INFINITY,
                      .patch = UINT32_MAX};
  if (!all) {
    j->undecided = asked->cut_from;
    if (asked->known) add_rival(j, asked->known);
  }
  set_limit(j);
  if (!all && asked->maybe) keep_maybe(j, asked->maybe, asked->maybe->t, false);
  judge_search(j);
}

/* The nearest hit. */
static void nearest_run(struct judge *j, const struct exact_case *asked)
{
  struct exact_found borders[JUDGE_BORDERS_MAX];
  struct exact_list list = {.at = borders, .room = JUDGE_BORDERS_MAX, .fixed = true};
  judge_run(j, asked, false, &list);
  judge_settle_borders(j);
}

void exact_closest(const struct exact_case *asked, struct exact_decision *out)
{
  struct judge j;
  nearest_run(&j, asked);
  /* How accurately the nearest is known depends on what it was found beside. */
  if (j.rivals > 0 && !(j.undecided > most_t(&j.nearest))) judge_improve(&j, &j.nearest);
  const double to = j.rivals > 0 ? most_t(&j.nearest) : INFINITY;
  *out = (struct exact_decision){.verdict = EXACT_MISS, .sure = j.undecided > to || j.undecided == INFINITY};
  if (j.doubtful && !(j.rivals > 0 && j.nearest.t <= j.maybe.t))
    *out = (struct exact_decision){.verdict = EXACT_MAYBE, .maybe = j.maybe};
  else if (j.rivals > 0) out->verdict = EXACT_ROOT, out->root = j.nearest, out->sure &= j.tied_from > to;
}

bool exact_occluded(const struct exact_case *asked)
{
  struct judge j;
  nearest_run(&j, asked);
  return j.rivals > 0 || j.doubtful || j.cut_short;
}
