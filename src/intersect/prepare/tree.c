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

/* Boxes that get their own tree: index[first .. first + count - 1]. */
struct box_group {
  size_t first, count;
  struct bvh_box hull;
};

/* The boxes of a tree, and the groups of them that are set apart. */
struct grouping {
  const struct bvh_box *boxes;
  uint32_t *index;
  double frame;
  struct box_group *groups;
  size_t count, room;
  bool failed; /* memory was short */
};

static void group_add(struct grouping *g, const struct box_group *group)
{
  struct box_group *grown = memory_grow(g->groups, &g->room, g->count + 1, sizeof *grown);
  g->failed |= !grown;
  if (grown) g->groups = grown, g->groups[g->count++] = *group;
}

static struct bvh_box hull_of(const struct grouping *g, size_t first, size_t count)
{
  struct bvh_box hull = BVH_EMPTY;
  for (size_t k = first; k < first + count; k++) bvh_box_add(&hull, &g->boxes[g->index[k]]);
  return hull;
}

/* Moves boxes larger than `extent` to the front; returns how many there are. */
static size_t larger_first(struct grouping *g, size_t first, size_t count, double extent)
{
  size_t large = 0;
  for (size_t k = 0; k < count; k++) {
    const uint32_t here = g->index[first + k];
    if (box_extent(&g->boxes[here]) > extent)
      g->index[first + k] = g->index[first + large], g->index[first + large++] = here;
  }
  return large;
}

/* Moves boxes whose centers are below `place` on the axis to the front; returns how many there are. */
static size_t lower_first(struct grouping *g, const struct box_group *all, int axis, double place)
{
  size_t lower = 0;
  for (size_t k = all->first; k < all->first + all->count; k++) {
    const uint32_t here = g->index[k];
    if (box_center(&g->boxes[here], axis) < place)
      g->index[k] = g->index[all->first + lower], g->index[all->first + lower++] = here;
  }
  return lower;
}

/* Finds the groups among these boxes, which are tiny, by halving the space that they fill. Both halves have some,
 * because the hull is far larger than the boxes. */
static void find_groups(struct grouping *g, size_t first, size_t count)
{
  if (count < GROUP_LEAST) return;
  const struct box_group all = {first, count, hull_of(g, first, count)};
  if (box_extent(&all.hull) <= SMALL_PART * g->frame) {
    group_add(g, &all);
    return;
  }
  int axis = 0;
  for (int k = 1; k < 3; k++)
    if (all.hull.hi[k] - all.hull.lo[k] > all.hull.hi[axis] - all.hull.lo[axis]) axis = k;
  const size_t lower = lower_first(g, &all, axis, box_center(&all.hull, axis));
  find_groups(g, first, lower);
  find_groups(g, first + lower, count - lower);
}

/* Moves the groups, which are in order, behind all other boxes; returns how many these are. */
static size_t groups_last(struct grouping *g, size_t count)
{
  uint32_t *moved = memory_alloc(count, sizeof *moved);
  g->failed |= !moved;
  if (!moved) return count;
  size_t stay = 0, behind = 0, from = 0;
  for (size_t n = 0; n < g->count; n++) {
    struct box_group *group = &g->groups[n];
    memcpy(moved + behind, g->index + group->first, group->count * sizeof *moved);
    for (; from < group->first; from++) g->index[stay++] = g->index[from];
    from += group->count, behind += group->count;
  }
  for (; from < count; from++) g->index[stay++] = g->index[from];
  memcpy(g->index + stay, moved, behind * sizeof *moved);
  memory_free(moved);
  for (size_t n = 0, first = stay; n < g->count; first += g->groups[n++].count) g->groups[n].first = first;
  return stay;
}

/* Finds the groups to set apart, and moves them to the end; returns how many boxes stay. */
static size_t set_apart(struct grouping *g, size_t count)
{
  const size_t large = larger_first(g, 0, count, SMALL_BOX * g->frame);
  const struct box_group small = {large, count - large, hull_of(g, large, count - large)};
  if (large > 0 && small.count > 1 && box_extent(&small.hull) <= SMALL_PART * g->frame) {
    group_add(g, &small);
    return large;
  }
  const size_t larger = large + larger_first(g, large, small.count, TINY_BOX * g->frame);
  find_groups(g, larger, count - larger);
  if (g->count == 1 && g->groups->count == count)
    g->count = 0; /* all of them: the frame is as fine as doubles can tell */
  return g->count > 0 ? groups_last(g, count) : count;
}

