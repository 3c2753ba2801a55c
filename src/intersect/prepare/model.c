/* Preparing a scene: local frames, true degrees, how far patches are cut, leaves, what copies share, the hierarchy. */
#include "intersect/model.h"

#include <math.h>
#include <string.h>

#include "base/double_double.h"
#include "base/memory.h"
#include "base/real.h"
#include "geometry/patch.h"
#include "geometry/vector.h"
#include "intersect/exact/exact.h"
#include "intersect/prepare/copies.h"
#include "intersect/prepare/leaf.h"
#include "intersect/prepare/tree.h"

/* A declared control point carries half a unit in the last place of its decimal form and a few of its transforms: a
 * patch whose excess over a lower degree is no more than this, relative to its largest coordinate, was meant to be
 * of that degree. */
#define DEGREE_SLACK (8 * UNIT_ROUNDOFF)

/* Leaves of `split auto`: cut until a leaf's derivatives turn by no more than about this fraction of their size, for
 * then one Newton process holds on the whole leaf for all but grazing rays. A choice of speed, not of correctness. */
#define AUTO_TURN 0.25
enum { AUTO_SPLIT_MAX = 16 };

/* A patch this many times as long as wide is slender, up to what so many leaves along it can make good, whose number
 * goes with the root of that. What lies in the plane of a ray must not be more than exact.h has room for. */
#define SLENDER 16.0
#define SLENDER_MOST ((double)SLENDER_SPLIT_MAX * SLENDER_SPLIT_MAX)
enum { SLENDER_SPLIT_MAX = EXACT_REGIONS_MAX / 2 };

/* Leaves of all patches with `split auto` together: large scenes have small patches, and their leaves cost memory
 * and time to make. The limit on the split is halved until they fit. */
enum { AUTO_LEAVES_MAX = 1 << 18 };

/* A patch smaller than this part of the scene's coordinates is framed as if it were that large: one that is a single
 * point has no size of its own, and a frame too small would overflow. */
#define LEAST_EXTENT 0x1p-100

/* Nor is a patch's frame smaller than this, so that its reciprocal and all products with it are normal numbers. */
#define LEAST_SCALE 0x1p-1000

/* A frame no smaller than this: its reciprocal times a direction is finite. */
#define LEAST_FRAME 0x1p-700

/* Writes all but the rest, and that to where it may stay. Returns whether there is any. */
static bool patch_frame(double P[4][4][3], double scene_size, struct model_patch *out, double rest[3][4][4])
{
  bool rounded = false;
  double extent = scene_size > 0 ? real_max(LEAST_EXTENT * scene_size, LEAST_SCALE) : 0, lo[3], hi[3];
  for (int k = 0; k < 3; k++) {
    lo[k] = INFINITY, hi[k] = -INFINITY;
    for (int i = 0; i < 4; i++)
      for (int j = 0; j < 4; j++) lo[k] = real_min(lo[k], P[i][j][k]), hi[k] = real_max(hi[k], P[i][j][k]);
    extent = real_max(extent, hi[k] / 2 - lo[k] / 2);
  }
  int exponent = 0;                         /* all of the scene is the origin: any scale will do */
  if (extent > 0) frexp(extent, &exponent); /* extent < 2^exponent */
  out->scale = ldexp(1, exponent + 1);      /* the center may be a grain off the middle */
  for (int k = 0; k < 3; k++) {
    const double middle = lo[k] / 2 + hi[k] / 2, grain = out->scale / 4;
    out->center[k] = fabs(middle) < grain * 0x1p50 ? real_coarse(middle, grain) : middle;
    for (int n = 0; n < 16; n++) {
      const struct double_double x = dd_two_sum(P[n / 4][n % 4][k], -out->center[k]);
      out->x[k][n / 4][n % 4] = x.hi / out->scale, rest[k][n / 4][n % 4] = x.lo / out->scale;
      rounded |= x.lo != 0;
    }
  }
  return rounded;
}

static double largest_coordinate(double P[4][4][3])
{
  double size = 0;
  for (int i = 0; i < 4; i++)
    for (int j = 0; j < 4; j++)
      for (int k = 0; k < 3; k++) size = real_max(size, fabs(P[i][j][k]));
  return size;
}

/* How many leaves make every leaf nearly flat: second derivatives fall with the square, first ones with one over it. A
 * slender patch is cut along its long side only, for only that bends, until its leaves turn as little as the short side
 * wants or are no longer slender. */
