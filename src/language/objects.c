/* Patches, unions and declared objects, and putting them all into the scene. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "language/build.h"

/* Blocks open within each other, and declared objects within declared objects: what the recursion that expands them bears. */
enum { MAX_NESTING = 200 };

/* Patches of one scene. */
#define MAX_PATCHES ((size_t)50 * 1000 * 1000)

enum { PATCH_POINTS = 16 };

static struct node *open_node(struct language *language, struct place place)
{
  struct node *node = language_alloc(language, sizeof *node);
  node->transform = transform_identity();
  node->texture.block = TEXTURE_ALL;
  node->texture.is = texture_default().is;
  node->outer = language->open;
  language->open = node;
  if (++language->nesting == MAX_NESTING) {
    language_error(language, place, "objects are nested more than %d deep", MAX_NESTING);
    language->no_memory = true;
  }
  return node;
}

struct node *node_end(struct language *language)
{
  struct node *node = language->open;
  language->open = node->outer;
  node->outer = NULL;
  language->nesting--;
  return node;
}

void patch_begin(struct language *language, struct place place)
{
  struct node *node = open_node(language, place);
  node->P = language_alloc(language, 4 * sizeof *node->P);
  node->patch_count = 1;
}

void patch_number(struct language *language, int which, struct place place, const struct value *value)
{
  struct node *node = language->open;
  switch (which) {
  case PATCH_TYPE: node->type = (int)value_in_range(language, place, value, "type", 0, 1, true); break;
  case PATCH_FLATNESS: node->flatness = value_in_range(language, place, value, "flatness", 0, INFINITY, false); break;
  case PATCH_U_STEPS: node->u_steps = (int)value_in_range(language, place, value, "u_steps", 0, 16, true); break;
  case PATCH_V_STEPS: node->v_steps = (int)value_in_range(language, place, value, "v_steps", 0, 16, true); break;
  }
}

void patch_point(struct language *language, struct place place, const struct value *value)
{
  struct node *node = language->open;
  if (value->kind == VALUE_NUMBER) language_error(language, place, "a control point is a vector, not a number");
  if (node->points < PATCH_POINTS) value_to_vector(value, node->P[node->points / 4][node->points % 4]);
  node->points++;
}

void patch_points_end(struct language *language, struct place place)
{
  const int found = language->open->points;
  if (found != PATCH_POINTS) language_error(language, place, "a bicubic_patch has %d control points, not %d", PATCH_POINTS, found);
}

void union_begin(struct language *language, struct place place) { open_node(language, place); }

static void add_child(struct language *language, struct node *parent, struct node *child, struct place place)
{
  if (parent->last) parent->last->next = child;
  else parent->first = child;
  parent->last = child;
  parent->patch_count += child->patch_count;
  if (parent->patch_count > MAX_PATCHES) {
    if (!language->no_memory) language_error(language, place, "the scene has more than %zu patches", MAX_PATCHES);
    language->no_memory = true;
    parent->patch_count = MAX_PATCHES;
  }
  if (child->height >= parent->height) parent->height = child->height + 1;
  if (parent->height == MAX_NESTING) {
    language_error(language, place, "objects are nested more than %d deep", MAX_NESTING);
    language->no_memory = true;
  }
}

void union_add(struct language *language, struct place place, struct node *object)
{
  add_child(language, language->open, object, place);
}

void named_begin(struct language *language, struct place place, const struct token *name)
{
  struct node *node = open_node(language, place), *outer = node->outer;
  const struct symbol *symbol = symbol_find(language, name->text, name->length);
  if (!symbol) symbol_unknown(language, place, name, "an object");
  else if (symbol->kind != SYMBOL_OBJECT)
    language_error(language, place, "'%.*s' is no object", (int)name->length, name->text);
  else {
    *node = *symbol->object;
    node->next = NULL, node->outer = outer;
  }
}

void wrapped_begin(struct language *language, struct place place, struct node *object)
{
  struct node *node = open_node(language, place), *outer = node->outer;
  *node = *object;
  node->next = NULL, node->outer = outer;
}

void node_transform(struct language *language, struct place place, const struct transform *transform)
{
  struct node *node = language->open;
  node->transform = transform_then(&node->transform, transform);
  for (int j = 0; j < 3; j++) {
    bool finite = isfinite((double)node->transform.b[j]);
    for (int i = 0; i < 3; i++) finite &= isfinite((double)node->transform.A[i][j]);
    if (!finite) {
      language_error(language, place, "the transforms up to here are too large for numbers");
      node->transform = transform_identity();
      return;
    }
  }
}

