/* The list of patches. */
#include "language/objects.h"

#include <math.h>
#include <string.h>

#include "base/number.h"

/* Of nested objects, the outermost with at most this many patches is the one whose copies are recorded. */
enum { COPIED_MOST = 1024 };

/* A list of the scene, which grows by doubling in the scene's arena. */
struct list {
  void **items;
  size_t *count, capacity, size; /* size: that of an element */
  size_t expected;               /* how many there may be: room for so many at first, or for 16 */
  struct table known;            /* its elements, if they are all different */
  const void *last;              /* asked for last */
  uint32_t last_index;
};

struct known {
  struct table_entry entry;
  uint32_t index;
};

struct expansion {
  struct language *language;
  struct scene *scene;
  struct list textures, methods, objects, copies;
  bool in_copy;
  bool small; /* numbers of the copy became 0 that are not 0 in the object */
  bool told;  /* a point that is too large */
};

/* A node passes this down to its children. */
struct inherited {
  const struct transform *transform;
  const struct texture *texture; /* of the nearest node that has one; each object of the scene does */
  const struct method *method;   /* likewise, or the scene's */
};

/* Appends a new element. */
static void *append(struct expansion *e, struct list *list)
{
  if (*list->count == list->capacity) {
    const size_t wanted = list->capacity ? 2 * list->capacity : list->expected > 16 ? list->expected : 16;
    void *grown = language_alloc_in(e->language, e->scene->arena, wanted, list->size);
    if (*list->count) memcpy(grown, *list->items, *list->count * list->size);
    *list->items = grown;
    list->capacity = wanted;
  }
  return (char *)*list->items + (*list->count)++ * list->size;
}

/* The index of the element equal to `item`, which is added if there is none. Neighbours mostly ask for the same item. */
static uint32_t intern(struct expansion *e, struct list *list, const void *item)
{
  if (item == list->last) return list->last_index;
  struct arena *arena = e->language->arena;
  const struct table_entry *entry = table_find(&list->known, item, list->size);
  while (entry &&
         memcmp((char *)*list->items + ((const struct known *)entry)->index * list->size, item, list->size) != 0)
    entry = entry->older;
  if (!entry) {
    struct known *known = language_alloc_in(e->language, arena, 1, sizeof *known);
    known->index = (uint32_t)*list->count;
    memcpy(append(e, list), item, list->size);
    if (!table_add(&list->known, arena, &known->entry, item, list->size)) language_end(e->language, STATUS_LIMIT);
    entry = &known->entry;
  }
  list->last = item;
  return list->last_index = ((const struct known *)entry)->index;
}

/* How numbers were brought into the range of a scene's. */
enum { RANGE_SMALL = 1, RANGE_LARGE = 2 }; /* some are 0 now; some are too large */

static unsigned bring_in_range(double *x, size_t count)
{
  unsigned range = 0;
  for (size_t n = 0; n < count; n++) {
    const double size = fabs(x[n]);
    range |= size <= NUMBER_LARGEST ? 0 : RANGE_LARGE;
    range |= size < NUMBER_LEAST && size > 0 ? RANGE_SMALL : 0;
    x[n] = size < NUMBER_LEAST ? 0 : x[n];
  }
  return range;
}

static void expand_points(struct expansion *e, const struct node *node, const struct transform *transform,
                          struct scene_patch *patch)
{
  for (int i = 0; i < 4; i++) transform_points(transform, node->net->P[i], patch->P[i]);
  const unsigned range = bring_in_range((double *)patch->P, sizeof patch->P / sizeof(double));
  e->small |= range & RANGE_SMALL;
  if (!(range & RANGE_LARGE) || e->told) return;
  e->told = true;
  language_error(e->language, node->place, "with its transforms applied, a control point is larger than 1e100");
}

static void expand_patch(struct expansion *e, const struct node *node, const struct inherited *with)
{
  struct scene_patch *patch = &e->scene->patches[e->scene->patch_count++];
  expand_points(e, node, with->transform, patch);
  patch->type = (int)node->net->setting[PATCH_TYPE];
  patch->flatness = node->net->setting[PATCH_FLATNESS];
  patch->u_steps = (int)node->net->setting[PATCH_U_STEPS];
  patch->v_steps = (int)node->net->setting[PATCH_V_STEPS];
  patch->texture = intern(e, &e->textures, &with->texture->is);
  patch->solver = intern(e, &e->methods, with->method);
}