void tree_box(const double middle[3], double frame, struct bvh_box *box)
{
  for (int k = 0; k < 3; k++) {
    const double slack = 4 * UNIT_ROUNDOFF * (real_max(fabs(box->lo[k]), fabs(box->hi[k])) + fabs(middle[k]));
    box->lo[k] = (box->lo[k] - middle[k] - slack) / frame, box->hi[k] = (box->hi[k] - middle[k] + slack) / frame;
  }
}

/* What the trees are built from: all boxes of the model, given less tree_about. */
struct building {
  const struct model *model;
  struct bvh_box *boxes;
  size_t count;
  double about[3];
  const struct team *team;
};

/* Gives the leaves of the hierarchy the numbers of their boxes. Its last boxes are the hulls of groups, if any. */
static void renumber_leaves(const struct building *b, struct bvh *bvh, const uint32_t index[], size_t stay)
{
  for (size_t n = 0; n < bvh->node_count; n++) {
    for (int side = 0; side < BVH_WIDTH; side++) {
      uint32_t *child = &bvh->nodes[n].child[side];
      const uint32_t box = *child & ~BVH_LEAF;
      const uint32_t number = box < stay ? index[box] : (uint32_t)(b->count + (box - stay));
      if (*child & BVH_LEAF) *child = BVH_LEAF | number;
    }
  }
}

static enum status build(const struct building *b, int depth, uint32_t index[], size_t count, const double middle[3],
                         double frame, struct model_tree *out);

/* Builds the hierarchy of the boxes that stay in that frame, and of the groups' hulls. */
static enum status build_outer(const struct building *b, const struct grouping *g, size_t stay, const double middle[3],
                               struct model_tree *out)
{
  const bool all = stay == b->count; /* nobody else needs the boxes: no copies of them */
  struct bvh_box *own = all ? b->boxes : memory_alloc(stay + g->count + 1, sizeof *own);
  if (!own) return STATUS_LIMIT;
  for (size_t k = 0; k < stay; k++) {
    if (all) g->index[k] = (uint32_t)k;
    own[k] = b->boxes[g->index[k]];
    tree_box(middle, g->frame, &own[k]);
  }
  for (size_t k = 0; k < g->count; k++) own[stay + k] = g->groups[k].hull, tree_box(middle, g->frame, &own[stay + k]);
  const enum status status = bvh_build(own, stay + g->count, b->team, &out->bvh);
  if (!all) memory_free(own);
  if (status == STATUS_OK) renumber_leaves(b, &out->bvh, g->index, stay);
  return status;
}

