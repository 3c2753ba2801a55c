/* What is found on one ray becomes its answer: the order of roots, the ray's start and end.
 *
 * A root counts where it lies in its patch and within the ray's range. Where double precision cannot tell, it is made
 * as good as wide arithmetic can. One that even then lies on a border is put on a list, for borders.c to settle.
 */
#include "intersect/exact/judge.h"

#include <math.h>

#include "base/real.h"
#include "geometry/patch.h"

/* Work that may be done for one ray, by whichever regions ask for it: isolated roots and folds need some tens, rays that
 * pass a pole or start there some hundreds; only surfaces that lie along the ray over an area, and start where it does,
 * come there. */
enum { JUDGE_WORK = 2560 };

/* Where something may be a hit no more than so much is done in its region, or what that has for itself, as the others have then
 * (regions.c), in whatever order they come: most answers are grazing then, whatever else is found. */
enum { JUDGE_MAYBE_WORK = 128 };

/* Has the ray look straight across the plane that the patch lies in, where it starts exactly there and leaves it, be it ever so
 * slowly: it meets that at 0 and nowhere else, and whether there on the patch depends on its start alone. */
static void look_across(const struct model *model, uint32_t patch, struct ray *ray)
{
  const struct flat_plane *plane = model_flat_plane(model, patch);
  if (!plane) return;
  const double away = ray->direction[plane->axis];
  if (ray->origin[plane->axis] != plane->value || away == 0) return;
  for (int k = 0; k < 3; k++) ray->direction[k] = 0;
  ray->direction[plane->axis] = copysign(1, away);
}

void judge_turn(struct judge *j, uint32_t patch)
{
  if (j->patch == patch) return;
  j->patch = patch, j->zoomed = false;
  j->prepared = model_patch_at(j->asked->model, patch, &j->room);
  j->ray = *j->asked->ray;
  look_across(j->asked->model, patch, &j->ray);
  local_ray_make(j->prepared, &j->ray, &j->local);
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

/* On which side of a border at 0 x is, known to within `error`; inside is above. */
static enum side side_of(wide x, double error)
{
  return x > error ? SIDE_INSIDE : x < -error ? SIDE_OUTSIDE : SIDE_UNKNOWN;
}

/* A root farther from a border than this, and its radius, is on the same side when it is rounded to double. */
#define CLEARLY 0x1p-40

/* Of the root in its patch; *borders: those that it cannot be told from. */
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

/* Of the root between the ray's start and its end, which do not belong to it: what is known exactly is on one side. */
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

/* Nothing beyond the nearest hit matters, nor where a nearer one would be as doubtful as what is there. */
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

/* The least and the largest t that the root can have. */
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

/* Whether the first of two rivals is nearest wherever the second could be: it stands before it, and what it is behind the second
 * is behind as well. */
static bool stands_for(const struct exact_root *a, const struct exact_root *b)
{
  return judge_stands_before(a, b) && a->t - a->t_error <= b->t - b->t_error;
}

/* There is one rival too many. Left out is one that another one stands for, but not the one that ends first: what it is not
 * behind no other one tells. Where there is none, one may be left out that would have been the nearest. */
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
    (void)list_root(j, root, EXACT_INSIDE, 0); /* or the list has failed */
    return;
  }
  struct exact_root *at = j->rival;
  for (size_t k = 0; k < j->rivals; k++)
    if (root->patch == at[k].patch && exact_roots_meet(root, &at[k])) return;
  for (size_t k = 0; k < j->rivals; k++)
    if (judge_tie(root, &at[k])) judge_improve(j, &at[k]), judge_improve(j, root);
  judge_turn(j, root->patch); /* whose region is being searched */
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

/* `from`: where along the ray what may be a hit begins. `in_range`: its t is proven to be the ray's, though that may be so near
 * to an end that its double is not. */
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

/* What may be a hit at a root that is not known to be in its patch: the point next to it, and its place on the ray. */
static void tell_maybe(struct judge *j, unsigned borders, const struct exact_root *root)
{
  const double u = real_clamp((double)root->u, 0, 1), v = real_clamp((double)root->v, 0, 1);
  const double w = patch_evaluate(j->prepared->x[j->local.axis], u, v).value;
  double t = (double)root->t, t_error = root->t_error;
  if (!root->sharp) {
    t = t_of_depth(&j->local.depth, w);
    t_error += 16 * UNIT_ROUNDOFF * (fabs(t) + fabs(j->local.depth.unit * j->local.depth.to_t));
  }
  const struct exact_maybe maybe = {j->patch, borders, u, v, t, t_error};
  keep_maybe(j, &maybe, root->sharp ? least_t(root) : t - t_error,
             root->sharp && root_in_range(j, root) == SIDE_INSIDE);
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

/* A control point that is a point of the patch: where it stands in the net, and its parameters. */
struct net_point {
  int row, column;
  double u, v;
};

/* Of a border that is one point, the middle standing for all of it. */
static struct net_point pole_point(int border)
{
  double at[2];
  edge_place(border, 0.5, at);
  return (struct net_point){edge_at(border, 0) / 4, edge_at(border, 0) % 4, at[0], at[1]};
}

/* The corner next to the root. */
static struct net_point corner_point(const struct exact_root *root)
{
  const int u = root->u < 0.5 ? 0 : 1, v = root->v < 0.5 ? 0 : 1;
  return (struct net_point){3 * u, 3 * v, u, v};
}

static bool in_corner(unsigned borders) { return borders & 3 && borders & 12; }

/* The root at that point, where the ray meets it exactly: whether it does. */
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
  /* 0 below 2^-963: there the difference is exact, and no product of a double and d_k is so near to it that the quotient,
   * rounded once, is not on its own side of that double. */
  out->t_error = 4 * (double)(WIDE_ROUNDOFF * wide_abs(out->t));
  return true;
}

/* Tells of that root, which lies on those borders, if there is one; whether there is. */
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

bool judge_pole(struct judge *j, int border, double reach)
{
  const struct net_point at = pole_point(border);
  if (tell_point(j, &at, 1u << border)) return true;
  const struct zoom *zoom = judge_zoom(j);
  const double t = (double)((j->prepared->x[zoom->axis][at.row][at.column] - zoom->origin) * zoom->to_t);
  const double t_error = 16 * UNIT_ROUNDOFF * fabs(t) + ZOOM_POLE_REACH * zoom->depth_error * fabs((double)zoom->to_t);
  const struct exact_maybe maybe = {j->patch, 1u << border, at.u, at.v, t, t_error};
  keep_maybe(j, &maybe, t - t_error - reach, false);
  return false;
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

/* Whether the root is in a corner where the ray starts, exactly: the corner is a root, and so the one that is there. */
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
    /* Nobody can tell whether a ray that starts on the surface meets it, but at a control point. */
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
                      .work = JUDGE_WORK,
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
  /* How well the nearest is known depends on what it was found beside. */
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
