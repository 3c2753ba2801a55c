/* One patch of the scene: its frame, its true degree, how far it is cut. See patch.h. */
#include "intersect/prepare/patch.h"

#include <math.h>

#include "base/real.h"
#include "geometry/patch.h"
#include "geometry/vector.h"
#include "intersect/exact/exact.h"
#include "intersect/prepare/leaf.h"

/* A declared control point carries half a unit in the last place from its decimal form and a few from its transforms. A
 * patch whose excess over a lower degree is at most this, relative to its largest coordinate, was meant to be of that
 * degree. */
#define DEGREE_SLACK (8 * UNIT_ROUNDOFF)

/* A slender patch is more than SLENDER times as long as wide, however much more. All of its leaves may lie in the plane
 * of a ray, and exact.h must have room for them. */
#define SLENDER 16.0
enum { SLENDER_SPLIT_MAX = EXACT_REGIONS_MAX / 2 };

/* A long patch is this many times as long as wide. If it bends across, as a pipe's quarter does, it is cut into up to
 * ROD_SPLIT_MAX leaves either way. Choices of speed. */
#define LONG 4.0
enum { ROD_SPLIT_MAX = 2 };

/* The box of a long leaf aslant to the axes is mostly air. A long patch is cut along as long as that leaves no more
 * than this part of its boxes' surface, by which the visits of rays grow. A choice of speed. */
#define LESS_AIR (2.0 / 3)

/* A patch's frame is no smaller than this, so that its reciprocal and all products with it are normal numbers. */
#define LEAST_SCALE 0x1p-1000

/* Sets the patch's frame and net. `rest` gets what rounding the net takes away, *rounded whether that is anything.
 * Returns the largest |coordinate| in the scene. */
static double patch_frame(const double P[4][4][3], double scene_size, struct model_patch *out, double rest[3][4][4],
                          bool *rounded)
{
  double largest = 0, extent = 0, lo[3], hi[3];
  points_range(P, lo, hi);
  for (int k = 0; k < 3; k++) {
    extent = real_max(extent, hi[k] / 2 - lo[k] / 2);
    largest = real_max(largest, real_max(fabs(lo[k]), fabs(hi[k])));
  }
  if (scene_size > 0)
    extent = real_max(extent, real_max(LEAST_EXTENT * (largest > 0 ? largest : scene_size), LEAST_SCALE));
  int exponent = 0;                             /* if all of the scene is the origin, any scale will do */
  if (extent > 0) frexp(extent, &exponent);     /* extent < 2^exponent */
  out->scale = real_power_of_two(exponent + 1); /* the center may be a grain off the middle */
  for (int k = 0; k < 3; k++) {
    const double middle = lo[k] / 2 + hi[k] / 2, grain = out->scale / 4;
    out->center[k] = fabs(middle) < grain * 0x1p50 ? real_coarse(middle, grain) : middle;
  }
  *rounded = points_frame(P, out->center, 1 / out->scale, out->x, rest);
  return largest;
}

/* Whether nearly all leaves of a patch that is cut into `split` a side turn by more than `turn`, judged by some larger
 * parts of it. If only some do, more leaves cost all rays more than they save the rays that meet these. Choices of
 * speed. */
enum { PARTS_MOST = 8 };
#define NEARLY_ALL 0.84

static bool turns_far(const struct model_patch *patch, double turn, int split)
{
  const int parts = split < PARTS_MOST ? split : PARTS_MOST, all = parts * parts;
  const struct part_grid grid = {{(uint16_t)parts, (uint16_t)parts}, {1, 1}, 0};
  uint16_t column[PARTS_MOST * PARTS_MOST][2];
  struct patch_part part[PARTS_MOST * PARTS_MOST];
  for (int n = 0; n < all; n++) column[n][0] = (uint16_t)(n / parts), column[n][1] = (uint16_t)(n % parts);
  patch_parts(patch, &grid, (size_t)all, (const uint16_t(*)[2])column, part);
  int far = 0;
  for (int n = 0; n < all; n++)
    far += turn_of(part[n].second) * parts > turn * split * real_max(part[n].first[0], part[n].first[1]);
  return far > NEARLY_ALL * all;
}

/* How many leaves make every leaf nearly flat relative to its long side: second derivatives fall with the square of
 * that number, first ones with the number. A slender patch is cut along its long side until its leaves turn as little
 * as the short side demands or are no longer slender. */
