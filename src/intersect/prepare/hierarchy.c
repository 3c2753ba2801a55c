/* From patches to the hierarchy: patches are cut, their leaves are made, the leaves' boxes are put in order.
 *
 * Threads of a team take parts of the patches, one after the other: first to cut the patches; then, once it is known
 * where each patch's leaves begin, to make these. Any number of threads makes the same bits.
 */
#include "intersect/prepare/hierarchy.h"

#include <assert.h>

#include "base/memory.h"
#include "intersect/prepare/copies.h"
#include "intersect/prepare/crowd.h"
#include "intersect/prepare/leaf.h"
#include "intersect/prepare/making.h"
#include "intersect/prepare/patch.h"
#include "intersect/prepare/tree.h"

/* Threads take one of this many parts of the patches at once. */
enum { PARTS = 1024 };

/* Room for what not every patch or leaf has: *room, or new room if that is used up. */
static bool next_room(struct arena *arena, void **room, size_t size)
{
  if (!*room) *room = arena_alloc(arena, 1, size);
  return *room != NULL;
}

/* Gives the model what has been made, if it is kept; else frees it. */
static void end_arenas(struct making *m, bool keep)
{
  for (size_t k = 0; m->arenas && k < team_count(m->team); k++) {
    if (keep) arena_join(m->model->arena, m->arenas[k]);
    else arena_destroy(m->arenas[k]);
    m->arenas[k] = NULL;
  }
}

static bool begin_arenas(struct making *m)
{
  for (size_t k = 0; k < team_count(m->team); k++)
    if ((m->arenas[k] = arena_create()) == NULL) return false;
  return true;
}

/* ---- patches ---- */

/* Makes the patches, cuts each, and counts the leaves. */
static enum status make_patches(void *context, size_t worker)
{
  struct making *m = context;
  struct model *model = m->model;
  void *rest = NULL;
  for (size_t part, p, end; making_take_part(m, &part, &p, &end);) {
    for (; p < end; p++) {
      struct patch_room room;
      struct model_patch *patch = m->keep ? &model->patches[p] : &room.patch;
      const struct model_cut *cut = &model->cuts[p];
      if (cut->copied && !m->keep) continue;
      if (m->keep && !next_room(m->arenas[worker], &rest, sizeof room.rest)) return STATUS_LIMIT;
      patch_make_first(model, (uint32_t)p, &m->limit, patch, m->keep ? rest : room.rest);
      if ((const void *)patch->rest == rest) rest = NULL;
      if (!cut->copied) m->leaves[part] += cut_leaves(cut);
    }
  }
  return STATUS_OK;
}

/* Turns the number of leaves in each part into the number before it, and sets the total. */
static void sum_leaves(struct making *m)
{
  m->model->leaf_count = 0;
  for (size_t k = 0; k < m->part_count; k++) {
    const size_t here = m->leaves[k];
    m->leaves[k] = m->model->leaf_count;
    m->model->leaf_count += here;
  }
}

/* A picture shows one layer of the surfaces that a line crosses. With more leaves than this in a layer, few rays of a
 * packet meet the same leaf, and none finds a leaf in the processor's caches: fewer and larger leaves, although each
 * costs more, cost less. */
enum { LAYER_LEAVES = 1 << 15 };

/* Whether there are more than `most` leaves in a layer, of patches that are kept. Layers are the tree's `crossings`,
 * computed from patches. */
static bool too_many(const struct model *model, size_t most)
{
  if (model->leaf_count <= most) return false;
  const double frame = model->tree.frame;
  struct bvh_box box = BVH_EMPTY;
  double area = 0;
  for (size_t p = 0; p < model->scene->patch_count; p++) {
    if (model->cuts[p].copied) continue;
    box_add_net(&box, model->scene->patches[p].P);
    const double scale = model->patches[p].scale / frame;
    area += scale * scale * patch_net_area(&model->patches[p]);
  }
  for (int k = 0; k < 3; k++) box.lo[k] /= frame, box.hi[k] /= frame;
  const double layers = 2 * area / box_surface(&box);
  return (double)model->leaf_count > (double)most * (layers > 1 ? layers : 1);
}

