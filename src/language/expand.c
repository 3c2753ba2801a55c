/* From the tree of objects to the list of patches: each with its transforms applied, its texture and its solver. And
 * to the list of copies: which runs of patches are one declared object, moved. */
#include <math.h>
#include <string.h>

#include "language/build.h"

/* Of objects within objects, the outermost that has no more patches than this is the one whose copies are told. */
enum { COPIED_MOST = 1024 };

struct expansion {
  struct language *language;
  struct scene *scene;
  size_t texture_capacity, solver_capacity, object_capacity, copy_capacity;
  bool in_copy;
  bool told; /* that a point is too large */
};

/* What a node passes down to those below it. */
struct inherited {
  struct transform transform;
  const struct texture *texture;       /* of the nearest node that has one, or NULL */
  const struct method *solver; /* likewise */
};

/* A new element of a list that grows by doubling in the arena, or NULL where memory is short. */
static void *append(struct arena *arena, void **list, size_t *count, size_t *capacity, size_t size)
{
  if (*count == *capacity) {
    const size_t wanted = *capacity ? 2 * *capacity : 16;
    void *grown = arena_alloc(arena, wanted, size);
    if (!grown) return NULL;
    if (*count) memcpy(grown, *list, *count * size);
    *list = grown;
    *capacity = wanted;
  }
  return (char *)*list + (*count)++ * size;
}

/* The index of an element equal to `item`, looked for among the last few, or of a new one. */
static bool intern(struct arena *arena, void **list, size_t *count, size_t *capacity, const void *item, size_t size,
                   uint32_t *out)
{
  enum { LOOK_BACK = 32 };
  for (size_t k = *count; k > 0 && *count - k < LOOK_BACK; k--) {
    if (memcmp((char *)*list + (k - 1) * size, item, size) != 0) continue;
    *out = (uint32_t)(k - 1);
    return true;
  }
  void *added = append(arena, list, count, capacity, size);
  if (!added) return false;
  memcpy(added, item, size);
  *out = (uint32_t)(*count - 1);
  return true;
}

static void expand_points(struct expansion *e, const struct node *node, const struct transform *transform,
                          struct scene_patch *patch)
{
  bool finite = true;
  for (int i = 0; i < 4; i++) {
    for (int j = 0; j < 4; j++) {
      transform_point(transform, node->P[i][j], patch->P[i][j]);
      for (int k = 0; k < 3; k++) finite &= isfinite(patch->P[i][j][k]) != 0;
    }
  }
  if (finite || e->told) return;
  e->told = true;
  language_error(e->language, node->place, "with its transforms applied, a control point is too large for numbers");
}

static bool expand_patch(struct expansion *e, const struct node *node, const struct inherited *with)
{
  struct scene *scene = e->scene;
  struct scene_patch *patch = &scene->patches[scene->patch_count++];
  expand_points(e, node, &with->transform, patch);
  patch->type = node->type;
  patch->flatness = node->flatness;
  patch->u_steps = node->u_steps;
  patch->v_steps = node->v_steps;
  const struct texture none = texture_default();
  const struct scene_texture *texture = with->texture ? &with->texture->is : &none.is;
  if (!intern(scene->arena, (void **)&scene->textures, &scene->texture_count, &e->texture_capacity, texture,
              sizeof *texture, &patch->texture)) {
    return false;
  }
  if (!with->solver) return true; /* 0: the scene's */
  return intern(scene->arena, (void **)&scene->solvers, &scene->solver_count, &e->solver_capacity, with->solver,
                sizeof *with->solver, &patch->solver);
}

/* The control nets below a node, from out[0] on; returns their end. */
static double (*collect_nets(const struct node *node, const struct transform *transform,
                             double (*out)[4][4][3]))[4][4][3]
{
  if (node->P) {
    for (int n = 0; n < 16; n++) transform_point(transform, node->P[n / 4][n % 4], (*out)[n / 4][n % 4]);
    return out + 1;
  }
  for (const struct node *child = node->first; child; child = child->next) {
    const struct transform all = child->transform ? transform_then(child->transform, transform) : *transform;
    if (child->patch_count > 0) out = collect_nets(child, &all, out);
  }
  return out;
}

/* Tells that what is expanded next is the object of `node`, moved. */
static bool begin_copy(struct expansion *e, const struct node *node, const struct transform *transform)
{
  struct scene *scene = e->scene;
  if (node->sharing->object == 0) {
    const struct transform identity = transform_identity();
    struct scene_object *object =
        append(scene->arena, (void **)&scene->objects, &scene->object_count, &e->object_capacity, sizeof *object);
    if (!object) return false;
    object->patch_count = node->patch_count;
    object->P = arena_alloc(scene->arena, node->patch_count, sizeof *object->P);
    if (!object->P) return false;
    collect_nets(node, &identity, object->P);
    node->sharing->object = (uint32_t)scene->object_count;
  }
  struct scene_copy *copy = append(scene->arena, (void **)&scene->copies, &scene->copy_count, &e->copy_capacity,
                                   sizeof *copy);
  if (!copy) return false;
  copy->object = node->sharing->object - 1;
  copy->first_patch = scene->patch_count;
  for (int i = 0; i < 3; i++) {
    for (int j = 0; j < 3; j++) copy->A[i][j] = transform->A[i][j].hi;
    copy->b[i] = transform->b[i].hi;
  }
  return true;
}

/* As deep as unions are nested: MAX_NESTING at most. What holds no patch is passed by, for copies of it may be many. */
static bool expand(struct expansion *e, const struct node *node, const struct inherited *above)
{
  if (node->patch_count == 0) return true;
  struct inherited with = *above;
  if (node->transform) with.transform = transform_then(node->transform, &above->transform);
  if (node->texture) with.texture = node->texture;
  if (node->solver) with.solver = node->solver;
  const bool is_copy = !e->in_copy && node->sharing && node->sharing->uses > 1 && node->patch_count <= COPIED_MOST;
  if (is_copy && !begin_copy(e, node, &with.transform)) return false;
  e->in_copy |= is_copy;
  bool whole = true;
  if (node->P) whole = expand_patch(e, node, &with);
  for (const struct node *child = node->first; whole && child; child = child->next) whole = expand(e, child, &with);
  e->in_copy &= !is_copy;
  return whole;
}

enum status objects_expand(struct language *language, struct scene *scene)
{
  struct expansion e = {.language = language, .scene = scene, .solver_capacity = 1};
  scene->solvers = arena_alloc(scene->arena, 1, sizeof *scene->solvers);
  scene->patches = arena_alloc(scene->arena, language->scene.patch_count, sizeof *scene->patches);
  if (!scene->solvers || !scene->patches) return STATUS_LIMIT;
  scene->solvers[0] = language->global_solver;
  scene->solver_count = 1;
  const struct inherited nothing = {transform_identity(), NULL, NULL};
  if (!expand(&e, &language->scene, &nothing)) return STATUS_LIMIT;
  return e.told ? STATUS_INPUT : STATUS_OK;
}
