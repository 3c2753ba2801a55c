/* All that a ray may meet in a region of a patch, by recursive halving.
 *
 * A box of parameters is dropped where some linear combination of the two plane polynomials keeps one sign on it
 * (the convex hull property), solved where the certificate finds a root that is alone in it, and halved otherwise.
 * The box that begins first along the ray is next, and those behind the nearest hit so far are dropped. Where a
 * combination is indistinguishable from zero on a box, the surface is seen edge-on there, nearer to tangency than about
 * 1e-7: a fold is looked for (touch.c), and else the box is searched by itself, with polynomials made for it in fixed
 * point (zoom.h), which scales what is too small to tell. Where some combination is zero even there, all over
 * the patch, the ray lies in the plane of a flat patch, or as good as that, and meets curves: what comes first on them lies
 * on borders of boxes (curves.h). What even that leaves (a double root, a ray in the surface), and poles met exactly
 * (pole.c), are told to the judge as undecided. docs/method.md, "The numbers of the last resort", says how the constants
 * here, there and of zoomed boxes fit together.
 */
#include "intersect/exact/search.h"

#include <math.h>
#include <string.h>

#include "base/real.h"
#include "geometry/patch.h"
#include "intersect/exact/curves.h"
#include "intersect/prepare/leaf.h"

/* The fraction of the patch's extent below which an undecidable box is not halved further: UNDECIDED_ERRORS of some
 * hundred roundings each, the distance from the ray at which the planes tell nothing any more. */
#define SEARCH_RESOLUTION 0x1p-44

/* How often a box may halve in all: LEAST_SIZE of the whole box either way. */
enum { SEARCH_HALVINGS = 104 };
#define LEAST_SIZE 0x1p-52

/* So many boxes may wait to be looked at in the order in which the ray comes to them: at first, and zoomed. More
 * than these wait only in the order of halving, and so no more than one box can be halved. */
enum { SEARCH_AHEAD = 128, CLOSER_AHEAD = 64, SEARCH_STACK = SEARCH_HALVINGS + 2 };

/* A box is zoomed again where it is so small a part of what was, and so often, one in the other. Poles have
 * their own numbers (pole.c). */
#define ZOOM_AGAIN 0x1p-16
enum { TANGENT_DEPTH = 4 };

/* The bound on rounding in a coefficient of the box's nets: each halving adds three additions on values of the
 * whole box's size. */
void search_rounding(const struct search *s, const struct box *box, double out[2])
{
  for (int k = 0; k < 2; k++) out[k] = s->error[k] + box->halvings * 4 * UNIT_ROUNDOFF;
}

/* The same with that, at a pole that is met from where roots are told. */
static void search_box_error(const struct search *s, const struct box *box, double out[2])
{
  search_rounding(s, box, out);
  if (s->met) pole_add_error(s, pole_told_from(s, box), out);
}

void search_tell_maybe(struct search *s, struct box *box, bool small)
{
  double u = 0.5, v = 0.5, error[2];
  search_box_error(s, box, error);
  if (!small) judge_undecided(s->window.judge, box->near);
  /* Where no point of it is found on the ray, or one at the start, it may hold a hit: what asks for any is told. */
  if (!small && box->far > s->window.judge->asked->ray->t_min + s->resolution) s->window.judge->cut_short = true;
  if (!box_onto_ray(box, error, &u, &v) && !small) return;
  const double t = t_of_depth(&s->window.depth, patch_evaluate(box->net[2], u, v).value);
  window_tell_maybe(&s->window, box, u, v, t, real_min(box->far - box->near, s->resolution));
}

/* Halves across the parameter along which the box is longer as seen along the ray, for that is what hull tests and
 * Newton's method need: at a tangency boxes get long along the ray and narrow across it. Where it is seen as a
 * point, across the one along which it is longer on the ray; and where the polynomials are dependent, in space. */
static void box_halve(const struct search *s, struct box *box, struct box out[2])
{
  double along_u, along_v, error[2];
  box_variation(box, 0, 1, &along_u, &along_v);
  search_box_error(s, box, error);
  if (real_max(along_u, along_v) <= FLAT_ERRORS * real_max(error[0], error[1]))
    box_variation(box, 2, 2, &along_u, &along_v);
  bool across_u = along_u == along_v ? box->size_u >= box->size_v : along_u > along_v;
  if (pole_narrow(s, box)) across_u = s->divided < 2;
  if (s->dependent) across_u = s->extent[0] * box->size_u >= s->extent[1] * box->size_v;
  if (across_u ? box->size_u <= LEAST_SIZE : box->size_v <= LEAST_SIZE) across_u = !across_u;
  box_cut(box, across_u, out);
  for (int h = 0; h < 2; h++) window_set_reach(&s->window, &out[h]);
}