static void split_along(const struct model_patch *patch, const struct split_limit *limit,
                        const struct patch_part *whole, uint16_t split[2])
{
  const double turn = turn_of(whole->second);
  const int side = whole->first[1] > whole->first[0];
  const double along = whole->first[side], across = whole->first[1 - side], bend = whole->second[2 * side];
  split[0] = split[1] = 1;
  if (along > SLENDER * across) {
    uint16_t *cut = &split[side];
    while (2 * *cut <= limit->any * limit->any && 2 * *cut <= SLENDER_SPLIT_MAX && along > 2 * *cut * across &&
           bend / *cut + 2 * whole->second[1] > 2 * limit->turn * *cut * across)
      *cut = (uint16_t)(2 * *cut);
    return;
  }
  int most = limit->any;
  while (split[0] < most && turn > limit->turn * split[0] * along) {
    split[0] = (uint16_t)(2 * split[0]);
    if (split[0] == limit->any && limit->bent > limit->any && turns_far(patch, limit->turn, split[0]))
      most = limit->bent;
  }
  split[1] = split[0];
}

/* How many leaves a side a rod's side needs at least, because what bends across it turns relative to its short side; 1
 * for other patches. */
static int rod_split(const struct split_limit *limit, const struct patch_part *whole)
{
  const int side = whole->first[1] > whole->first[0];
  const double along = whole->first[side], across = whole->first[1 - side], bend = whole->second[2 * (1 - side)];
  int split = 1;
  while (split < ROD_SPLIT_MAX && along > LONG * across && bend > 2 * limit->turn * split * across) split *= 2;
  return split;
}

/* How far the lines of the net that run along `side` go along each axis, on average. */
static void net_reach(const struct model_patch *patch, int side, double out[3])
{
  for (int k = 0; k < 3; k++) {
    double sum = 0;
    for (int n = 0; n < 12; n++) {
      const int i = n / 4, j = n % 4;
      sum += side == 0 ? fabs(patch->x[k][i + 1][j] - patch->x[k][i][j])
                       : fabs(patch->x[k][j][i + 1] - patch->x[k][j][i]);
    }
    out[k] = sum / 4;
  }
}

/* The surface, up to a factor, of the boxes of all leaves, if a patch that reaches so far either way is cut so. */
static double boxes_surface(double reach[2][3], const uint16_t split[2])
{
  double box[3];
  for (int k = 0; k < 3; k++) box[k] = reach[0][k] / split[0] + reach[1][k] / split[1];
  return split[0] * split[1] * (box[0] * box[1] + box[1] * box[2] + box[2] * box[0]);
}

static void long_split(const struct model_patch *patch, const struct split_limit *limit, const struct patch_part *whole,
                       uint16_t split[2])
{
  const int side = whole->first[1] > whole->first[0];
  double reach[2][3];
  if (!(whole->first[side] > LONG * whole->first[1 - side])) return;
  for (int k = 0; k < 2; k++) net_reach(patch, k, reach[k]);
  double surface = boxes_surface(reach, split);
  while (2 * split[side] <= SLENDER_SPLIT_MAX && 2 * split[0] * split[1] <= limit->leaves) {
    uint16_t finer[2] = {split[0], split[1]};
    finer[side] = (uint16_t)(2 * finer[side]);
    const double of_finer = boxes_surface(reach, finer);
    if (!(of_finer <= LESS_AIR * surface)) return;
    split[side] = finer[side], surface = of_finer;
  }
}

/* A cone's side ends in a pole and bends across the way there. It is cut into at least this many leaves on that way,
 * because in a shorter leaf at the pole more roots are alone. A choice of speed. */
enum { CONE_SPLIT = 4 };

static void cone_split(const struct model_patch *patch, const struct split_limit *limit, const struct patch_part *whole,
                       uint16_t split[2])
{
  for (int k = 0; k < 2; k++) {
    const bool pole = patch->pole[2 * k] || patch->pole[2 * k + 1];
    if (!pole || !(whole->second[2 * (1 - k)] > 2 * limit->turn * whole->first[1 - k])) continue;
    while (split[k] < CONE_SPLIT && 2 * split[0] * split[1] <= limit->any * limit->any)
      split[k] = (uint16_t)(2 * split[k]);
  }
}

