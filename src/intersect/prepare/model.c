/* Preparing a scene: how far patches are cut, leaves, what copies share, the hierarchy. */
#include "intersect/model.h"

#include <math.h>

#include "base/memory.h"
#include "base/real.h"
#include "intersect/prepare/copies.h"
#include "intersect/prepare/leaf.h"
#include "intersect/prepare/patch.h"
#include "intersect/prepare/tree.h"

enum { AUTO_SPLIT_MAX = 16 };

/* Leaves of all patches with `split auto` together: large scenes have small patches, and their leaves cost memory
 * and time to make. The limit on the split is halved until they fit. */
enum { AUTO_LEAVES_MAX = 1 << 18 };

/* The same where leaves are not kept, and are no more than their boxes, an eighth of a leaf. */
enum { AUTO_BOXES_MAX = 1 << 20 };

/* A frame no smaller than this: its reciprocal times a direction is finite. */
#define LEAST_FRAME 0x1p-700

/* The frame of the hierarchy. */
static void set_frame(struct model *model)
{
  const struct scene *scene = model->scene;
  double lo[3] = {0}, hi[3] = {0};
  for (size_t p = 0; p < scene->patch_count; p++) {
    model->size = real_max(model->size, patch_largest_coordinate(scene->patches[p].P));
    for (int k = 0; k < 3; k++) {
      for (int i = 0; i < 16; i++) {
        const double c = scene->patches[p].P[i / 4][i % 4][k];
        lo[k] = p == 0 && i == 0 ? c : real_min(lo[k], c), hi[k] = p == 0 && i == 0 ? c : real_max(hi[k], c);
      }
    }
    model->unproven |= !scene->solvers[scene->patches[p].solver].polish;
  }
  double extent = real_max(LEAST_EXTENT * model->size, LEAST_FRAME);
  for (int k = 0; k < 3; k++)
    model->origin[k] = lo[k] / 2 + hi[k] / 2, extent = real_max(extent, hi[k] / 2 - lo[k] / 2);
  int exponent;
  frexp(extent, &exponent); /* extent < 2^exponent */
  model->frame = ldexp(1, exponent);
}

/* How far each patch with leaves of its own is cut. */
static void split_patches(struct model *model, int most)
{
  for (size_t p = 0; p < model->scene->patch_count; p++) {
    const struct model_cut *cut = &model->cuts[p];
    if (cut->copied) continue;
    patch_set_cut(model, (uint32_t)p, most);
    model->leaf_count += (size_t)cut->split[0] * cut->split[1];
  }
}

/* The next room for what not every patch or leaf has: *room, or new where that has been used. */
static bool next_room(struct arena *arena, void **room, size_t size)
{
  if (!*room) *room = arena_alloc(arena, 1, size);
  return *room != NULL;
}

static enum status keep_patches(struct model *model)
{
  void *rest = NULL;
  model->patches = arena_alloc(model->arena, model->scene->patch_count + 1, sizeof *model->patches);
  for (size_t p = 0; model->patches && p < model->scene->patch_count; p++) {
    if (!next_room(model->arena, &rest, sizeof(double[3][4][4]))) return STATUS_LIMIT;
    patch_make(model, (uint32_t)p, &model->patches[p], rest);
    if ((const void *)model->patches[p].rest == rest) rest = NULL;
  }
  return model->patches ? STATUS_OK : STATUS_LIMIT;
}

static enum status keep_leaves(struct model *model, struct bvh_box boxes[])
{
  size_t l = 0;
  void *parts = NULL, *form = NULL;
  model->leaves = arena_alloc(model->arena, model->leaf_count + 1, sizeof *model->leaves);
  if (!model->leaves || keep_patches(model) != STATUS_OK) return STATUS_LIMIT;
  for (size_t p = 0; p < model->scene->patch_count; p++) {
    struct model_patch *patch = &model->patches[p];
    for (int k = 0; k < patch->split[0] * patch->split[1] && !model->cuts[p].copied; k++, l++) {
      struct leaf *leaf = &model->leaves[l];
      if (!next_room(model->arena, &parts, sizeof *leaf->parts) || !next_room(model->arena, &form, sizeof *leaf->form))
        return STATUS_LIMIT;
      const struct leaf_place place = {(uint32_t)p, (uint16_t)(k / patch->split[1]), (uint16_t)(k % patch->split[1])};
      leaf_make(patch, &place, leaf, parts, form);
      if (leaf->parts) parts = NULL;
      if (leaf->form) form = NULL;
      leaf_box(model, patch, leaf->x, &boxes[l]);
    }
  }
  return STATUS_OK;
}

