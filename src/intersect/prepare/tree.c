/* Hierarchies in frames of their own. See tree.h and model.h. */
#include "intersect/prepare/tree.h"

#include <math.h>
#include <string.h>

#include "base/memory.h"
#include "base/real.h"
#include "geometry/vector.h"

/* Boxes no larger than this part of a frame get a tree of their own if all of them lie within SMALL_PART of it: a float
 * is then still some thousand times finer than they are. Choices of speed. */
#define SMALL_BOX 0x1p-8
#define SMALL_PART 0x1p-6

/* If they do not, boxes no larger than this, of which floats tell little (2^-21 of the frame is added to a box), get
 * several trees: one for each GROUP_LEAST or more that lie within such a part. */
#define TINY_BOX 0x1p-16
enum { GROUP_LEAST = 8 };

static double box_extent(const struct bvh_box *box)
{
  double extent = 0;
  for (int k = 0; k < 3; k++) extent = real_max(extent, box->hi[k] - box->lo[k]);
  return extent;
}

/* Boxes that get a tree: index[0..count-1]. */
struct part {
  uint32_t *index;
  size_t count;
  struct bvh_box hull;
  bool twins; /* part of model->twins, not of model->tree */
};

/* All boxes of the model, given less tree_about, and the parts that they fall into. The first ones are those of
 * model->tree, with `twins` of model->twins; the others are set apart from these or from one another. */
struct parts {
  const struct model *model;
  struct bvh_box *boxes;
  double about[3];
  const struct team *team;
  struct part *at;
  size_t count, room;
  bool failed; /* memory was short */
};

static struct bvh_box hull_of(const struct parts *all, const uint32_t index[], size_t count)
{
  struct bvh_box hull = BVH_EMPTY;
  for (size_t k = 0; k < count; k++) bvh_box_add(&hull, &all->boxes[index[k]]);
  return hull;
}