static enum status cut_part_again(void *context, size_t worker)
{
  struct making *m = context;
  struct model *model = m->model;
  (void)worker;
  for (size_t part, p, end; making_take_part(m, &part, &p, &end);) {
    m->leaves[part] = 0;
    for (; p < end; p++) {
      const struct model_cut *cut = &model->cuts[p];
      if (cut->copied) continue;
      patch_cut_again(model, (uint32_t)p, &m->limit, &model->patches[p]);
      m->leaves[part] += cut_leaves(cut);
    }
  }
  return STATUS_OK;
}

static enum status cut_coarser(struct making *m)
{
  enum status status = STATUS_OK;
  size_t most = LAYER_LEAVES;
  for (int k = 0; k < COARSER && status == STATUS_OK && too_many(m->model, most); k++, most *= 4) {
    m->limit.turn = m->limit.coarse[k];
    status = making_do_parts(m, cut_part_again, m->model->scene->patch_count);
    sum_leaves(m);
  }
  return status;
}

static enum status cut_patches(struct making *m)
{
  struct model *model = m->model;
  const size_t count = model->scene->patch_count;
  m->part = count / PARTS + 1, m->part_count = (count + m->part - 1) / m->part;
  m->leaves = memory_alloc(m->part_count, sizeof *m->leaves);
  m->arenas = memory_alloc(team_count(m->team), sizeof *m->arenas);
  if (!m->leaves || !m->arenas || !begin_arenas(m)) return STATUS_LIMIT;
  if (m->keep) model->patches = arena_alloc(m->arenas[0], count + 1, sizeof *model->patches);
  if (m->keep && !model->patches) return STATUS_LIMIT;
  const enum status status = making_do_parts(m, make_patches, count);
  sum_leaves(m);
  return status == STATUS_OK && m->keep ? cut_coarser(m) : status;
}

/* ---- leaves ---- */

/* Leaves of one patch that are made together before anything else is touched. */
enum { LEAVES_AT_ONCE = 32 };

struct leaf_run {
  size_t first, count; /* of the patch's leaves */
  uint16_t column[LEAVES_AT_ONCE][2];
};

/* The leaves after the run's; the run is {0} at first. False if there are none. */
static bool next_run(const struct model_patch *patch, struct leaf_run *run)
{
  const size_t row = patch->cut.split[1], all = patch->cut.split[0] * row;
  run->first += run->count;
  run->count = all - run->first < LEAVES_AT_ONCE ? all - run->first : LEAVES_AT_ONCE;
  for (size_t k = 0; k < run->count; k++)
    run->column[k][0] = (uint16_t)((run->first + k) / row), run->column[k][1] = (uint16_t)((run->first + k) % row);
  return run->count > 0;
}

/* Makes leaves that are kept: those of patch p, from number l on. */
static enum status keep_leaves(struct making *m, struct arena *arena, size_t p, size_t l, void **form)
{
  struct model *model = m->model;
  const struct model_patch *patch = &model->patches[p];
  for (struct leaf_run run = {0}; next_run(patch, &run);) {
    leaves_make(patch, (uint32_t)p, (uint32_t)run.first, run.count, &model->leaves[l]);
    for (size_t k = 0; k < run.count; k++, l++) {
      struct leaf *leaf = &model->leaves[l];
      if (!next_room(arena, form, sizeof *leaf->form)) return STATUS_LIMIT;
      leaf_set_form(patch, leaf, *form);
      if (leaf->form) *form = NULL;
      leaf_box(model, patch, leaf->x, &m->boxes[l]);
      leaf_orient(&model->tree, model->error, patch, leaf->slab, &model->oriented[l]);
      model->oriented[l].patch = (uint32_t)p;
    }
  }
  return STATUS_OK;
}

