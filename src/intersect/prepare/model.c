/* Preparing a scene: how far patches are cut, leaves, what copies share, the hierarchy. */
#include "intersect/model.h"

#include <assert.h>
#include <math.h>
#include <stdatomic.h>
#include <string.h>

#include "base/memory.h"
#include "base/real.h"
#include "geometry/twins.h"
#include "intersect/prepare/copies.h"
#include "intersect/prepare/leaf.h"
#include "intersect/prepare/patch.h"
#include "intersect/prepare/tree.h"

enum { AUTO_SPLIT_MAX = 16, BENT_SPLIT_MAX = 32 };

/* One Newton process holds on the whole of such a leaf for all but grazing rays; and where leaves are made when a ray comes to
 * them, fewer that turn farther are better. */
#define AUTO_TURN 0.25
#define BOXES_TURN 1.0

/* Leaves of all patches with `split auto` together: large scenes have small patches, and their leaves cost memory
 * and time to make. The limit on the split is halved until they fit. Of patches that are bent all over there may be more. */
enum { AUTO_LEAVES_MAX = 1 << 18, BENT_LEAVES_MAX = 1 << 19 };

/* The same of objects that are copied, whose leaves are kept, where those of other patches are not. */
enum { OBJECT_LEAVES_MAX = 1 << 20 };

/* Leaves that are not kept are no more than their boxes, an eighth of a leaf: with so many columns a side, of slender patches the square
 * of that along their long side, a patch takes a kilobyte at most. */
enum { BOXES_SPLIT_MAX = 2 };

/* What threads take at once is this part of the patches. */
enum { PARTS = 1024 };

/* Fewer patches or leaves are done before another thread has begun: one takes a microsecond or two. */
enum { TEAM_LEAST = 1024 };

/* A frame no smaller than this: its reciprocal times a direction is finite. */
#define LEAST_FRAME 0x1p-1000

/* Of a scene that reaches farther not even its own size is a number that can be squared, or doubled: nothing is
 * proven. */
#define LARGEST_SIZE 0x1p1020

/* The frame of the hierarchy, whose boxes are not made yet. */
static void set_frame(struct model *model)
{
  const struct scene *scene = model->scene;
  double lo[3] = {0}, hi[3] = {0};
  for (int k = 0; k < 3 && scene->patch_count > 0; k++) lo[k] = hi[k] = scene->patches[0].P[0][0][k];
  for (size_t p = 0; p < scene->patch_count; p++) {
    for (int n = 0; n < 16; n++) {
      const double *c = scene->patches[p].P[n / 4][n % 4];
      for (int k = 0; k < 3; k++) lo[k] = real_min(lo[k], c[k]), hi[k] = real_max(hi[k], c[k]);
    }
    model->unproven |= !scene->solvers[scene->patches[p].solver].polish;
  }
  for (int k = 0; k < 3; k++) model->size = real_max(model->size, real_max(fabs(lo[k]), fabs(hi[k])));
  model->unproven |= model->size > LARGEST_SIZE;
  double extent = model->size > 0 ? real_max(LEAST_EXTENT * model->size, LEAST_FRAME) : 1;
  for (int k = 0; k < 3; k++)
    model->tree.origin[k] = lo[k] / 2 + hi[k] / 2, extent = real_max(extent, hi[k] / 2 - lo[k] / 2);
  int exponent;
  frexp(extent, &exponent); /* extent < 2^exponent */
  model->tree.frame = real_power_of_two(exponent);
}

/* Patches and their leaves while they are made, by several threads where there are many. */
struct making {
  struct model *model;
  const struct team *team;
  struct split_limit limit;
  bool keep;               /* patches, and leaves; else they are only looked at */
  struct arena **arenas;   /* one a thread: of what is kept */
  size_t part, part_count; /* patches in a part */
  size_t *leaves;          /* in each part; then before it */
  struct bvh_box *boxes;   /* where leaves are not kept, as much room as boxes along them take */
  atomic_size_t taken;     /* parts */
};