static void part_add(struct parts *all, uint32_t *index, size_t count, bool twins)
{
  struct part *grown = memory_grow(all->at, &all->room, all->count + 1, sizeof *grown);
  all->failed |= !grown;
  if (!grown) return;
  all->at = grown;
  grown[all->count++] = (struct part){index, count, hull_of(all, index, count), twins};
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

/* Moves boxes whose centers are below `place` on the axis to the front; returns how many there are. */
static size_t lower_first(const struct parts *all, uint32_t index[], size_t count, int axis, double place)
{
  size_t lower = 0;
  for (size_t k = 0; k < count; k++) {
    const uint32_t here = index[k];
    if (box_center(&all->boxes[here], axis) < place) index[k] = index[lower], index[lower++] = here;
  }
  return lower;
}

/* Finds the groups among these boxes, which are tiny, by halving the space that they fill. Both halves have some,
 * because the hull is far larger than the boxes. */
static void find_groups(struct parts *all, double frame, uint32_t index[], size_t count, bool twins)
{
  if (count < GROUP_LEAST) return;
  const struct bvh_box hull = hull_of(all, index, count);
  if (box_extent(&hull) <= SMALL_PART * frame) {
    part_add(all, index, count, twins);
    return;
  }
  int axis = 0;
  for (int k = 1; k < 3; k++)
    if (hull.hi[k] - hull.lo[k] > hull.hi[axis] - hull.lo[axis]) axis = k;
  const size_t lower = lower_first(all, index, count, axis, box_center(&hull, axis));
  find_groups(all, frame, index, lower, twins);
  find_groups(all, frame, index + lower, count - lower, twins);
}

/* Moves the parts from number `first` on, which are in order, behind all other boxes of `from`, which no longer has
 * them. */
static void parts_last(struct parts *all, struct part *from, size_t first)
{
  uint32_t *moved = memory_alloc(from->count, sizeof *moved);
  all->failed |= !moved;
  if (!moved) return;
  size_t stay = 0, behind = 0, next = 0;
  for (size_t n = first; n < all->count; n++) {
    const struct part *part = &all->at[n];
    const size_t begin = (size_t)(part->index - from->index);
    memcpy(moved + behind, part->index, part->count * sizeof *moved);
    for (; next < begin; next++) from->index[stay++] = from->index[next];
    next += part->count, behind += part->count;
  }
  for (; next < from->count; next++) from->index[stay++] = from->index[next];
  memcpy(from->index + stay, moved, behind * sizeof *moved);
  memory_free(moved);
  from->count = stay;
  for (uint32_t *at = from->index + stay; first < all->count; at += all->at[first++].count) all->at[first].index = at;
}

/* Sets groups of a part's boxes apart. */
static void set_apart(struct parts *all, size_t number, double frame)
{
  const struct part part = all->at[number];
  const size_t first = all->count, large = larger_first(all, part.index, part.count, SMALL_BOX * frame);
  uint32_t *small = part.index + large;
  const size_t count = part.count - large;
  const struct bvh_box hull = hull_of(all, small, count);
  if (large > 0 && count > 1 && box_extent(&hull) <= SMALL_PART * frame) {
    part_add(all, small, count, part.twins);
  } else {
    const size_t larger = larger_first(all, small, count, TINY_BOX * frame);
    find_groups(all, frame, small + larger, count - larger, part.twins);
    if (all->count == first + 1 && all->at[first].count == part.count)
      all->count = first; /* all of them: the frame is as fine as doubles can tell */
  }
  if (all->count > first) parts_last(all, &all->at[number], first);
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

/* Builds the tree of a part, in a frame of that size about `middle`; of one of the `roots` first parts, also over the
 * hulls of all that were set apart from it. */
static enum status build(const struct parts *all, size_t part_number, size_t roots, const double middle[3],
                         double frame, struct model_tree *out)
{
  const struct part *part = &all->at[part_number];
  const size_t most = part->count + (part_number < roots ? all->count - roots : 0);
  const bool alone = all->count == 1; /* nobody else needs the boxes: no copies of them */
  size_t count = part->count;
  *out = (struct model_tree){.frame = frame};
  for (int k = 0; k < 3; k++) out->origin[k] = all->about[k] + middle[k];
  struct bvh_box *own = alone ? all->boxes : memory_alloc(most + 1, sizeof *own);
  uint32_t *number = alone ? part->index : memory_alloc(most + 1, sizeof *number);
  enum status status = own && number ? STATUS_OK : STATUS_LIMIT;
  for (size_t k = 0; k < count && status == STATUS_OK; k++) {
    number[k] = alone ? (uint32_t)k : part->index[k];
    own[k] = all->boxes[number[k]];
  }
  for (size_t n = roots; part_number < roots && n < all->count && status == STATUS_OK; n++) {
    if (all->at[n].twins != part->twins) continue;
    own[count] = all->at[n].hull;
    number[count++] = (uint32_t)(all->model->leaf_count + all->model->copy_count + (n - roots));
  }
  for (size_t k = 0; k < count && status == STATUS_OK; k++) tree_box(middle, frame, &own[k]);
  if (status == STATUS_OK) status = bvh_build(own, count, all->team, &out->bvh);
  if (status == STATUS_OK) renumber_leaves(&out->bvh, number);
  if (!alone) memory_free(own), memory_free(number);
  return status;
}

/* The size of a part's own frame. */
static double part_frame(const struct part *part)
{
  int exponent;
  frexp(real_max(box_extent(&part->hull) / 2, LEAST_FRAME), &exponent);
  return ldexp(1, exponent);
}

/* Builds all trees. The roots have the scene's frame. */
static enum status build_all(const struct parts *all, size_t roots, struct model *model, const double middle[3])
{
  const double frame = model->tree.frame;
  model->inner = arena_alloc(model->arena, all->count - roots + 1, sizeof *model->inner);
  enum status status = model->inner ? STATUS_OK : STATUS_LIMIT;
  for (size_t n = roots; n < all->count && status == STATUS_OK; n++) {
    const struct part *part = &all->at[n];
    double center[3];
    for (int k = 0; k < 3; k++) center[k] = box_center(&part->hull, k);
    status = build(all, n, roots, center, part_frame(part), &model->inner[model->inner_count++]);
  }
  if (status == STATUS_OK) status = build(all, 0, roots, middle, frame, &model->tree);
  if (status == STATUS_OK && roots > 1) status = build(all, 1, roots, middle, frame, &model->twins);
  return status;
}

/* Whether all in that box lies exactly on something earlier in the scene, whose hit is then the nearest. */
static bool is_twin(const struct model *model, uint32_t box)
{
  if (!model->twin) return false;
  if (box >= model->leaf_count) return model->copies[box - model->leaf_count].twin;
  return model->twin[model->leaves ? model->leaves[box].patch : model->places[box].patch];
}

/* Moves twins to the end; returns how many other boxes there are. */
static size_t twins_last(const struct model *model, uint32_t index[], size_t count)
{
  size_t others = 0;
  for (size_t k = 0; k < count; k++) {
    const uint32_t here = index[k];
    if (!is_twin(model, here)) index[k] = index[others], index[others++] = here;
  }
  return others;
}

enum status tree_build(struct model *model, struct bvh_box boxes[], const struct team *team)
{
  const size_t count = model->leaf_count + model->copy_count;
  const struct model_tree *tree = &model->tree;
  struct parts all = {.model = model, .boxes = boxes, .team = team};
  double middle[3];
  for (int k = 0; k < 3; k++) all.about[k] = tree_about(tree, k), middle[k] = tree->origin[k] - all.about[k];
  uint32_t *index = memory_alloc(count + 1, sizeof *index);
  if (!index) return STATUS_LIMIT;
  for (size_t k = 0; k < count; k++) index[k] = (uint32_t)k;
  const size_t others = twins_last(model, index, count), roots = others < count ? 2 : 1;
  part_add(&all, index, others, false);
  if (others < count) part_add(&all, index + others, count - others, true);
  for (size_t n = 0; n < all.count && !all.failed; n++)
    set_apart(&all, n, n < roots ? tree->frame : part_frame(&all.at[n]));
  const enum status status = all.failed ? STATUS_LIMIT : build_all(&all, roots, model, middle);
  memory_free(all.at);
  memory_free(index);
  return status;
}

/* ---- what rays meet in a tree ---- */

/* The area of a leaf: that of the face, across its normal, of the box along it. */
static double leaf_area(const struct oriented_box *box)
{
  double g[3][3], normal[3];
  for (int q = 0; q < 3; q++)
    for (int k = 0; k < 3; k++) g[q][k] = (double)box->g[k][q];
  vector_cross(g[1], g[2], normal);
  const double area = 4 * (double)box->half[1] * (double)box->half[2] * vector_length(g[0]) /
                      fabs(vector_dot(g[0], normal));
  return isfinite(area) ? area : 0;
}

/* The crossings in a leaf child's box, times the surface of the box. */
static double crossings_in(const struct model *model, uint32_t box, double surface)
{
  if (model_is_tree(model, box)) return model_inner(model, box)->crossings * surface;
  if (box >= model->leaf_count) return model->copies[box - model->leaf_count].object->model->tree.crossings * surface;
  return 2 * leaf_area(&model->oriented[box]);
}

/* A line through a convex body of surface S makes 2 A / S crossings on average, where A is the area of what is in it
 * (Crofton's formula). */
static void count_crossings(const struct model *model, struct model_tree *tree)
{
  struct bvh_box whole = BVH_EMPTY;
  double sum = 0;
  for (size_t n = 0; n < BVH_WIDTH * tree->bvh.node_count; n++) {
    const struct bvh_node *node = &tree->bvh.nodes[n / BVH_WIDTH];
    const size_t side = n % BVH_WIDTH;
    const uint32_t child = node->child[side];
    struct bvh_box box;
    if (child == 0) continue;
    for (int k = 0; k < 3; k++) box.lo[k] = (double)node->lo[k][side], box.hi[k] = (double)node->hi[k][side];
    if (n < BVH_WIDTH) bvh_box_add(&whole, &box);
    if (child & BVH_LEAF) sum += crossings_in(model, child & ~BVH_LEAF, box_surface(&box));
  }
  const double surface = box_surface(&whole);
  tree->crossings = surface > 0 ? sum / surface : 0;
}

void tree_finish(struct model *model)
{
  for (size_t k = 0; k < model->inner_count; k++) count_crossings(model, &model->inner[k]);
  count_crossings(model, &model->tree);
}

void tree_free(struct model *model)
{
  for (size_t k = 0; k < model->inner_count; k++) bvh_free(&model->inner[k].bvh);
  bvh_free(&model->tree.bvh), bvh_free(&model->twins.bvh);
}
