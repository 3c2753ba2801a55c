/* From patches to the hierarchy: patches are cut, their leaves are made, the leaves' boxes are put in order.
 *
 * Threads of a team take parts of the patches, one after the other: first to cut the patches; then, once it is known
 * where each patch's leaves begin, to make these. Any number of threads makes the same bits.
 */
#include "intersect/prepare/hierarchy.h"

#include <assert.h>
#include <stdatomic.h>

#include "base/memory.h"
#include "intersect/prepare/copies.h"
#include "intersect/prepare/cut.h"
#include "intersect/prepare/leaf.h"
#include "intersect/prepare/patch.h"
#include "intersect/prepare/tree.h"

/* Patches and their leaves while they are made. */
struct making {
  struct model *model;
  const struct team *team;
  struct cut_limit limit;
  bool keep;               /* whether patches and leaves are kept */
  struct arena **arenas;   /* one a thread, for what is kept: patches first, then leaves */
  size_t part, part_count; /* patches in a part; threads take whole parts */
  size_t *leaves;          /* in each part; later before it */
  struct cells cells;      /* while patches are cut */
  struct bvh_box *boxes;   /* if leaves are not kept, with room for boxes along them */
  atomic_size_t taken;     /* parts */
};

/* How many leaves a patch is cut into. */
static size_t cut_leaves(const struct model_cut *cut) { return (size_t)cut->split[0] * cut->split[1]; }

/* Takes a part that nobody has taken: its patches are [*begin, *end). False if there is none. */
static bool making_take_part(struct making *m, size_t *number, size_t *begin, size_t *end)
{
  *number = atomic_fetch_add(&m->taken, 1);
  const size_t count = m->model->scene->patch_count;
  *begin = *number * m->part, *end = count - *begin < m->part ? count : *begin + m->part;
  return *number < m->part_count;
}

/* Has all parts done, by the team if there are enough patches or leaves. */
static enum status making_do_parts(struct making *m, team_work *work, size_t count)
{
  atomic_store(&m->taken, 0);
  return team_run(count < TEAM_LEAST ? NULL : m->team, m->part_count, work, m);
}

/* Threads take one of this many parts of the patches at once. */
enum { PARTS = 1024 };

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

/* Makes patches that are kept. */
static enum status make_patches(void *context, size_t worker)
{
  struct making *m = context;
  void *rest = NULL;
  for (size_t part, p, end; making_take_part(m, &part, &p, &end);) {
    for (; p < end; p++) {
      struct model_patch *patch = &m->model->patches[p];
      if (!rest && !(rest = arena_alloc(m->arenas[worker], 1, sizeof(double[3][4][4])))) return STATUS_LIMIT;
      patch_make(m->model, (uint32_t)p, patch, rest);
      if ((const void *)patch->rest == rest) rest = NULL;
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

/* Cuts the patches, and counts the leaves. */
static enum status cut_part(void *context, size_t worker)
{
  struct making *m = context;
  struct model *model = m->model;
  (void)worker;
  for (size_t part, p, end; making_take_part(m, &part, &p, &end);) {
    for (; p < end; p++) {
      struct patch_room room;
      struct model_cut *cut = &model->cuts[p];
      if (cut->copied) continue;
      struct model_patch *patch = model_patch_at(model, (uint32_t)p, &room);
      const int fixed = patch->method->split < model->most_split ? patch->method->split : model->most_split;
      double lo[3], hi[3];
      points_range((const double(*)[4][3])model->scene->patches[p].P, lo, hi);
      /* The leaves of a point are all at one place: a ray would be tried on each of them. */
      if (lo[0] == hi[0] && lo[1] == hi[1] && lo[2] == hi[2]) cut->split[0] = cut->split[1] = 1;
      else if (fixed > 0) cut->split[0] = cut->split[1] = (uint16_t)fixed;
      else patch_cut(patch, &m->cells, &m->limit, cut->split);
      patch->cut = *cut;
      m->leaves[part] += cut_leaves(cut);
    }
  }
  return STATUS_OK;
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
  enum status status = m->keep ? making_do_parts(m, make_patches, count) : STATUS_OK;
  if (status == STATUS_OK && m->keep) status = cells_fill(model, &m->cells);
  if (status == STATUS_OK) status = making_do_parts(m, cut_part, count);
  cells_free(&m->cells);
  sum_leaves(m);
  return status;
}

/* ---- leaves ---- */

/* Makes the leaves of patch p, from number l on, and of their boxes those that there is room for. */
static void patch_leaves(struct making *m, size_t p, size_t l)
{
  struct model *model = m->model;
  struct patch_room room;
  struct leaf made;
  const struct model_patch *patch = model_patch_at(model, (uint32_t)p, &room);
  const size_t count = cut_leaves(&patch->cut);
  for (size_t k = 0; k < count; k++, l++) {
    struct leaf *leaf = m->keep ? &model->leaves[l] : &made;
    leaf_make(patch, (uint32_t)p, (uint32_t)k, leaf);
    if (model->places) model->places[l] = (struct leaf_place){(uint32_t)p, leaf->column_u, leaf->column_v};
    if (m->boxes) leaf_box(model, patch, leaf->x, &m->boxes[l]);
    if (!model->oriented) continue;
    leaf_orient(&model->tree, model->error, patch, leaf->slab, &model->oriented[l]);
    model->oriented[l].patch = (uint32_t)p;
  }
}

/* Makes the leaves of all patches, from where they begin on. If leaves are not kept they are made twice: first for their
 * boxes; once the hierarchy is built, and model->oriented has its room, for the boxes along them. */
static enum status make_leaves(void *context, size_t worker)
{
  struct making *m = context;
  (void)worker;
  for (size_t part, p, end; making_take_part(m, &part, &p, &end);) {
    size_t l = m->leaves[part];
    for (; p < end; p++) {
      const struct model_cut *cut = &m->model->cuts[p];
      if (cut->copied) continue;
      patch_leaves(m, p, l);
      l += cut_leaves(cut);
    }
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
static void orient_inner(struct model *model)
{
  for (size_t k = 0; k < model->inner_count; k++) {
    const struct model_tree *tree = &model->inner[k];
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
  if (status == STATUS_OK) orient_inner(model);
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

enum status hierarchy_make(struct model *model, const struct team *team, const struct cut_limit *limit, bool keep,
                           size_t keep_most)
{
  struct making m = {.model = model, .team = team, .limit = *limit, .keep = keep};
  enum status status = cut_patches(&m);
  if (status == STATUS_OK && model->leaf_count > keep_most) m.keep = false, model->patches = NULL;
  end_arenas(&m, m.keep);
  if (status == STATUS_OK) status = make_tree(&m);
  end_arenas(&m, m.keep);
  memory_free(m.arenas);
  memory_free(m.leaves);
  memory_free(m.boxes);
  return status;
}
