/* Objects whose leaves serve their copies: maps and their error bounds. */
#include "intersect/prepare/copies.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "base/real.h"
#include "intersect/prepare/patch.h"
#include "intersect/prepare/tree.h"

/* A map that stretches errors more than this is no gain: what is undecided in the object would be decided twice. */
#define MOST_STRETCH 0x1p10

/* A map whose numbers, or whose inverse's, are larger than this could overflow with the rays that are accepted
 * (packet.c). */
#define MOST_SIZE 0x1p100

/* A map is no gain either if it leaves open more than this part of the object, or of its smallest patch. */
#define MOST_OPEN 0x1p-30
#define MOST_OPEN_OF_PATCH 0x1p-24

/* Copies are deep in one another if the middle of one is in the boxes of more than DEEP, its own included, on average
 * over some of them: a ray is then taken to the coordinates of as many. Choices of speed: that takes 40 ns each, while
 * making an object's leaves takes 50 us a patch. */
enum { DEEP = 8, DEEP_SAMPLES = 64 };

/* How one copy may share the object's leaves, while copies_choose decides. */
struct copy_map {
  const struct scene_copy *copy;
  double W[3][3], b[3];
  double error;       /* of patches and rays in the object's coordinates */
  double widest;      /* largest sum of |A| over a column: how much longer an error is in the scene */
  struct bvh_box box; /* its own, for are_deep */
  bool good;
};

/* The middle of the box of the object's nets, how far they reach from it, and the size of the smallest net that is no
 * point. */
struct middle {
  double center[3], reach, least;
};

static struct middle object_middle(const struct scene_object *object)
{
  struct middle m = {{0}, 0, INFINITY};
  struct bvh_box all = BVH_EMPTY;
  for (size_t p = 0; p < object->patch_count; p++) {
    struct bvh_box own = BVH_EMPTY;
    double extent = 0;
    box_add_net(&own, object->P[p]);
    for (int k = 0; k < 3; k++) extent = real_max(extent, own.hi[k] / 2 - own.lo[k] / 2);
    bvh_box_add(&all, &own);
    if (extent > 0) m.least = real_min(m.least, extent);
  }
  for (int k = 0; k < 3; k++) {
    m.center[k] = box_center(&all, k);
    m.reach = real_max(m.reach, all.hi[k] / 2 - all.lo[k] / 2);
  }
  return m;
}

/* The inverse, by cofactors; false if there is none to speak of. It need not be exact. */
static bool invert(double A[3][3], double W[3][3])
{
  double size = 0;
  for (int n = 0; n < 9; n++) size = real_max(size, fabs(A[n / 3][n % 3]));
  if (!(size <= MOST_SIZE && size >= 1 / MOST_SIZE)) return false;
  double cofactor[3][3], determinant = 0;
  for (int i = 0; i < 3; i++) {
    for (int j = 0; j < 3; j++) {
      const int r = (i + 1) % 3, s = (i + 2) % 3, c = (j + 1) % 3, d = (j + 2) % 3;
      cofactor[i][j] = A[r][c] * A[s][d] - A[r][d] * A[s][c];
    }
  }
  for (int j = 0; j < 3; j++) determinant += A[0][j] * cofactor[0][j];
  bool finite = true;
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++) W[j][i] = cofactor[i][j] / determinant, finite &= fabs(W[j][i]) <= MOST_SIZE;
  return finite;
}

/* How far from the object's control points the map takes the copy's. */
static double copy_map_excess(const struct copy_map *c, const struct model *model, const struct scene_object *object,
                              const struct middle *m)
{
  double off = 0;
  for (size_t p = 0; p < object->patch_count; p++) {
    double(*P)[4][3] = model->scene->patches[c->copy->first_patch + p].P;
    for (int n = 0; n < 16; n++) {
      for (int j = 0; j < 3; j++) {
        double x = m->center[j] - object->P[p][n / 4][n % 4][j];
        for (int k = 0; k < 3; k++) x += (P[n / 4][n % 4][k] - c->b[k]) * c->W[k][j];
        off = real_max(off, fabs(x));
      }
    }
  }
  return off;
}

/* Sets the map of a copy, and its error in the object's coordinates: how far from the object's control points it takes
 * the copy's, the rounding of computing that, and that of a ray near the object (copy.c): of its origin, which is moved
 * to where the ray passes the middle of the copy, and of its direction on the way from there through the object. */