/* The patches [*begin, *end) of a part that nobody has taken; false where there is none. */
static bool take_part(struct making *m, size_t *number, size_t *begin, size_t *end)
{
  *number = atomic_fetch_add(&m->taken, 1);
  const size_t count = m->model->scene->patch_count;
  *begin = *number * m->part, *end = count - *begin < m->part ? count : *begin + m->part;
  return *number < m->part_count;
}

/* The next room for what not every patch or leaf has: *room, or new where that has been used. */
static bool next_room(struct arena *arena, void **room, size_t size)
{
  if (!*room) *room = arena_alloc(arena, 1, size);
  return *room != NULL;
}

/* Patches, how far each is cut, and how many leaves there are. */
static enum status make_patches(void *context, size_t worker)
{
  struct making *m = context;
  struct model *model = m->model;
  void *rest = NULL;
  for (size_t part, p, end; take_part(m, &part, &p, &end);) {
    for (; p < end; p++) {
      struct patch_room room;
      struct model_patch *patch = m->keep ? &model->patches[p] : &room.patch;
      const struct model_cut *cut = &model->cuts[p];
      if (cut->copied && !m->keep) continue;
      if (m->keep && !next_room(m->arenas[worker], &rest, sizeof room.rest)) return STATUS_LIMIT;
      patch_make_first(model, (uint32_t)p, &m->limit, patch, m->keep ? rest : room.rest);
      if ((const void *)patch->rest == rest) rest = NULL;
      if (!cut->copied) m->leaves[part] += (size_t)cut->split[0] * cut->split[1];
    }
  }
  return STATUS_OK;
}

/* Leaves that are made one after the other without a look at anything else. */
enum { LEAVES_AT_ONCE = 32 };

static size_t leaves_of(const struct model_patch *patch) { return (size_t)patch->split[0] * (size_t)patch->split[1]; }

/* Leaves that are kept: from number l on those of patch p. */
static enum status keep_leaves(struct making *m, struct arena *arena, size_t p, size_t l, void **form)
{
  struct model *model = m->model;
  const struct model_patch *patch = &model->patches[p];
  const size_t all = leaves_of(patch);
  for (size_t first = 0; first < all; first += LEAVES_AT_ONCE) {
    const size_t here = all - first < LEAVES_AT_ONCE ? all - first : LEAVES_AT_ONCE;
    leaves_make(patch, (uint32_t)p, (uint32_t)first, here, &model->leaves[l]);
    for (size_t k = 0; k < here; k++, l++) {
      struct leaf *leaf = &model->leaves[l];
      if (!next_room(arena, form, sizeof *leaf->form)) return STATUS_LIMIT;
      leaf_set_form(patch, leaf, *form);
      if (leaf->form) *form = NULL;
      leaf_box(model, patch, leaf->x, &m->boxes[l]);
      leaf_orient(&model->tree, model->error, patch, leaf->slab, &model->oriented[l]);
    }
  }
  return STATUS_OK;
}

/* Only where they are, and their boxes. */
static void place_leaves(struct making *m, size_t p, size_t l)
{
  struct model *model = m->model;
  struct patch_room room;
  const struct model_patch *patch = &room.patch;
  patch_make(model, (uint32_t)p, &room.patch, room.rest);
  const struct part_grid grid = {{(uint16_t)patch->split[0], (uint16_t)patch->split[1]}, {1, 1}, 0};
  const size_t all = leaves_of(patch), row = (size_t)patch->split[1];
  for (size_t first = 0; first < all; first += LEAVES_AT_ONCE) {
    const size_t here = all - first < LEAVES_AT_ONCE ? all - first : LEAVES_AT_ONCE;
    uint16_t column[LEAVES_AT_ONCE][2];
    struct patch_part part[LEAVES_AT_ONCE];
    for (size_t k = 0; k < here; k++)
      column[k][0] = (uint16_t)((first + k) / row), column[k][1] = (uint16_t)((first + k) % row);
    patch_parts(patch, &grid, here, (const uint16_t(*)[2])column, part);
    for (size_t k = 0; k < here; k++, l++) {
      model->places[l] = (struct leaf_place){(uint32_t)p, column[k][0], column[k][1]};
      leaf_box(model, patch, part[k].x, &m->boxes[l]);
    }
  }
}