static void search_run(struct search *s, const struct box *whole, struct box waiting[]);

struct search search_closer(const struct search *s, const struct box *box)
{
  struct search closer = {.window = window_closer(&s->window, box),
                          .ahead = s->window.judge->all ? 0 : CLOSER_AHEAD,
                          .divided = NO_BORDER,
                          .resolution = s->resolution};
  closer.extent[0] = s->extent[0] * box->size_u, closer.extent[1] = s->extent[1] * box->size_v;
  closer.pole[0] = s->pole[0] && box->u == 0, closer.pole[1] = s->pole[1] && box->u + box->size_u == 1;
  closer.pole[2] = s->pole[2] && box->v == 0, closer.pole[3] = s->pole[3] && box->v + box->size_v == 1;
  return closer;
}

void search_run_closer(struct search *closer, const struct zoomed *zoomed)
{
  window_set_depths(&closer->window, zoomed);
  for (int k = 0; k < 2; k++) closer->error[k] = zoomed->error[k];
  struct box whole = {.u = 0, .v = 0, .size_u = 1, .size_v = 1, .halvings = 0}, waiting[CLOSER_AHEAD + SEARCH_STACK];
  memcpy(whole.net, zoomed->net, sizeof whole.net);
  search_run(closer, &whole, waiting);
}

/* Searches the box by itself, zoomed. Returns whether that could be done. */
static bool box_zoom(struct search *s, const struct box *box)
{
  struct search closer = search_closer(s, box);
  struct zoomed zoomed;
  judge_spend(s->window.judge, WORK_ZOOM);
  if (!zoom_box(judge_zoom(s->window.judge), closer.window.low, closer.window.size, &zoomed)) {
    s->dependent = true;
    return false;
  }
  search_run_closer(&closer, &zoomed);
  return true;
}

/* Whether a box that double precision cannot decide is to be zoomed: one that a combination is flat on once, and again where
 * it is a small part of what was, for the roots next to a tangency are as far apart as the square root of what separates it
 * from one; a bent one, on which there is none yet, where it is as small either way: long ones become flat. */
static bool box_asks_zoom(const struct search *s, const struct box *box, bool flat)
{
  if (s->dependent) return false;
  if (s->divided != NO_BORDER) return flat && s->window.zooms == 1;
  if (flat && s->window.zooms == 0) return true;
  const double longer = real_max(box->size_u, box->size_v), part = flat ? box->size_u * box->size_v : longer * longer;
  return s->window.zooms < TANGENT_DEPTH && part <= ZOOM_AGAIN;
}

/* Whether a box whose root is proven, but not placed well, is to be zoomed again for that: what is zoomed is rounded by the size of
 * its whole, of which the box may be a small part. A root that was not zoomed is the judge's, who has it made sharp. */
static bool root_asks_zoom(const struct search *s, const struct exact_root *root, int border)
{
  return !exact_root_placed(root) && border == NO_BORDER && s->window.zooms > 0 && s->window.zooms < TANGENT_DEPTH;
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
  const enum curves curves = curves_begin(box, error, s->window.depth.to_t < 0 ? -1 : 1, &u, &v, &off);
  if (curves != CURVES_BEGIN) return curves == CURVES_NONE;
  if (!(window_length(&s->window, off) <= s->resolution)) return false;
  const struct ray *ray = s->window.judge->asked->ray;
  const double begin = ray->t_min + s->resolution;
  double t = t_of_depth(&s->window.depth, patch_evaluate(box->net[2], u, v).value);
  if (!(t > begin)) {
    if (!curves_at(box, error, depth_of_t(&s->window.depth, begin + s->resolution), &u, &v)) return false;
    t = t_of_depth(&s->window.depth, patch_evaluate(box->net[2], u, v).value);
    if (!(t > begin && t < ray->t_max)) return false;
  }
  window_tell_maybe(&s->window, box, u, v, t, s->resolution);
  return true;
}