static void auto_split(struct model_patch *patch, int most)
{
  double second[3], first[2], net[3][16];
  patch_second_derivative_bounds(patch->x, second);
  memcpy(net, patch->x, sizeof net);
  leaf_first_bounds(net, first);
  const double turn = (second[0] + 2 * second[1] + second[2]) / 2;
  const int side = first[1] > first[0];
  const double along = first[side], across = first[1 - side], bend = second[2 * side];
  patch->split[0] = patch->split[1] = 1;
  if (along > SLENDER * across && along <= SLENDER_MOST * across) {
    int *split = &patch->split[side];
    while (2 * *split <= most * most && 2 * *split <= SLENDER_SPLIT_MAX && along > 2 * *split * across &&
           bend / *split + 2 * second[1] > 2 * AUTO_TURN * *split * across)
      *split *= 2;
    return;
  }
  int *split = patch->split;
  while (split[0] < most && turn > AUTO_TURN * split[0] * along) split[0] *= 2;
  split[1] = split[0];
}

/* What the patch's solver does on lanes: the whole method as it is by default, or nothing. */
static enum solver_lanes lanes_of(const struct method *s)
{
  const struct solver_options *r = &s->roots;
  const bool all = s->basis == BASIS_BERNSTEIN && s->resultant == RESULTANT_BEZOUT &&
                   s->back_substitution == BACK_SUBSTITUTION_NULL_VECTOR && s->polish;
  const bool improved = r->radii == RADII_POLYGON && r->stop == STOP_ROUNDING && r->update == UPDATE_GAUSS_SEIDEL &&
                        r->rest; /* what Aberth's method has of choices */
  return all && (improved || r->solver->lanes != SOLVER_LANES_ABERTH) ? r->solver->lanes : SOLVER_LANES_NONE;
}

/* The frame of the hierarchy, and the patches' own. */
static enum status prepare_patches(struct model *model)
{
  static const double none[3][4][4];
  double(*rest)[4][4] = NULL; /* room for the next patch that has one */
  const struct scene *scene = model->scene;
  double lo[3] = {0}, hi[3] = {0}, size = 0;
  for (size_t p = 0; p < scene->patch_count; p++) {
    size = real_max(size, largest_coordinate(scene->patches[p].P));
    for (int k = 0; k < 3; k++) {
      for (int i = 0; i < 16; i++) {
        const double c = scene->patches[p].P[i / 4][i % 4][k];
        lo[k] = p == 0 && i == 0 ? c : real_min(lo[k], c), hi[k] = p == 0 && i == 0 ? c : real_max(hi[k], c);
      }
    }
  }
  double extent = real_max(LEAST_EXTENT * size, LEAST_FRAME);
  for (int k = 0; k < 3; k++)
    model->origin[k] = lo[k] / 2 + hi[k] / 2, extent = real_max(extent, hi[k] / 2 - lo[k] / 2);
  int exponent;
  frexp(extent, &exponent); /* extent < 2^exponent */
  model->frame = ldexp(1, exponent);
  for (size_t p = 0; p < scene->patch_count; p++) {
    struct scene_patch *source = &scene->patches[p];
    struct model_patch *patch = &model->patches[p];
    if (rest == NULL) rest = arena_alloc(model->arena, 3, sizeof *rest);
    if (rest == NULL) return STATUS_LIMIT;
    const bool rounded = patch_frame(source->P, size, patch, rest);
    patch->rest = rounded ? (const double(*)[4][4])rest : none;
    if (rounded) rest = NULL;
    patch->method = &scene->solvers[source->solver];
    patch->all_roots = lanes_of(patch->method) == SOLVER_LANES_ABERTH;
    patch->lanes = lanes_of(patch->method) != SOLVER_LANES_NONE;
    model->unproven |= !patch->method->polish;
  }
  return STATUS_OK;
}

/* How far each patch with leaves of its own is cut. */
static void split_patches(struct model *model, int most)
{
  for (size_t p = 0; p < model->scene->patch_count; p++) {
    struct model_patch *patch = &model->patches[p];
    if (patch->copied) continue;
    const double size = largest_coordinate(model->scene->patches[p].P);
    patch_bidegree(patch->x, DEGREE_SLACK * real_max(1, size / patch->scale), &patch->m, &patch->n);
    if (patch->method->split > 0) patch->split[0] = patch->split[1] = patch->method->split;
    else auto_split(patch, most);
    model->leaf_count += (size_t)patch->split[0] * (size_t)patch->split[1];
  }
}

