/* Finds all that a ray may meet in a region of a patch, by recursive halving.
 *
 * A box of parameters is dropped if some linear combination of the two plane polynomials keeps one sign on it (the
 * convex hull property), solved if the certificate finds a root that is alone in it, decided by its fold if it has one
 * (touch.c), and otherwise halved. The box that begins first along the ray is next; those behind the nearest hit so far
 * are dropped.
 *
 * If a combination is indistinguishable from zero on a box, the surface is seen edge-on there, to within about 1e-7 of
 * tangency. The box is then searched by itself, with polynomials that are made for it in fixed point (zoom.h), which
 * scales up what was too small. If some combination is zero even there, and so all over the patch, the ray lies in the
 * plane of a flat patch, or nearly, and meets curves; their first points lie on borders of boxes (curves.h). The judge
 * is told as undecided what even that leaves (a double root, a ray in the surface), and poles that are met only as far
 * as wide arithmetic can tell (pole.c). docs/method.md, "The numbers of the last resort", explains how these constants,
 * those of pole.c and those of zoomed boxes fit together.
 */
#include "intersect/exact/search.h"

#include <math.h>
#include <string.h>

#include "base/real.h"
#include "geometry/patch.h"
#include "intersect/exact/curves.h"
#include "intersect/prepare/leaf.h"

/* The fraction of the patch's extent below which an undecidable box is not halved further: UNDECIDED_ERRORS of some
 * hundred roundings each, the distance from the ray within which the planes tell nothing. */
#define SEARCH_RESOLUTION 0x1p-44

/* The most halvings of a box: down to LEAST_SIZE of the whole box both ways. */
enum { SEARCH_HALVINGS = 104 };
#define LEAST_SIZE 0x1p-52

/* The most boxes that may wait in the order in which the ray comes to them: at first, and if zoomed. Beyond that, boxes
 * wait only in the order of halving, so there are no more of them than one box can have halvings. */
enum { SEARCH_AHEAD = 128, CLOSER_AHEAD = 64, SEARCH_STACK = SEARCH_HALVINGS + 2 };

/* A box is zoomed again if it is this small a part, by area, of the last window, and at most this often, one within the
 * other. Poles have their own numbers (pole.c). */
#define ZOOM_AGAIN 0x1p-16
enum { TANGENT_DEPTH = 4 };

/* Each halving adds three additions, on values of the whole box's size, to the rounding of a coefficient. */
void search_rounding(const struct search *s, const struct box *box, double out[2])
{
  for (int k = 0; k < 2; k++) out[k] = s->error[k] + box->halvings * 4 * UNIT_ROUNDOFF;
}

/* The same, with what a met pole adds from the distance on at which roots are told. */
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
  /* If no point of the box is found on the ray, or one at the ray's start, the box may still hold a hit; any-hit
   * queries are told so. */
  if (!small && box->far > s->window.judge->asked->ray->t_min + s->resolution) s->window.judge->cut_short = true;
  if (!box_onto_ray(box, error, &u, &v) && !small) return;
  const double t = t_of_depth(&s->window.depth, patch_evaluate(box->net[2], u, v).value);
  window_tell_maybe(&s->window, box, u, v, t, real_min(box->far - box->near, s->resolution));
}

/* Halves across the parameter along which the box is longer as seen along the ray. Hull tests and Newton's method need
 * this: at a tangency boxes become long along the ray and narrow across it. A box seen as a point is halved across the
 * parameter along which it is longer on the ray; if the polynomials are dependent, across the one along which it is
 * longer in space. */
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
  window_set_reach(&closer->window, &whole);
  search_run(closer, &whole, waiting);
}

/* Searches the box by itself, zoomed. Returns whether that was possible. */
static bool box_zoom(struct search *s, const struct box *box)
{
  struct search closer = search_closer(s, box);
  struct zoomed zoomed;
  int zeros[4];
  const bool met = pole_zeros(s, box, zeros);
  judge_spend(s->window.judge, WORK_ZOOM);
  const int known = zoom_box(judge_zoom(s->window.judge), closer.window.low, closer.window.size, zeros, &zoomed);
  closer.dependent = known < 2;
  if (known < (met ? 1 : 2)) {
    s->dependent = true;
    return false;
  }
  search_run_closer(&closer, &zoomed);
  return true;
}

/* Searches a box at poles that the ray meets exactly by itself, zoomed: there both polynomials are divided by the
 * distance from the poles. Returns whether it did. */
static bool box_zoom_met(struct search *s, const struct box *box)
{
  int zeros[4];
  if (s->window.zooms > 0 || s->dependent || !pole_zeros(s, box, zeros)) return false;
  for (int k = 0; k < 4; k++)
    if (zeros[k] > 0) judge_pole_met(s->window.judge, k);
  return box_zoom(s, box);
}

/* Whether to zoom a box that double precision cannot decide. If a combination is flat on it: once, and again when it is
 * a small part of the last window, because roots next to a tangency are as far apart as the square root of the ray's
 * distance from it. If only a bent combination is flat: when the box is that small both ways, because long boxes become
 * flat. */
static bool box_asks_zoom(const struct search *s, const struct box *box, bool flat)
{
  if (s->dependent) return false;
  if (s->divided != NO_BORDER) return flat && s->window.zooms == 1;
  if (flat && s->window.zooms == 0) return true;
  const double longer = real_max(box->size_u, box->size_v), part = flat ? box->size_u * box->size_v : longer * longer;
  return s->window.zooms < TANGENT_DEPTH && part <= ZOOM_AGAIN;
}

