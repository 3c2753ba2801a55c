/* Hierarchies in frames of their own. See tree.h and model.h. */
#include "intersect/prepare/tree.h"

#include <math.h>
#include <string.h>

#include "base/memory.h"
#include "base/real.h"

/* Boxes no larger than this part of a frame get a tree of their own if all of them lie within SMALL_PART of it: a float
 * is then still some thousand times finer than they are. Choices of speed. */
#define SMALL_BOX 0x1p-8
#define SMALL_PART 0x1p-6

static double box_extent(const struct bvh_box *box)
{
  double extent = 0;
  for (int k = 0; k < 3; k++) extent = real_max(extent, box->hi[k] - box->lo[k]);
  return extent;
}

/* All boxes of the model, given less tree_about, and the parts that they fall into, each with its hull. The first part is
 * that of model->tree; each other one is set apart from the one before. */
struct parts {
  const struct model *model;
  struct bvh_box *boxes;
  double about[3];
  const struct team *team;
  uint32_t *part;       /* of each box */
  struct bvh_box *hull; /* of each part */
  size_t count, room;   /* parts */
  bool failed;          /* memory was short */
};

static struct bvh_box hull_of(const struct parts *all, const uint32_t index[], size_t count)
{
  struct bvh_box hull = BVH_EMPTY;
  for (size_t k = 0; k < count; k++) bvh_box_add(&hull, &all->boxes[index[k]]);
  return hull;
}

/* The size of a part's own frame. */
static double frame_of(const struct bvh_box *hull)
{
  int exponent;
  frexp(real_max(box_extent(hull) / 2, LEAST_FRAME), &exponent);
  return ldexp(1, exponent);
}

/* Moves boxes larger than `extent` to the front; returns how many there are. */
static size_t larger_first(const struct parts *all, uint32_t index[], size_t count, double extent)
{
  size_t large = 0;
  for (size_t k = 0; k < count; k++) {
    const uint32_t here = index[k];
    if (box_extent(&all->boxes[here]) > extent) index[k] = index[large], index[large++] = here;
  }
  return large;
}

/* Makes these boxes a part with a frame of that size, except for the small ones among them that are set apart from it in
 * turn. */
static void part_add(struct parts *all, double frame, uint32_t index[], size_t count)
{
  struct bvh_box *hulls = memory_grow(all->hull, &all->room, all->count + 1, sizeof *hulls);
  all->failed |= !hulls;
  if (!hulls) return;
  all->hull = hulls, hulls[all->count] = hull_of(all, index, count);
  for (size_t k = 0; k < count; k++) all->part[index[k]] = (uint32_t)all->count;
  all->count++;
  const size_t large = larger_first(all, index, count, SMALL_BOX * frame);
  uint32_t *small = index + large;
  const struct bvh_box hull = hull_of(all, small, count - large);
  if (large > 0 && count - large > 1 && box_extent(&hull) <= SMALL_PART * frame)
    part_add(all, frame_of(&hull), small, count - large);
}

void tree_box(const double middle[3], double frame, struct bvh_box *box)
{
  for (int k = 0; k < 3; k++) {
    const double slack = 4 * UNIT_ROUNDOFF * (real_max(fabs(box->lo[k]), fabs(box->hi[k])) + fabs(middle[k]));
    box->lo[k] = (box->lo[k] - middle[k] - slack) / frame, box->hi[k] = (box->hi[k] - middle[k] + slack) / frame;
  }
}

/* Gives the leaves of the hierarchy the numbers of their boxes. */
static void renumber_leaves(struct bvh *bvh, const uint32_t number[])
{
  for (size_t n = 0; n < BVH_WIDTH * bvh->node_count; n++) {
    uint32_t *child = &bvh->nodes[n / BVH_WIDTH].child[n % BVH_WIDTH];
    if (*child & BVH_LEAF) *child = BVH_LEAF | number[*child & ~BVH_LEAF];
  }
}

