/* Prepares a scene: its frame, how far patches may be cut, surfaces, neighbours, and what copies share. hierarchy.c makes
 * the leaves and puts them in order. */
#include "intersect/model.h"

#include <math.h>

#include "base/memory.h"
#include "base/real.h"
#include "intersect/prepare/copies.h"
#include "intersect/prepare/hierarchy.h"
#include "intersect/prepare/leaf.h"
#include "intersect/prepare/patch.h"
#include "intersect/prepare/tree.h"

/* Leaves of all patches with `split auto` together, since they cost memory; and those of one patch that is kept. */
enum { LEAVES_MAX = 1 << 19, PATCH_LEAVES_MAX = EXACT_LEAVES };

/* Leaves that are not kept take only their boxes, an eighth of a leaf: with this many a patch takes a kilobyte. */
enum { BOXES_MAX = 4 };

/* Up to so many patches are kept; copies share leaves if there are more patches than UNSHARED_MAX. */
enum { KEPT_PATCHES_MAX = 1 << 16, UNSHARED_MAX = 1 << 10 };

/* ns that making a leaf takes; and the rays of a picture, which meet all patches alike. */
#define LEAF_TIME 1200.0
#define PICTURE_RAYS 0x1p19

/* Sets the frame of the hierarchy, whose boxes are not made yet. */
static void set_frame(struct model *model)
{
  const struct scene *scene = model->scene;
  struct bvh_box box = {{0}, {0}};
  if (scene->patch_count > 0) box = BVH_EMPTY;
  for (size_t p = 0; p < scene->patch_count; p++) {
    box_add_net(&box, scene->patches[p].P);
    model->unproven |= !scene->solvers[scene->patches[p].solver].polish;
  }
  for (int k = 0; k < 3; k++) model->size = real_max(model->size, real_max(fabs(box.lo[k]), fabs(box.hi[k])));
  double extent = model->size > 0 ? real_max(LEAST_EXTENT * model->size, LEAST_FRAME) : 1;
  for (int k = 0; k < 3; k++)
    model->tree.origin[k] = box_center(&box, k), extent = real_max(extent, box.hi[k] / 2 - box.lo[k] / 2);
  int exponent;
  frexp(extent, &exponent); /* extent < 2^exponent */
  model->tree.frame = real_power_of_two(exponent);
}

static struct cut_limit cut_limit(size_t patch_count, bool keep, int most_split)
{
  int most = most_split * most_split < PATCH_LEAVES_MAX ? most_split * most_split : PATCH_LEAVES_MAX;
  while (most > BOXES_MAX && (!keep || (size_t)most * patch_count > LEAVES_MAX)) most /= 2;
  return (struct cut_limit){LEAF_TIME * (double)patch_count / PICTURE_RAYS, most};
}

/* A model with its frame, otherwise empty. */
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

enum status model_create_object(const struct scene *nets, const struct team *team, const struct cut_limit *limit,
                                struct model_object *object)
{
  struct model *model = model_begin(nets);
  if (!model) return STATUS_LIMIT;
  model->error = object->error, model->most_split = METHOD_MAX_SPLIT;
  const enum status status = hierarchy_make(model, team, limit, true, SIZE_MAX);
  model->scene = NULL;
  if (status == STATUS_OK) object->model = model;
  else model_destroy(model);
  return status;
}

/* Finds patches of one surface; not if nothing is proven, as where the solvers' bare roots are the answers. */
static enum status find_surfaces(struct model *model)
{
  const struct scene *scene = model->scene;
  if (model->unproven) return STATUS_OK;
  uint32_t *surface = arena_alloc(model->arena, scene->patch_count + 1, sizeof *surface);
  if (!surface) return STATUS_LIMIT;
  const enum status status = surfaces_find(scene->patches, sizeof *scene->patches, scene->patch_count, surface);
  for (size_t p = 0; p < scene->patch_count; p++)
    if (surface[p]) model->surface = surface;
  return status;
}

static enum status prepare(struct model *model, const struct team *team)
{
  const struct scene *scene = model->scene;
  model->neighbours = arena_alloc(model->arena, scene->patch_count + 1, 4 * sizeof *model->neighbours);
  if (!model->neighbours) return STATUS_LIMIT;
  enum status status = find_surfaces(model);
  if (status == STATUS_OK)
    status = edges_match(scene->patches, sizeof *scene->patches, scene->patch_count, model->surface,
                         scene->patch_count < TEAM_LEAST ? NULL : team, model->neighbours);
  if (status != STATUS_OK) return status;
  size_t own = scene->patch_count; /* patches that need leaves */
  if (own > UNSHARED_MAX) status = copies_choose(model, KEPT_PATCHES_MAX, &own);
  if (status != STATUS_OK) return status;
  const bool keep = own <= KEPT_PATCHES_MAX && !model->never_keep;
  for (size_t p = 0; p < scene->patch_count; p++) own -= model_again(model, p) && !model->cuts[p].copied;
  const struct cut_limit of_object = cut_limit(own, true, model->most_split),
                         limit = cut_limit(own, keep, model->most_split);
  status = copies_prepare(model, team, &of_object);
  if (status != STATUS_OK) return status;
  return hierarchy_make(model, team, &limit, keep, LEAVES_MAX);
}

/* The model with leaves no finer than `most_split`. */
static enum status create_within(const struct scene *scene, const struct team *team, int most_split, bool never_keep,
                                 struct model **out)
{
  struct model *model = model_begin(scene);
  if (!model) return STATUS_LIMIT;
  model->most_split = most_split, model->never_keep = never_keep;
  const enum status status = prepare(model, team);
  if (status == STATUS_OK) *out = model;
  else model_destroy(model);
  return status;
}

/* If memory is short, leaves are not kept; if it still is, patches are cut less and less. */
enum status model_create(const struct scene *scene, const struct team *team, struct model **out)
{
  *out = NULL;
  enum status status = create_within(scene, team, METHOD_MAX_SPLIT, false, out);
  for (int most = METHOD_MAX_SPLIT; most > 0 && status == STATUS_LIMIT; most /= 2)
    status = create_within(scene, team, most, true, out);
  return status;
}

bool model_cut_less(const struct model *model)
{
  bool less = false;
  for (size_t k = 0; k < model->scene->solver_count; k++) less |= model->scene->solvers[k].split > model->most_split;
  return less;
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
  const uint32_t row = out->of.patch.cut.split[1];
  leaf_make(&out->of.patch, place->patch, place->column_u * row + place->column_v, &out->leaf);
}

void model_destroy(struct model *model)
{
  if (!model) return;
  for (size_t k = 0; k < model->object_count; k++) model_destroy(model->objects[k].model);
  tree_free(model);
  memory_free(model->oriented_room);
  arena_destroy(model->arena);
  memory_free(model);
}