/* Writes the control nets below a node from out[0] on. Returns their end. */
static double (*collect_nets(const struct node *node, const struct transform *transform,
                             double (*out)[4][4][3]))[4][4][3]
{
  if (node->net) {
    for (int i = 0; i < 4; i++) transform_points(transform, node->net->P[i], (*out)[i]);
    return out + 1;
  }
  for (const struct node *child = node->first; child; child = child->next) {
    const struct transform all = child->transform ? transform_then(child->transform, transform) : *transform;
    out = collect_nets(child, &all, out);
  }
  return out;
}

/* Records that the patches expanded next are the object of `node`, moved, unless the object's own numbers are out of
 * range. */
static void begin_copy(struct expansion *e, const struct node *node, const struct transform *transform)
{
  struct scene *scene = e->scene;
  e->small = false;
  if (node->sharing->object == 0) {
    const struct transform identity = transform_identity();
    struct scene_object *object = append(e, &e->objects);
    object->patch_count = node->patch_count;
    object->P = language_alloc_in(e->language, scene->arena, node->patch_count, sizeof *object->P);
    collect_nets(node, &identity, object->P);
    node->sharing->object = (uint32_t)scene->object_count;
    if (bring_in_range((double *)object->P, node->patch_count * sizeof *object->P / sizeof(double)) != 0)
      node->sharing->uses = 1;
  }
  if (node->sharing->uses == 1) return;
  struct scene_copy *copy = append(e, &e->copies);
  copy->object = node->sharing->object - 1;
  copy->first_patch = scene->patch_count;
  for (int i = 0; i < 3; i++) {
    for (int j = 0; j < 3; j++) copy->A[i][j] = transform->A[i][j].hi;
    copy->b[i] = transform->A[3][i].hi;
  }
}

/* Recurses as deep as unions are nested: MAX_NESTING at most. Each child has a patch. */
static void expand(struct expansion *e, const struct node *node, const struct inherited *above)
{
  struct inherited with = *above;
  struct transform all;
  if (node->transform) all = transform_then(node->transform, above->transform), with.transform = &all;
  if (node->texture) with.texture = node->texture;
  if (node->method) with.method = node->method;
  const bool is_copy = !e->in_copy && node->sharing && node->sharing->uses > 1 && node->patch_count <= COPIED_MOST;
  if (is_copy) begin_copy(e, node, with.transform);
  e->in_copy |= is_copy;
  if (node->net) expand_patch(e, node, &with);
  for (const struct node *child = node->first; child; child = child->next) expand(e, child, &with);
  if (is_copy && e->small && node->sharing->uses > 1) e->scene->copy_count--;
  e->in_copy &= !is_copy;
}

/* The name of a declared object, for as long as the scene. */
static const char *name_of(struct expansion *e, struct sharing *sharing)
{
  if (!sharing->kept)
    sharing->kept = memcpy(language_alloc_in(e->language, e->scene->arena, sharing->name.length + 1, 1),
                           sharing->name.text, sharing->name.length);
  return sharing->kept;
}

static void list_parts(struct expansion *e, const struct node *all, struct language_parts *out)
{
  struct list parts = {.items = (void **)&out->at, .count = &out->count, .size = sizeof *out->at};
  size_t first = 0;
  for (const struct node *child = all->first; child; first += child->patch_count, child = child->next) {
    struct language_part *part = append(e, &parts);
    *part = (struct language_part){child->sharing ? name_of(e, child->sharing) : NULL, first};
  }
}

void objects_expand(struct language *language, const struct method *method, struct scene *scene,
                    struct language_parts *parts)
{
  struct expansion e = {
    .language = language,
    .scene = scene,
    .textures = {.items = (void **)&scene->textures, .count = &scene->texture_count, .size = sizeof *scene->textures},
    .methods = {.items = (void **)&scene->solvers, .count = &scene->solver_count, .size = sizeof *scene->solvers},
    .objects = {.items = (void **)&scene->objects, .count = &scene->object_count, .size = sizeof *scene->objects},
    .copies = {.items = (void **)&scene->copies,
               .count = &scene->copy_count,
               .size = sizeof *scene->copies,
               .expected = language->objects->copies}};
  const struct node *all = &language->objects->scene.node;
  const struct transform identity = transform_identity();
  const struct inherited nothing = {&identity, NULL, method};
  scene->patches = language_alloc_in(language, scene->arena, all->patch_count, sizeof *scene->patches);
  (void)intern(&e, &e.methods, method);
  expand(&e, all, &nothing);
  if (parts) list_parts(&e, all, parts);
  if (e.told) language_end(language, STATUS_INPUT);
}