/* Builds the tree of a part from its `count` boxes, in a frame of that size about `middle`; of the first part, also over
 * the hulls of all others. Uses up index, which has room for them. */
static enum status build(const struct parts *all, size_t part, uint32_t index[], size_t count, const double middle[3],
                         double frame, struct model_tree *out)
{
  const size_t inner = part == 0 ? all->count - 1 : 0;
  const bool alone = all->count == 1; /* nobody else needs the boxes: no copies of them */
  *out = (struct model_tree){.frame = frame};
  for (int k = 0; k < 3; k++) out->origin[k] = all->about[k] + middle[k];
  struct bvh_box *own = alone ? all->boxes : memory_alloc(count + inner + 1, sizeof *own);
  if (!own) return STATUS_LIMIT;
  for (size_t k = 0; k < count && !alone; k++) own[k] = all->boxes[index[k]];
  for (size_t n = 0; n < inner; n++) {
    own[count] = all->hull[1 + n];
    index[count++] = (uint32_t)(all->model->leaf_count + all->model->copy_count + n);
  }
  for (size_t k = 0; k < count; k++) tree_box(middle, frame, &own[k]);
  const enum status status = bvh_build(own, count, all->team, &out->bvh);
  if (status == STATUS_OK && !alone) renumber_leaves(&out->bvh, index);
  if (!alone) memory_free(own);
  return status;
}

/* Builds all trees. index has room for all boxes and hulls. The first part has the scene's frame. */
static enum status build_all(const struct parts *all, uint32_t index[], struct model *model, const double middle[3])
{
  const size_t boxes = model->leaf_count + model->copy_count;
  /* where each part begins in index: the last one first, so that the hulls follow the first one's boxes */
  size_t *begin = memory_alloc(all->count + 1, sizeof *begin);
  model->inner = arena_alloc(model->arena, all->count, sizeof *model->inner);
  enum status status = begin && model->inner ? STATUS_OK : STATUS_LIMIT;
  if (status == STATUS_OK) {
    for (size_t k = 0; k < boxes; k++) begin[all->part[k]]++;
    for (size_t n = all->count; n-- > 0;) begin[n] += begin[n + 1];
    for (size_t k = boxes; k-- > 0;) index[--begin[all->part[k]]] = (uint32_t)k;
  }
  for (size_t n = 1; n < all->count && status == STATUS_OK; n++) {
    double center[3];
    for (int k = 0; k < 3; k++) center[k] = box_center(&all->hull[n], k);
    status = build(all, n, index + begin[n], begin[n - 1] - begin[n], center, frame_of(&all->hull[n]),
                   &model->inner[model->inner_count++]);
  }
  if (status == STATUS_OK)
    status = build(all, 0, index + begin[0], boxes - begin[0], middle, model->tree.frame, &model->tree);
  memory_free(begin);
  return status;
}

enum status tree_build(struct model *model, struct bvh_box boxes[], const struct team *team)
{
  const size_t count = model->leaf_count + model->copy_count;
  struct parts all = {.model = model, .boxes = boxes, .team = team};
  double middle[3];
  for (int k = 0; k < 3; k++)
    all.about[k] = tree_about(&model->tree, k), middle[k] = model->tree.origin[k] - all.about[k];
  enum status status = STATUS_LIMIT;
  uint32_t *index = memory_alloc(count + 1, sizeof *index), *more = NULL;
  all.part = memory_alloc(count + 1, sizeof *all.part);
  if (index && all.part) {
    for (size_t k = 0; k < count; k++) index[k] = (uint32_t)k;
    part_add(&all, model->tree.frame, index, count);
    more = all.failed ? NULL : memory_resize(index, (count + all.count) * sizeof *index);
  }
  if (more) index = more, status = build_all(&all, index, model, middle);
  memory_free(all.hull), memory_free(all.part);
  memory_free(index);
  return status;
}

void tree_free(struct model *model)
{
  for (size_t k = 0; k < model->inner_count; k++) bvh_free(&model->inner[k].bvh);
  bvh_free(&model->tree.bvh);
}