/* Builds the trees of the groups. */
static enum status build_inner(const struct building *b, int depth, const struct grouping *g, struct model_tree *out)
{
  out->inner = arena_alloc(b->model->arena, g->count, sizeof *out->inner);
  if (!out->inner) return STATUS_LIMIT;
  enum status status = STATUS_OK;
  for (size_t n = 0; n < g->count && status == STATUS_OK; n++) {
    const struct box_group *group = &g->groups[n];
    double center[3];
    int exponent;
    for (int k = 0; k < 3; k++) center[k] = box_center(&group->hull, k);
    frexp(real_max(box_extent(&group->hull) / 2, LEAST_FRAME), &exponent);
    out->inner_count++;
    status = build(b, depth, g->index + group->first, group->count, center, ldexp(1, exponent), &out->inner[n]);
  }
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

/* Builds a tree of boxes[index[0..count-1]], within `depth` others, in a frame of size `frame` about `middle`, which is
 * given as they are. */
static enum status build(const struct building *b, int depth, uint32_t index[], size_t count, const double middle[3],
                         double frame, struct model_tree *out)
{
  struct grouping g = {.boxes = b->boxes, .index = index, .frame = frame};
  const size_t stay = depth + 1 < MODEL_FRAMES ? set_apart(&g, count) : count;
  *out = (struct model_tree){.frame = frame};
  for (int k = 0; k < 3; k++) out->origin[k] = b->about[k] + middle[k];
  enum status status = g.failed ? STATUS_LIMIT : build_outer(b, &g, stay, middle, out);
  if (status == STATUS_OK && g.count > 0) status = build_inner(b, depth + 1, &g, out);
  memory_free(g.groups);
  return status;
}

enum status tree_build(struct model *model, struct bvh_box boxes[], const struct team *team)
{
  const size_t count = model->leaf_count + model->copy_count;
  struct model_tree *tree = &model->tree;
  struct building all = {.model = model, .boxes = boxes, .count = count, .team = team};
  const double frame = tree->frame;
  double middle[3];
  for (int k = 0; k < 3; k++) all.about[k] = tree_about(tree, k), middle[k] = tree->origin[k] - all.about[k];
  uint32_t *index = memory_alloc(count + 1, sizeof *index);
  if (!index) return STATUS_LIMIT;
  for (size_t k = 0; k < count; k++) index[k] = (uint32_t)k;
  const size_t others = twins_last(model, index, count);
  enum status status = build(&all, 0, index, others, middle, frame, tree);
  if (status == STATUS_OK && others < count)
    status = build(&all, 0, index + others, count - others, middle, frame, &model->twins);
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
static double crossings_in(const struct model *model, const struct model_tree *tree, uint32_t box, double surface)
{
  if (model_is_tree(model, box)) return model_inner(model, tree, box)->crossings * surface;
  if (box >= model->leaf_count) return model->copies[box - model->leaf_count].object->model->tree.crossings * surface;
  return 2 * leaf_area(&model->oriented[box]);
}

/* Surfaces of boxes; as many lines meet a box. */
struct surfaces {
  double whole, nodes, leaves; /* of the tree; sums over the boxes of its nodes, and over those of leaves */
  double crossings;            /* sum of crossings_in */
};

static void measure(const struct model *model, const struct model_tree *tree, struct surfaces *out)
{
  struct bvh_box whole = BVH_EMPTY;
  *out = (struct surfaces){0};
  for (size_t n = 0; n < BVH_WIDTH * tree->bvh.node_count; n++) {
    const struct bvh_node *node = &tree->bvh.nodes[n / BVH_WIDTH];
    const size_t side = n % BVH_WIDTH;
    const uint32_t child = node->child[side];
    struct bvh_box box;
    for (int k = 0; k < 3; k++) box.lo[k] = (double)node->lo[k][side], box.hi[k] = (double)node->hi[k][side];
    if (child == 0) continue;
    const double surface = box_surface(&box);
    const uint32_t number = child & ~BVH_LEAF;
    if (n < BVH_WIDTH) bvh_box_add(&whole, &box);
    if (child == number) out->nodes += surface;
    else out->crossings += crossings_in(model, tree, number, surface);
    if (child != number && number < model->leaf_count) out->leaves += surface;
  }
  out->whole = box_surface(&whole), out->nodes += out->whole;
}

/* The boxes along a node's leaf children, side by side. */
static void set_four(const struct model *model, const struct bvh_node *node, struct oriented_four *four)
{
  for (int side = 0; side < BVH_WIDTH; side++) {
    const uint32_t box = node->child[side] & ~BVH_LEAF;
    const bool leaf = node->child[side] != box && box < model->leaf_count;
    const struct oriented_box all = {.half = {INFINITY, INFINITY, INFINITY}},
                              *from = leaf ? &model->oriented[box] : &all;
    for (int q = 0; q < 3; q++) {
      for (int k = 0; k < 3; k++) four->g[k][q][side] = from->g[k][q];
      four->offset[q][side] = from->offset[q], four->half[q][side] = from->half[q];
    }
  }
}

/* Sets tree->along where surfaces lie behind one another, as sheets do, so that a line that comes to a node meets more
 * than one box of a leaf there. With fewer, reading them takes longer than it saves; and for leaves that are not kept
 * there is no room. */
static bool set_along(const struct model *model, const struct surfaces *s, struct model_tree *tree)
{
  if (tree->crossings < MANY_CROSSINGS || s->leaves <= s->nodes || !model->leaves) return true;
  tree->along = arena_alloc(model->arena, tree->bvh.node_count, sizeof *tree->along);
  for (size_t n = 0; tree->along && n < tree->bvh.node_count; n++)
    set_four(model, &tree->bvh.nodes[n], &tree->along[n]);
  return tree->along;
}

static bool finish(const struct model *model, struct model_tree *tree)
{
  for (size_t k = 0; k < tree->inner_count; k++)
    if (!finish(model, &tree->inner[k])) return false;
  struct surfaces s;
  measure(model, tree, &s);
  tree->crossings = s.whole > 0 ? s.crossings / s.whole : 0;
  return set_along(model, &s, tree);
}

enum status tree_finish(struct model *model) { return finish(model, &model->tree) ? STATUS_OK : STATUS_LIMIT; }

void tree_free(struct model_tree *tree)
{
  for (size_t k = 0; k < tree->inner_count; k++) tree_free(&tree->inner[k]);
  bvh_free(&tree->bvh);
}