static enum status make_leaves(void *context, size_t worker)
{
  struct making *m = context;
  void *form = NULL;
  for (size_t part, p, end; take_part(m, &part, &p, &end);) {
    for (size_t l = m->leaves[part]; p < end; p++) {
      const struct model_cut *cut = &m->model->cuts[p];
      if (cut->copied) continue;
      if (!m->keep) place_leaves(m, p, l);
      else if (keep_leaves(m, m->arenas[worker], p, l, &form) != STATUS_OK) return STATUS_LIMIT;
      l += (size_t)cut->split[0] * cut->split[1];
    }
  }
  return STATUS_OK;
}

/* Has all parts done, by the team where there are so many patches or leaves that it is worth it. */
static enum status do_parts(struct making *m, team_work *work, size_t count)
{
  atomic_store(&m->taken, 0);
  return team_run(count < TEAM_LEAST ? NULL : m->team, m->part_count, work, m);
}

static enum status cut_patches(struct making *m)
{
  struct model *model = m->model;
  const size_t count = model->scene->patch_count;
  m->part = count / PARTS + 1, m->part_count = (count + m->part - 1) / m->part;
  m->leaves = memory_alloc(m->part_count, sizeof *m->leaves);
  m->arenas = memory_alloc(team_count(m->team), sizeof *m->arenas);
  if (!m->leaves || !m->arenas) return STATUS_LIMIT;
  for (size_t k = 0; k < team_count(m->team); k++)
    if ((m->arenas[k] = arena_create()) == NULL) return STATUS_LIMIT;
  if (m->keep) model->patches = arena_alloc(m->arenas[0], count + 1, sizeof *model->patches);
  if (m->keep && !model->patches) return STATUS_LIMIT;
  const enum status status = do_parts(m, make_patches, count);
  for (size_t k = 0; k < m->part_count; k++) {
    const size_t here = m->leaves[k];
    m->leaves[k] = model->leaf_count;
    model->leaf_count += here;
  }
  return status;
}

/* What has been made is the model's, where it is kept. */
static void end_making(struct making *m)
{
  for (size_t k = 0; m->arenas && k < team_count(m->team); k++)
    if (m->keep) arena_join(m->model->arena, m->arenas[k]);
    else arena_destroy(m->arenas[k]);
  memory_free(m->arenas);
  memory_free(m->leaves);
  memory_free(m->boxes);
}

/* Where boxes along leaves begin, each in one line of the caches, in room for one more. */
static struct oriented_box *oriented_in(struct model *model, void *room)
{
  enum { LINE = sizeof(struct oriented_box) };
  memory_used_anywhere(room, (model->leaf_count + 1) * LINE);
  return (struct oriented_box *)(void *)((char *)room + (LINE - (uintptr_t)room % LINE) % LINE);
}

/* Leaves and their boxes, in huge pages. */
static bool make_room(struct model *model)
{
  const size_t count = model->leaf_count + 1;
  model->leaves = arena_alloc(model->arena, count, sizeof *model->leaves);
  void *oriented = arena_alloc(model->arena, count, sizeof *model->oriented);
  if (!model->leaves || !oriented) return false;
  memory_used_anywhere(model->leaves, count * sizeof *model->leaves);
  model->oriented = oriented_in(model, oriented);
  return true;
}