static enum status prepare_leaves(struct model *model, struct bvh_box boxes[])
{
  size_t l = 0;
  struct leaf_parts *room = NULL; /* for the next leaf that has parts */
  for (size_t p = 0; p < model->scene->patch_count; p++) {
    struct model_patch *patch = &model->patches[p];
    for (int k = 0; k < patch->split[0] * patch->split[1] && !patch->copied; k++, l++) {
      struct leaf *leaf = &model->leaves[l];
      if (!room) room = arena_alloc(model->arena, 1, sizeof *room);
      if (!room) return STATUS_LIMIT;
      leaf_cut(patch, k / patch->split[1], k % patch->split[1], leaf, room);
      if (leaf->parts) room = NULL;
      leaf->patch = (uint32_t)p;
      leaf_box(model, leaf, &boxes[l]);
      const enum status status = leaf_set_form(model->arena, patch, leaf);
      if (status != STATUS_OK) return status;
    }
  }
  return STATUS_OK;
}

/* The leaves of patches and, behind them, the copies, in one hierarchy. */
static enum status prepare_hierarchy(struct model *model, int most)
{
  split_patches(model, most);
  const size_t count = model->leaf_count + model->copy_count;
  struct bvh_box *boxes = memory_alloc(count + 1, sizeof *boxes);
  model->leaves = arena_alloc(model->arena, model->leaf_count + 1, sizeof *model->leaves);
  enum status status = boxes && model->leaves ? prepare_leaves(model, boxes) : STATUS_LIMIT;
  if (status == STATUS_OK) {
    for (size_t c = 0; c < model->copy_count; c++) copy_box(model, &model->copies[c], &boxes[model->leaf_count + c]);
    status = tree_build(model->arena, boxes, count, model->origin, model->frame, &model->tree);
  }
  memory_free(boxes);
  return status;
}

static int most_split(size_t patch_count)
{
  int most = AUTO_SPLIT_MAX;
  while (most > 1 && patch_count * (size_t)(most * most) > AUTO_LEAVES_MAX) most /= 2;
  return most;
}

/* An empty model with the patches in their frames. */
static struct model *model_begin(const struct scene *scene)
{
  struct model *model = memory_alloc(1, sizeof *model);
  if (!model) return NULL;
  model->scene = scene;
  model->arena = arena_create();
  if (model->arena) model->patches = arena_alloc(model->arena, scene->patch_count + 1, sizeof *model->patches);
  if (model->patches && prepare_patches(model) == STATUS_OK) return model;
  model_destroy(model);
  return NULL;
}

enum status model_create_object(const struct scene *nets, int most, double error, struct model **out)
{
  *out = NULL;
  struct model *model = model_begin(nets);
  if (!model) return STATUS_LIMIT;
  model->error = error;
  const enum status status = prepare_hierarchy(model, most);
  model->scene = NULL;
  if (status == STATUS_OK) *out = model;
  else model_destroy(model);
  return status;
}

static enum status prepare(struct model *model)
{
  const struct scene *scene = model->scene;
  model->neighbours = arena_alloc(model->arena, scene->patch_count + 1, 4 * sizeof *model->neighbours);
  if (!model->neighbours) return STATUS_LIMIT;
  enum status status = edges_match(scene->patches, sizeof *scene->patches, scene->patch_count, model->neighbours);
  if (status != STATUS_OK) return status;
  size_t own = scene->patch_count; /* patches that need leaves */
  if (most_split(own) < AUTO_SPLIT_MAX) {
    status = copies_choose(model, &own);
    if (status != STATUS_OK) return status;
  }
  const int most = most_split(own);
  status = copies_prepare(model, most);
  return status == STATUS_OK ? prepare_hierarchy(model, most) : status;
}

enum status model_create(const struct scene *scene, struct model **out)
{
  *out = NULL;
  struct model *model = model_begin(scene);
  if (!model) return STATUS_LIMIT;
  const enum status status = prepare(model);
  if (status == STATUS_OK) *out = model;
  else model_destroy(model);
  return status;
}

void model_destroy(struct model *model)
{
  if (!model) return;
  for (size_t k = 0; k < model->object_count; k++) model_destroy(model->objects[k].model);
  tree_free(&model->tree);
  arena_destroy(model->arena);
  memory_free(model);
}