/* For leaves that are not kept, sets only where they are, and their boxes. */
static void place_leaves(struct making *m, size_t p, size_t l)
{
  struct model *model = m->model;
  struct patch_room room;
  const struct model_patch *patch = &room.patch;
  patch_make(model, (uint32_t)p, &room.patch, room.rest);
  const struct part_grid grid = {{patch->cut.split[0], patch->cut.split[1]}, {1, 1}, 0};
  for (struct leaf_run run = {0}; next_run(patch, &run);) {
    struct patch_part part[LEAVES_AT_ONCE];
    patch_parts(patch, &grid, run.count, (const uint16_t(*)[2])run.column, part);
    for (size_t k = 0; k < run.count; k++, l++) {
      model->places[l] = (struct leaf_place){(uint32_t)p, run.column[k][0], run.column[k][1]};
      leaf_box(model, patch, part[k].x, &m->boxes[l]);
    }
  }
}

/* Makes the boxes along leaves that are not kept. */
static void orient_leaves(struct making *m, size_t p, size_t l)
{
  const struct model *model = m->model;
  struct patch_room room;
  const struct model_patch *patch = &room.patch;
  patch_make(model, (uint32_t)p, &room.patch, room.rest);
  for (struct leaf_run run = {0}; next_run(patch, &run);) {
    struct leaf_slab slab[LEAVES_AT_ONCE][3];
    leaf_slabs(patch, run.count, (const uint16_t(*)[2])run.column, slab);
    for (size_t k = 0; k < run.count; k++, l++) {
      leaf_orient(&model->tree, model->error, patch, slab[k], &model->oriented[l]);
      model->oriented[l].patch = (uint32_t)p;
    }
  }
}

/* Makes the leaves of all patches, from where they begin on. If leaves are not kept: first their boxes for the
 * hierarchy; once that is built, and model->oriented has its room, the boxes along them. */
static enum status make_leaves(void *context, size_t worker)
{
  struct making *m = context;
  void *form = NULL;
  for (size_t part, p, end; making_take_part(m, &part, &p, &end);) {
    size_t l = m->leaves[part];
    for (; p < end; p++) {
      const struct model_cut *cut = &m->model->cuts[p];
      if (cut->copied) continue;
      if (!m->keep && m->model->oriented) orient_leaves(m, p, l);
      else if (!m->keep) place_leaves(m, p, l);
      else if (keep_leaves(m, m->arenas[worker], p, l, &form) != STATUS_OK) return STATUS_LIMIT;
      l += cut_leaves(cut);
    }
    if (m->keep) leaf_quadrics(l - m->leaves[part], &m->model->leaves[m->leaves[part]]);
  }
  return STATUS_OK;
}

/* Where boxes along leaves begin, each in one line of the caches, in room for one box more. */
static struct oriented_box *oriented_in(struct model *model, void *room)
{
  enum { LINE = sizeof(struct oriented_box) };
  memory_used_anywhere(room, (model->leaf_count + 1) * LINE);
  return (struct oriented_box *)(void *)((char *)room + (LINE - (uintptr_t)room % LINE) % LINE);
}

/* Room for leaves that are kept and their boxes, in huge pages; or for the places of those that are not kept. */
static bool make_room(struct making *m)
{
  struct model *model = m->model;
  const size_t count = model->leaf_count + 1;
  m->boxes = memory_alloc(count + model->copy_count, m->keep ? sizeof *m->boxes : sizeof *model->oriented);
  if (!m->boxes) return false;
  if (!m->keep) {
    model->places = arena_alloc(model->arena, model->leaf_count, sizeof *model->places);
    return model->places;
  }
  model->leaves = arena_alloc(m->arenas[0], count, sizeof *model->leaves);
  void *oriented = arena_alloc(m->arenas[0], count, sizeof *model->oriented);
  if (!model->leaves || !oriented) return false;
  memory_used_anywhere(model->leaves, count * sizeof *model->leaves);
  model->oriented = oriented_in(model, oriented);
  return true;
}