/* The boxes along leaves that are not kept. */
static enum status orient_leaves(void *context, size_t worker)
{
  struct making *m = context;
  const struct model *model = m->model;
  (void)worker;
  for (size_t part, p, end; take_part(m, &part, &p, &end);) {
    for (size_t l = m->leaves[part]; p < end; p++) {
      if (model->cuts[p].copied) continue;
      struct patch_room room;
      const struct model_patch *patch = &room.patch;
      patch_make(model, (uint32_t)p, &room.patch, room.rest);
      const size_t all = leaves_of(patch);
      for (size_t first = 0; first < all; first += LEAVES_AT_ONCE) {
        const size_t here = all - first < LEAVES_AT_ONCE ? all - first : LEAVES_AT_ONCE;
        uint16_t column[LEAVES_AT_ONCE][2];
        struct leaf_slab slab[LEAVES_AT_ONCE][3];
        for (size_t k = 0; k < here; k++)
          column[k][0] = model->places[l + k].column_u, column[k][1] = model->places[l + k].column_v;
        leaf_slabs(patch, here, (const uint16_t(*)[2])column, slab);
        for (size_t k = 0; k < here; k++, l++)
          leaf_orient(&model->tree, model->error, patch, slab[k], &model->oriented[l]);
      }
    }
  }
  return STATUS_OK;
}

/* Boxes of trees in the tree are in these trees' frames. */
static void orient_inner(struct model *model)
{
  for (const struct model_tree *tree = model->tree.inner; tree; tree = tree->inner) {
    for (size_t n = 0; n < BVH_WIDTH * tree->bvh.node_count; n++) {
      const uint32_t child = tree->bvh.nodes[n / BVH_WIDTH].child[n % BVH_WIDTH], box = child & ~(uint32_t)BVH_LEAF;
      if (child == box || box >= model->leaf_count) continue;
      struct leaf_room room;
      if (!model->leaves) model_make_leaf(model, box, &room);
      const struct leaf *leaf = model->leaves ? &model->leaves[box] : &room.leaf;
      const struct model_patch *patch = model->leaves ? &model->patches[leaf->patch] : &room.of.patch;
      leaf_orient(tree, model->error, patch, leaf->slab, &model->oriented[box]);
    }
  }
}

/* The boxes along leaves that are not known yet. Where leaves are not kept they take the place of those that the hierarchy was
 * built from, and has used up: there would not be room for both. */
static enum status orient(struct making *m)
{
  struct model *model = m->model;
  enum status status = STATUS_OK;
  if (!m->keep) {
    static_assert(sizeof *m->boxes <= sizeof *model->oriented, "room for these");
    model->oriented_room = m->boxes, m->boxes = NULL;
    model->oriented = oriented_in(model, model->oriented_room);
    status = do_parts(m, orient_leaves, model->leaf_count);
  }
  if (status == STATUS_OK) orient_inner(model);
  return status;
}

/* The leaves of patches and, behind them, the copies, in one hierarchy. Leaves are kept where that is wanted and they
 * are not too many; it makes rays a quarter faster, at 1.5 KB a patch of one leaf. */
static enum status make_hierarchy(struct model *model, const struct team *team, const struct split_limit *limit,
                                  bool keep, size_t keep_most)
{
  struct making m = {.model = model, .team = team, .limit = *limit, .keep = keep};
  enum status status = cut_patches(&m);
  if (status != STATUS_OK) goto done;
  if (model->leaf_count > keep_most) m.keep = false, model->patches = NULL;
  const size_t count = model->leaf_count + model->copy_count;
  m.boxes = memory_alloc(count + 1, m.keep ? sizeof *m.boxes : sizeof *model->oriented);
  bool room = m.boxes;
  if (m.keep) {
    room = room && make_room(model);
  } else {
    model->places = arena_alloc(model->arena, model->leaf_count, sizeof *model->places);
    room = room && model->places;
  }
  status = room ? do_parts(&m, make_leaves, model->leaf_count) : STATUS_LIMIT;
  if (status != STATUS_OK) goto done;
  for (size_t c = 0; c < model->copy_count; c++) copy_box(model, &model->copies[c], &m.boxes[model->leaf_count + c]);
  status = tree_build(model->arena, m.boxes, count, team, &model->tree);
  if (status == STATUS_OK) status = orient(&m);
done:
  end_making(&m);
  return status;
}