static void copy_map_make(struct copy_map *c, const struct model *model, const struct scene_object *object,
                          const struct middle *m)
{
  double A[3][3];
  memcpy(A, c->copy->A, sizeof A);
  c->good = invert(A, c->W);
  double stretch = 0, back = 0, columns[3];
  c->widest = 0;
  for (int k = 0; k < 3; k++) {
    c->b[k] = c->copy->b[k];
    columns[k] = 0;
    for (int i = 0; i < 3; i++) c->b[k] += m->center[i] * A[i][k], columns[k] += fabs(A[i][k]);
    c->widest = real_max(c->widest, columns[k]);
  }
  for (int j = 0; j < 3; j++) {
    double sum = 0, bare = 0;
    for (int k = 0; k < 3; k++) sum += columns[k] * fabs(c->W[k][j]), bare += fabs(c->W[k][j]);
    stretch = real_max(stretch, sum), back = real_max(back, bare);
  }
  const double off = copy_map_excess(c, model, object, m);
  for (size_t p = 0; p < object->patch_count; p++) {
    const struct method *method = &model->scene->solvers[model->scene->patches[c->copy->first_patch + p].solver];
    c->good &= patch_on_lanes(method) && method->split == 0;
  }
  const double passes = 2 * c->widest * m->reach * back; /* the ray's nearest point, from the middle; sqrt(3) < 2 */
  c->error = off + 16 * UNIT_ROUNDOFF * stretch * (m->reach + passes);
  c->good &= stretch <= MOST_STRETCH && c->error <= MOST_OPEN * m->reach &&
             c->error <= MOST_OPEN_OF_PATCH * m->least; /* NaN is no good map either */
}

/* An object's copies. */
struct object_copies {
  const struct scene_object *object;
  struct copy_map *maps;
  size_t count;
};

/* How many patches need no leaves if the good copies, which must be two or more, share theirs. */
static size_t patches_spared(const struct object_copies *g)
{
  size_t good = 0;
  for (size_t k = 0; k < g->count; k++) good += g->maps[k].good;
  return good < 2 ? 0 : (good - 1) * g->object->patch_count;
}

static bool holds_middle(const struct copy_map *c, const struct copy_map *other)
{
  for (int k = 0; k < 3; k++) {
    const double middle = box_center(&other->box, k);
    if (middle < c->box.lo[k] || middle > c->box.hi[k]) return false;
  }
  return true;
}

/* The box of the copy whose patches begin at `first_patch`. */
static struct bvh_box copy_bounds(const struct model *model, const struct scene_object *object, size_t first_patch)
{
  struct bvh_box box = BVH_EMPTY;
  for (size_t p = 0; p < object->patch_count; p++) box_add_net(&box, model->scene->patches[first_patch + p].P);
  return box;
}

static bool are_deep(const struct model *model, const struct object_copies *g)
{
  size_t held = 0, samples = 0;
  for (size_t k = 0; k < g->count; k++) g->maps[k].box = copy_bounds(model, g->object, g->maps[k].copy->first_patch);
  for (size_t s = 0; s < g->count; s += g->count / DEEP_SAMPLES + 1, samples++)
    for (size_t k = 0; k < g->count; k++) held += holds_middle(&g->maps[k], &g->maps[s]);
  return held > DEEP * samples;
}

/* Makes the good copies share. */
static void share_leaves(struct model *model, const struct object_copies *g)
{
  const struct scene_object *object = g->object;
  double error = 0;
  for (size_t k = 0; k < g->count; k++)
    if (g->maps[k].good) error = real_max(error, g->maps[k].error);
  struct model_object *shared = &model->objects[model->object_count++];
  shared->declared = object, shared->error = error;
  for (size_t k = 0; k < g->count; k++) {
    const struct copy_map *c = &g->maps[k];
    if (!c->good) continue;
    struct model_copy *copy = &model->copies[model->copy_count++];
    copy->object = shared, copy->first_patch = (uint32_t)c->copy->first_patch;
    memcpy(copy->W, c->W, sizeof copy->W), memcpy(copy->b, c->b, sizeof copy->b);
    for (size_t p = 0; p < object->patch_count; p++) {
      struct model_cut *cut = &model->cuts[c->copy->first_patch + p];
      cut->copied = true, cut->loose = error * c->widest;
    }
  }
}