/* ---- the hierarchy ---- */

/* Makes the boxes along the leaves of inner trees anew, in these trees' frames. */
static void orient_inner(struct model *model, const struct model_tree *whole)
{
  for (size_t k = 0; k < whole->inner_count; k++) {
    const struct model_tree *tree = &whole->inner[k];
    orient_inner(model, tree);
    for (size_t n = 0; n < BVH_WIDTH * tree->bvh.node_count; n++) {
      const uint32_t child = tree->bvh.nodes[n / BVH_WIDTH].child[n % BVH_WIDTH], box = child & ~BVH_LEAF;
      if (child == box || box >= model->leaf_count) continue;
      struct leaf_room room;
      if (!model->leaves) model_make_leaf(model, box, &room);
      const struct leaf *leaf = model->leaves ? &model->leaves[box] : &room.leaf;
      const struct model_patch *patch = model->leaves ? &model->patches[leaf->patch] : &room.of.patch;
      leaf_orient(tree, model->error, patch, leaf->slab, &model->oriented[box]);
    }
  }
}

/* Makes the boxes along leaves that are still missing. If leaves are not kept, these take the memory of the boxes that
 * the hierarchy was built from and has used up: there would not be room for both. */
static enum status orient(struct making *m)
{
  struct model *model = m->model;
  enum status status = STATUS_OK;
  if (!m->keep) {
    static_assert(sizeof *m->boxes <= sizeof *model->oriented, "room for these");
    model->oriented_room = m->boxes, m->boxes = NULL;
    model->oriented = oriented_in(model, model->oriented_room);
    status = making_do_parts(m, make_leaves, model->leaf_count);
  }
  if (status == STATUS_OK) orient_inner(model, &model->tree), orient_inner(model, &model->twins);
  return status;
}

/* Makes the leaves, and the hierarchy of them. */
static enum status make_tree(struct making *m)
{
  struct model *model = m->model;
  enum status status = begin_arenas(m) && make_room(m) ? making_do_parts(m, make_leaves, model->leaf_count)
                                                       : STATUS_LIMIT;
  if (status != STATUS_OK) return status;
  /* copies are behind the leaves */
  for (size_t c = 0; c < model->copy_count; c++) copy_box(model, &model->copies[c], &m->boxes[model->leaf_count + c]);
  status = tree_build(model, m->boxes, m->team);
  return status == STATUS_OK ? orient(m) : status;
}

/* Makes leaves and hierarchy once more, after patches were cut anew. */
static enum status make_again(struct making *m)
{
  sum_leaves(m);
  end_arenas(m, false);
  tree_free(&m->model->tree), tree_free(&m->model->twins);
  memory_free(m->boxes), m->boxes = NULL;
  return make_tree(m);
}

enum status hierarchy_make(struct model *model, const struct team *team, const struct split_limit *limit, bool keep,
                           size_t keep_most)
{
  struct making m = {.model = model, .team = team, .limit = *limit, .keep = keep};
  enum status status = cut_patches(&m);
  if (status == STATUS_OK && model->leaf_count > keep_most) m.keep = false, model->patches = NULL;
  end_arenas(&m, m.keep);
  if (status == STATUS_OK) status = make_tree(&m);
  bool finer = false;
  if (status == STATUS_OK && m.keep) status = crowd_cut_finer(&m, &finer);
  if (status == STATUS_OK && finer) status = make_again(&m);
  if (status == STATUS_OK) status = tree_finish(model);
  end_arenas(&m, m.keep);
  memory_free(m.arenas);
  memory_free(m.leaves);
  memory_free(m.boxes);
  return status;
}