static void auto_split(const struct model_patch *patch, const struct split_limit *limit, uint16_t split[2])
{
  const struct part_grid grid = {{1, 1}, {1, 1}, 0};
  struct patch_part whole;
  patch_parts(patch, &grid, 1, (const uint16_t[1][2]){{0, 0}}, &whole);
  split_along(patch, limit, &whole, split);
  const int rod = rod_split(limit, &whole);
  for (int k = 0; k < 2; k++)
    if (split[k] < rod && split[1 - k] * rod <= limit->any * limit->any) split[k] = (uint16_t)rod;
  cone_split(patch, limit, &whole, split);
  long_split(patch, limit, &whole, split);
}

/* How the patch's solver works on lanes: with the whole method as it is by default, or not at all. */
static enum solver_lanes lanes_of(const struct method *s)
{
  const bool all = s->basis == BASIS_BERNSTEIN && s->resultant == RESULTANT_BEZOUT &&
                   s->back_substitution == BACK_SUBSTITUTION_NULL_VECTOR && s->polish;
  const enum solver_lanes lanes = s->roots.solver->lanes;
  return all && (lanes == SOLVER_LANES_SIGNS || solver_options_improved(&s->roots)) ? lanes : SOLVER_LANES_NONE;
}

bool patch_on_lanes(const struct method *method) { return lanes_of(method) != SOLVER_LANES_NONE; }

/* Sets all but the cut. Returns the largest |coordinate| of a control point. */
static double patch_begin(const struct model *model, uint32_t index, struct model_patch *out, double rest[3][4][4])
{
  static const double none[3][4][4];
  struct scene_patch *source = &model->scene->patches[index];
  bool rounded;
  const double largest = patch_frame((const double(*)[4][3])source->P, model->size, out, rest, &rounded);
  out->rest = rounded ? (const double(*)[4][4])rest : none;
  for (int k = 0; k < 4; k++) out->pole[k] = edge_is_point(source->P, k);
  out->method = &model->scene->solvers[source->solver];
  out->lanes = lanes_of(out->method);
  return largest;
}

void patch_make(const struct model *model, uint32_t index, struct model_patch *out, double rest[3][4][4])
{
  (void)patch_begin(model, index, out, rest);
  out->cut = model->cuts[index];
}

void patch_make_first(const struct model *model, uint32_t index, const struct split_limit *limit,
                      struct model_patch *out, double rest[3][4][4])
{
  struct model_cut *cut = &model->cuts[index];
  const double largest = patch_begin(model, index, out, rest);
  if (!cut->copied) {
    int m, n;
    patch_bidegree(out->x, DEGREE_SLACK * real_max(1, largest / out->scale), &m, &n);
    cut->m = (uint8_t)m, cut->n = (uint8_t)n;
    const int fixed = out->method->split < model->most_split ? out->method->split : model->most_split;
    double lo[3], hi[3];
    points_range((const double(*)[4][3])model->scene->patches[index].P, lo, hi);
    /* The leaves of a point are all at one place: a ray would be tried on each of them. */
    if (lo[0] == hi[0] && lo[1] == hi[1] && lo[2] == hi[2]) cut->split[0] = cut->split[1] = 1;
    else if (fixed > 0) cut->split[0] = cut->split[1] = (uint16_t)fixed;
    else auto_split(out, limit, cut->split);
  }
  out->cut = *cut;
}

void patch_cut_again(const struct model *model, uint32_t index, const struct split_limit *limit,
                     struct model_patch *patch)
{
  struct model_cut *cut = &model->cuts[index];
  if (patch->method->split == 0) auto_split(patch, limit, cut->split);
  patch->cut = *cut;
}

void patch_cut_as(const struct model *model, uint32_t index, const uint16_t split[2], struct model_patch *patch)
{
  struct model_cut *cut = &model->cuts[index];
  cut->split[0] = split[0], cut->split[1] = split[1];
  patch->cut = *cut;
}

double patch_net_area(const struct model_patch *patch)
{
  double area = 0;
  for (int n = 0; n < 9; n++) {
    const int i = n / 3, j = n % 3;
    double one[3], other[3], across[3];
    for (int k = 0; k < 3; k++) {
      one[k] = patch->x[k][i + 1][j + 1] - patch->x[k][i][j];
      other[k] = patch->x[k][i][j + 1] - patch->x[k][i + 1][j];
    }
    vector_cross(one, other, across);
    area += vector_length(across) / 2;
  }
  return area;
}