/* Only where they are, and their boxes. */
static enum status place_leaves(struct model *model, struct bvh_box boxes[])
{
  size_t l = 0;
  model->places = arena_alloc(model->arena, model->leaf_count, sizeof *model->places);
  for (size_t p = 0; model->places && p < model->scene->patch_count; p++) {
    struct patch_room room;
    struct model_patch *patch = &room.patch;
    if (model->cuts[p].copied) continue;
    patch_make(model, (uint32_t)p, patch, room.rest);
    for (int k = 0; k < patch->split[0] * patch->split[1]; k++, l++) {
      const uint16_t column[2] = {(uint16_t)(k / patch->split[1]), (uint16_t)(k % patch->split[1])};
      double x[3][16];
      model->places[l] = (struct leaf_place){(uint32_t)p, column[0], column[1]};
      leaf_net(patch, column, (uint16_t[2]){1, 1}, x);
      leaf_box(model, patch, x, &boxes[l]);
    }
  }
  return model->places ? STATUS_OK : STATUS_LIMIT;
}

/* The leaves of patches and, behind them, the copies, in one hierarchy. Leaves are kept where that is wanted; it makes
 * rays a quarter faster, at 1.5 KB a patch of one leaf. */
static enum status prepare_hierarchy(struct model *model, bool keep)
{
  const size_t count = model->leaf_count + model->copy_count;
  struct bvh_box *boxes = memory_alloc(count + 1, sizeof *boxes);
  enum status status = STATUS_LIMIT;
  if (boxes) status = keep ? keep_leaves(model, boxes) : place_leaves(model, boxes);
  if (status == STATUS_OK) {
    for (size_t c = 0; c < model->copy_count; c++) copy_box(model, &model->copies[c], &boxes[model->leaf_count + c]);
    status = tree_build(model->arena, boxes, count, model->origin, model->frame, &model->tree);
  }
  memory_free(boxes);
  return status;
}

static int most_split(size_t patch_count, size_t leaves_max)
{
  int most = AUTO_SPLIT_MAX;
  while (most > 1 && patch_count * (size_t)(most * most) > leaves_max) most /= 2;
  return most;
}

/* An empty model with its frame. */
static struct model *model_begin(const struct scene *scene)
{
  struct model *model = memory_alloc(1, sizeof *model);
  if (!model) return NULL;
  model->scene = scene;
  model->arena = arena_create();
  if (model->arena) model->cuts = arena_alloc(model->arena, scene->patch_count + 1, sizeof *model->cuts);
  if (!model->cuts) {
    model_destroy(model);
    return NULL;
  }
  set_frame(model);
  return model;
}

enum status model_create_object(const struct scene *nets, int most, double error, struct model **out)
{
  *out = NULL;
  struct model *model = model_begin(nets);
  if (!model) return STATUS_LIMIT;
  model->error = error;
  split_patches(model, most);
  const enum status status = prepare_hierarchy(model, true);
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
  if (most_split(own, AUTO_LEAVES_MAX) < AUTO_SPLIT_MAX) {
    status = copies_choose(model, &own);
    if (status != STATUS_OK) return status;
  }
  int most = most_split(own, AUTO_LEAVES_MAX);
  const bool keep = most > 1;
  if (!keep) most = most_split(own, AUTO_BOXES_MAX);
  status = copies_prepare(model, most);
  if (status != STATUS_OK) return status;
  split_patches(model, most);
  return prepare_hierarchy(model, keep && model->leaf_count <= AUTO_LEAVES_MAX);
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

struct model_patch *model_patch_at(const struct model *model, uint32_t index, struct patch_room *room)
{
  if (model->patches) return &model->patches[index];
  patch_make(model, index, &room->patch, room->rest);
  return &room->patch;
}

void model_make_leaf(const struct model *model, uint32_t number, struct leaf_room *out)
{
  const struct leaf_place *place = &model->places[number];
  patch_make(model, place->patch, &out->of.patch, out->of.rest);
  leaf_make(&out->of.patch, place, &out->leaf, &out->parts, &out->form);
}

void model_destroy(struct model *model)
{
  if (!model) return;
  for (size_t k = 0; k < model->object_count; k++) model_destroy(model->objects[k].model);
  tree_free(&model->tree);
  arena_destroy(model->arena);
  memory_free(model);
}