static int by_object(const void *a, const void *b)
{
  const struct copy_map *x = a, *y = b;
  if (x->copy->object != y->copy->object) return x->copy->object < y->copy->object ? -1 : 1;
  return x->copy->first_patch < y->copy->first_patch ? -1 : x->copy->first_patch > y->copy->first_patch;
}

/* The copies of one object, whose maps begin at `first`. */
static struct object_copies copies_at(const struct scene *scene, size_t count, struct copy_map all[], size_t first)
{
  const size_t object = all[first].copy->object;
  struct object_copies g = {&scene->objects[object], &all[first], 0};
  while (first + g.count < count && all[first + g.count].copy->object == object) g.count++;
  return g;
}

enum status copies_choose(struct model *model, size_t most, size_t *own)
{
  const struct scene *scene = model->scene;
  const size_t count = scene->copy_count;
  if (count == 0) return STATUS_OK;
  struct copy_map *all = memory_alloc(count, sizeof *all);
  model->objects = arena_alloc(model->arena, scene->object_count, sizeof *model->objects);
  model->copies = arena_alloc(model->arena, count, sizeof *model->copies);
  if (!all || !model->objects || !model->copies) {
    memory_free(all);
    return STATUS_LIMIT;
  }
  for (size_t k = 0; k < count; k++) all[k].copy = &scene->copies[k];
  qsort(all, count, sizeof *all, by_object);
  struct object_copies g;
  for (size_t first = 0; first < count; first += g.count) {
    g = copies_at(scene, count, all, first);
    const struct middle middle = object_middle(g.object);
    for (size_t k = 0; k < g.count; k++) copy_map_make(&all[first + k], model, g.object, &middle);
    *own -= patches_spared(&g);
  }
  for (size_t first = 0; first < count; first += g.count) {
    g = copies_at(scene, count, all, first);
    const size_t more = patches_spared(&g);
    if (more > 0 && *own + more <= most && are_deep(model, &g)) *own += more;
    else if (more > 0) share_leaves(model, &g);
  }
  memory_free(all);
  return STATUS_OK;
}

/* Makes the model of an object from its nets about their middle; the solver is that of a copy. */
static enum status prepare_object(const struct model *model, const struct team *team, const struct model_copy *copy,
                                  const struct cut_limit *limit, struct model_object *object)
{
  const struct scene_object *declared = object->declared;
  const struct middle middle = object_middle(declared);
  struct scene_patch *patches = memory_alloc(declared->patch_count, sizeof *patches);
  if (!patches) return STATUS_LIMIT;
  for (size_t p = 0; p < declared->patch_count; p++) {
    patches[p] = model->scene->patches[copy->first_patch + p];
    for (int n = 0; n < 16; n++)
      for (int k = 0; k < 3; k++) patches[p].P[n / 4][n % 4][k] = declared->P[p][n / 4][n % 4][k] - middle.center[k];
  }
  const struct scene nets = {
    .patches = patches, .patch_count = declared->patch_count, .solvers = model->scene->solvers};
  const enum status status = model_create_object(&nets, team, limit, object);
  memory_free(patches);
  return status;
}

enum status copies_prepare(struct model *model, const struct team *team, const struct cut_limit *limit)
{
  for (size_t k = 0; k < model->copy_count; k++) {
    struct model_copy *copy = &model->copies[k];
    struct model_object *object = copy->object;
    if (!object->model) {
      const enum status status = prepare_object(model, team, copy, limit, object);
      if (status != STATUS_OK) return status;
    }
    for (size_t p = 0; p < object->declared->patch_count; p++)
      memcpy(model->cuts[copy->first_patch + p].split, object->model->cuts[p].split, sizeof(uint16_t[2]));
  }
  return STATUS_OK;
}

void copy_box(const struct model *model, const struct model_copy *copy, struct bvh_box *out)
{
  double about[3];
  for (int k = 0; k < 3; k++) about[k] = tree_about(&model->tree, k);
  *out = copy_bounds(model, copy->object->declared, copy->first_patch);
  tree_box(about, 1, out);
}