/* Whether to zoom again a box whose root is proven but not placed well: rounding in a zoomed window is relative to its
 * size, and the box may be a small part of it. A root found without zoom goes to the judge, who has it sharpened. */
static bool root_asks_zoom(const struct search *s, const struct exact_root *root, int border)
{
  return !exact_root_placed(root) && border == NO_BORDER && s->window.zooms > 0 && s->window.zooms < TANGENT_DEPTH;
}

/* Whether the box is small enough to be told as undecided: along the ray, and in all directions or at least as seen. */
static bool box_small(const struct search *s, const struct box *box, enum verdict verdict)
{
  return box->far - box->near <= s->resolution &&
         (verdict == VERDICT_POINT || s->extent[0] * box->size_u + s->extent[1] * box->size_v <= SEARCH_RESOLUTION);
}

/* Where a curve crosses a side of a box aslant, the place is known no better than the polynomial's error over the
 * slant, on small boxes as on large ones. Down to a slant of about 1 : FLAT_SLANT, as of ties, it is told with that
 * error; what is flatter is halved until all of a side is on the ray as far as can be told. */
#define FLAT_SLANT 256

/* Tries to decide the box where the two polynomials are one and the ray meets curves. The first point on them may be a
 * hit. If it lies before the ray's start, the point just after the start takes its place, or halving goes on. */
static bool box_flat(struct search *s, struct box *box, const double error[2])
{
  double u = 0, v = 0, off = 0;
  const enum curves curves = curves_begin(box, error, s->window.depth.to_t < 0 ? -1 : 1, &u, &v, &off);
  if (curves != CURVES_BEGIN) return curves == CURVES_NONE;
  const double t_error = real_max(window_length(&s->window, off), s->resolution);
  if (!(t_error <= FLAT_SLANT * s->resolution)) return false;
  const struct ray *ray = s->window.judge->asked->ray;
  const double begin = ray->t_min + t_error;
  double t = t_of_depth(&s->window.depth, patch_evaluate(box->net[2], u, v).value);
  if (!(t > begin)) {
    if (!curves_at(box, error, depth_of_t(&s->window.depth, begin + t_error), &u, &v)) return false;
    t = t_of_depth(&s->window.depth, patch_evaluate(box->net[2], u, v).value);
    if (!(t > begin && t < ray->t_max)) return false;
  }
  window_tell_maybe(&s->window, box, u, v, t, t_error);
  return true;
}

/* Returns whether nothing is left to do with the box. */
static bool box_decide(struct search *s, struct box *box)
{
  if (box->near > s->window.judge->limit || box->far < s->window.judge->asked->ray->t_min) return true;
  const int border = pole_of_box(s, box);
  if (s->met && border == s->divided) {
    const enum pole_box pole = pole_decide(s, box);
    if (pole != POLE_BOX_OPEN) return pole == POLE_BOX_DECIDED;
  }
  if (box_zoom_met(s, box) || pole_zoom(s, box, border)) return true;
  double error[2];
  search_box_error(s, box, error);
  const enum verdict verdict = box_test(box, error);
  if (verdict == VERDICT_EMPTY || (s->dependent && box_flat(s, box, error))) return true;
  double root[2] = {0.5, 0.5}, radius[2];
  if (verdict == VERDICT_OPEN && box_solve(box, error, true, root, radius)) {
    struct exact_root found = window_root(&s->window, box, root, radius);
    const bool far = pole_far(s, box, root), zoomed = far ? root_asks_zoom(s, &found, border) : pole_asks_zoom(s, box);
    if (zoomed && box_zoom(s, box)) return true;
    if (far) {
      judge_root(s->window.judge, &found);
      return true;
    }
  }
  bool bent_flat = false;
  if (!s->dependent && window_touched(&s->window, box, error, s->window.zooms == 0 && border == NO_BORDER, &bent_flat))
    return true;
  const bool flat = verdict != VERDICT_OPEN, small = flat && box_small(s, box, verdict);
  const bool zoomed = (flat || bent_flat) && (box_asks_zoom(s, box, flat) || (!s->dependent && pole_asks_zoom(s, box)));
  if (zoomed && border == NO_BORDER && box_zoom(s, box)) return true;
  if (!small && box->halvings < SEARCH_HALVINGS) return false;
  search_tell_maybe(s, box, small);
  return true;
}

/* The next box to examine: the one that begins first along the ray; the last of those that begin at one place. */
static int next_box(const struct search *s, const struct box waiting[], int count)
{
  int next = count - 1;
  double before = waiting[next].near - s->resolution;
  for (int n = next; n-- > 0 && count <= s->ahead;)
    if (waiting[n].near < before) next = n, before = waiting[n].near - s->resolution;
  return next;
}

/* Searches the box `whole`, which is set, as is all that the search starts with. waiting: room for s->ahead and
 * SEARCH_STACK boxes. */
static void search_run(struct search *s, const struct box *whole, struct box waiting[])
{
  waiting[0] = *whole;
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

/* Whether the region is a leaf of its patch, kept or not. */
static bool is_leaf(const struct model *model, const struct exact_region *region)
{
  return region->span[0] == 1 && region->span[1] == 1 && !model->cuts[region->patch].copied;
}

/* Sets the search of a region, and its whole box. */
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