void node_texture(struct language *language, const struct texture *texture) { texture_apply(&language->open->texture, texture); }

void node_solver(struct language *language, struct place place)
{
  (void)place;
  struct solver_options *solver = language_alloc(language, sizeof *solver);
  *solver = language->solver;
  language->open->solver = solver;
}

void scene_add(struct language *language, struct place place, struct node *object)
{
  add_child(language, &language->scene, object, place);
}

/* ---- expanding ---- */

struct expansion {
  struct language *language;
  struct scene *scene;
  size_t texture_capacity, solver_capacity;
  bool finite;
};

/* What a node passes down to those below it that have none of their own. */
struct inherited {
  struct transform transform;
  const struct texture *texture;
  const struct solver_options *solver;
};

/* The index of an element equal to `item`, looked for among the last few, or of a new one. Grows by doubling in the arena. */
static bool intern(struct arena *arena, void **list, size_t *count, size_t *capacity, const void *item, size_t size,
                   uint32_t *out)
{
  enum { LOOK_BACK = 32 };
  for (size_t k = *count; k > 0 && *count - k < LOOK_BACK; k--) {
    if (memcmp((char *)*list + (k - 1) * size, item, size) != 0) continue;
    *out = (uint32_t)(k - 1);
    return true;
  }
  if (*count == *capacity) {
    const size_t wanted = *capacity ? 2 * *capacity : 16;
    void *grown = arena_alloc(arena, wanted, size);
    if (!grown) return false;
    if (*count) memcpy(grown, *list, *count * size);
    *list = grown, *capacity = wanted;
  }
  memcpy((char *)*list + *count * size, item, size);
  *out = (uint32_t)(*count)++;
  return true;
}

static bool expand_patch(struct expansion *e, const struct node *node, const struct inherited *with)
{
  struct scene *scene = e->scene;
  struct scene_patch *patch = &scene->patches[scene->patch_count++];
  for (int i = 0; i < 4; i++) {
    for (int j = 0; j < 4; j++) {
      transform_point(&with->transform, node->P[i][j], patch->P[i][j]);
      for (int k = 0; k < 3; k++) e->finite &= isfinite(patch->P[i][j][k]) != 0;
    }
  }
  patch->type = node->type, patch->flatness = node->flatness, patch->u_steps = node->u_steps, patch->v_steps = node->v_steps;
  const struct texture none = texture_default();
  const struct scene_texture *texture = with->texture ? &with->texture->is : &none.is;
  if (!intern(scene->arena, (void **)&scene->textures, &scene->texture_count, &e->texture_capacity, texture, sizeof *texture,
              &patch->texture))
    return false;
  if (!with->solver) return true; /* 0: the scene's */
  return intern(scene->arena, (void **)&scene->solvers, &scene->solver_count, &e->solver_capacity, with->solver,
                sizeof *with->solver, &patch->solver);
}

static bool expand(struct expansion *e, const struct node *node, const struct inherited *above)
{
  struct inherited with = {transform_then(&node->transform, &above->transform),
                           node->texture.set ? &node->texture : above->texture, node->solver ? node->solver : above->solver};
  if (node->P) return expand_patch(e, node, &with);
  for (const struct node *child = node->first; child; child = child->next)
    if (!expand(e, child, &with)) return false;
  return true;
}

enum status objects_expand(struct language *language, struct scene *scene)
{
  struct expansion e = {.language = language, .scene = scene, .solver_capacity = 1, .finite = true};
  scene->solvers = arena_alloc(scene->arena, 1, sizeof *scene->solvers);
  scene->patches = arena_alloc(scene->arena, language->scene.patch_count + 1, sizeof *scene->patches);
  if (!scene->solvers || !scene->patches) return STATUS_LIMIT;
  scene->solvers[0] = language->global_solver;
  scene->solver_count = 1;
  const struct inherited nothing = {transform_identity(), NULL, NULL};
  if (!expand(&e, &language->scene, &nothing)) return STATUS_LIMIT;
  if (e.finite) return STATUS_OK;
  const struct place nowhere = {NULL, 0, 0};
  language_error(language, nowhere, "a control point is too large for a number once its transforms are applied");
  return STATUS_INPUT;
}