/* Decides the box: true where nothing is left to do with it. */
static bool box_decide(struct search *s, struct box *box)
{
  if (box->near > s->window.judge->limit || box->far < s->window.judge->asked->ray->t_min) return true;
  const int border = pole_of_box(s, box);
  if (s->met && border == s->divided) {
    const enum pole_box pole = pole_decide(s, box);
    if (pole != POLE_BOX_OPEN) return pole == POLE_BOX_DECIDED;
  }
  if (pole_zoom(s, box, border)) return true;
  double error[2];
  search_box_error(s, box, error);
  const enum verdict verdict = box_test(box, error);
  if (verdict == VERDICT_EMPTY || (s->dependent && s->window.zooms == 0 && box_flat(s, box, error))) return true;
  double root[2] = {0.5, 0.5}, radius[2];
  if (verdict == VERDICT_OPEN && box_solve(box, error, true, root, radius) && pole_far(s, box, root)) {
    struct exact_root found = window_root(&s->window, box, root, radius);
    if (root_asks_zoom(s, &found, border) && box_zoom(s, box)) return true;
    judge_root(s->window.judge, &found);
    return true;
  }
  bool bent_flat = false;
  if (!s->dependent && window_touched(&s->window, box, error, s->window.zooms == 0 && border == NO_BORDER, &bent_flat))
    return true;
  const bool flat = verdict != VERDICT_OPEN, small = flat && box_small(s, box, verdict);
  if ((flat || bent_flat) && box_asks_zoom(s, box, flat) && border == NO_BORDER && box_zoom(s, box)) return true;
  if (!small && box->halvings < SEARCH_HALVINGS) return false;
  search_tell_maybe(s, box, small);
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
  window_set_reach(&s->window, &waiting[0]);
  for (int count = 1; count > 0;) {
    const int next = next_box(s, waiting, count);
    struct box box = waiting[next];
    waiting[next] = waiting[--count];
    judge_spend(s->window.judge, 1);
    const bool decided = box_decide(s, &box);
    if (decided) continue;
    if (s->window.judge->work <= 0) {
      search_tell_maybe(s, &box, false);
      while (count-- > 0)
        if (waiting[count].near <= s->window.judge->limit) search_tell_maybe(s, &waiting[count], false);
      return;
    }
    box_halve(s, &box, &waiting[count]);
    count += 2;
  }
}

/* Whether the region is a leaf, kept or not. */
static bool is_leaf(const struct model *model, const struct exact_region *region)
{
  return region->span[0] == 1 && region->span[1] == 1 && !model->cuts[region->patch].copied;
}

/* The search of a region, and its whole box. */
static void search_begin(struct judge *j, const struct exact_region *region, struct search *s, struct box *whole)
{
  struct model_patch *patch = j->prepared;
  const struct local_ray *ray = &j->local;
  struct patch_part part;
  if (region->leaf) {
    memcpy(part.x, region->leaf->x, sizeof part.x), memcpy(part.first, region->leaf->first, sizeof part.first);
  } else {
    const struct part_grid grid = {{patch->cut.split[0], patch->cut.split[1]},
                                   {region->span[0], region->span[1]},
                                   is_leaf(j->asked->model, region) ? LEAF_MARGIN : 0};
    patch_parts(patch, &grid, 1, (const uint16_t(*)[2])region->column, &part);
  }
  const int leaves = patch->cut.split[0] * patch->cut.split[1];
  const double cut = split_is_exact(leaves) ? 0 : 2 * CUT_ERROR; /* in x_i and slope x_k */
  *s = (struct search){.window = window_of_region(j, region),
                       .extent = {part.first[0], part.first[1]},
                       .ahead = j->all ? 0 : SEARCH_AHEAD,
                       .divided = NO_BORDER,
                       .error = {ray->error + cut, ray->error + cut}};
  for (int k = 0; k < 4; k++) s->pole[k] = leaf_border_is_point(patch, region->column, region->span, k);
  double nets[3][16];
  local_ray_nets(ray, part.x, nets[0], nets[1], nets[2]);
  *whole = (struct box){.u = 0, .v = 0, .size_u = 1, .size_v = 1, .halvings = 0};
  memcpy(whole->net, nets, sizeof nets);
  window_set_reach(&s->window, whole);
  const double slack = window_length(&s->window, s->window.depth_error) +
                       8 * UNIT_ROUNDOFF * real_max(fabs(whole->near), fabs(whole->far));
  s->resolution = real_max((whole->far - whole->near) * SEARCH_RESOLUTION, 4 * slack);
  whole->near = real_max(whole->near, region->near);
}

void search_region(struct judge *j, const struct exact_region *region)
{
  struct search search;
  struct box whole, waiting[SEARCH_AHEAD + SEARCH_STACK];
  search_begin(j, region, &search, &whole);
  if (j->work > 0) search_run(&search, &whole, waiting);
  else search_tell_maybe(&search, &whole, false);
}