static int most_split(int most, size_t patch_count, size_t leaves_max)
{
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

enum status model_create_object(const struct scene *nets, const struct team *team, const struct split_limit *limit,
                                double error, struct model **out)
{
  *out = NULL;
  struct model *model = model_begin(nets);
  if (!model) return STATUS_LIMIT;
  model->error = error;
  const enum status status = make_hierarchy(model, team, limit, true, SIZE_MAX);
  model->scene = NULL;
  if (status == STATUS_OK) *out = model;
  else model_destroy(model);
  return status;
}

/* Marks patches that lie on earlier ones; not where roots as their solvers find them are the answers. */
static enum status mark_twins(struct model *model)
{
  const struct scene *scene = model->scene;
  if (model->unproven) return STATUS_OK;
  bool *twin = arena_alloc(model->arena, scene->patch_count + 1, sizeof *twin);
  if (!twin) return STATUS_LIMIT;
  const enum status status = twins_find(scene->patches, sizeof *scene->patches, scene->patch_count, twin);
  if (memchr(twin, true, scene->patch_count)) model->twin = twin;
  return status;
}

static enum status prepare(struct model *model, const struct team *team)
{
  const struct scene *scene = model->scene;
  model->neighbours = arena_alloc(model->arena, scene->patch_count + 1, 4 * sizeof *model->neighbours);
  if (!model->neighbours) return STATUS_LIMIT;
  enum status status = mark_twins(model);
  if (status == STATUS_OK)
    status = edges_match(scene->patches, sizeof *scene->patches, scene->patch_count, model->twin,
                         scene->patch_count < TEAM_LEAST ? NULL : team, model->neighbours);
  if (status != STATUS_OK) return status;
  size_t own = scene->patch_count; /* patches that need leaves */
  if (most_split(AUTO_SPLIT_MAX, own, AUTO_LEAVES_MAX) < AUTO_SPLIT_MAX) {
    status = copies_choose(model, &own);
    if (status != STATUS_OK) return status;
  }
  struct split_limit limit = {AUTO_TURN, most_split(AUTO_SPLIT_MAX, own, AUTO_LEAVES_MAX),
                              most_split(BENT_SPLIT_MAX, own, BENT_LEAVES_MAX)};
  const bool keep = limit.any > 1;
  if (!keep) limit.any = limit.bent = most_split(AUTO_SPLIT_MAX, own, OBJECT_LEAVES_MAX);
  status = copies_prepare(model, team, &limit);
  if (!keep) limit = (struct split_limit){BOXES_TURN, BOXES_SPLIT_MAX, BOXES_SPLIT_MAX};
  return status == STATUS_OK ? make_hierarchy(model, team, &limit, keep, BENT_LEAVES_MAX) : status;
}

enum status model_create(const struct scene *scene, const struct team *team, struct model **out)
{
  *out = NULL;
  struct model *model = model_begin(scene);
  if (!model) return STATUS_LIMIT;
  const enum status status = prepare(model, team);
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
  const uint32_t row = (uint32_t)out->of.patch.split[1];
  leaves_make(&out->of.patch, place->patch, place->column_u * row + place->column_v, 1, &out->leaf);
  leaf_set_form(&out->of.patch, &out->leaf, &out->form);
}

void model_destroy(struct model *model)
{
  if (!model) return;
  for (size_t k = 0; k < model->object_count; k++) model_destroy(model->objects[k].model);
  tree_free(&model->tree);
  memory_free(model->oriented_room);
  arena_destroy(model->arena);
  memory_free(model);
}
