/* Patches, unions and copies of declared objects. */
#include "language/objects.h"

#include <math.h>
#include <stdio.h>

#include "language/sources.h"
#include "language/tokens.h"

/* Patches of one scene: as many as fit in the memory of a large machine. */
#define MAX_PATCHES ((size_t)50 * 1000 * 1000)

/* The memory that one more patch takes until rays can be traced: its net, its frame, its boxes. A copy takes 1,280
 * bytes if there are 65,536 to 262,144 of them, and 1,457 from there to 1,048,576; one of as many different patches
 * takes 1,000. The leaves that fewer patches are cut into are extra, 1.3 KB each: in all 350 MB, or 700 where `split`
 * or the bending of patches asks for more (model.c). */
#define PATCH_BYTES ((size_t)1500)

enum {
  PATCH_POINTS = 16,
  MAX_STEPS = 16 /* POV-Ray halves a patch at most this often in each direction */
};

struct open_node *node_begin(struct language *language, struct span place)
{
  struct objects *objects = language->objects;
  struct open_node *open = objects->closed;
  if (open) objects->closed = open->outer;
  else open = language_alloc(language, sizeof *open);
  *open = (struct open_node){.outer = objects->open, .node.place = place, .block = language_block(language, place)};
  return objects->open = open;
}

/* Its memory is reused for the next node. */
struct node *node_end(struct language *language, struct span brace)
{
  struct objects *objects = language->objects;
  struct open_node *open = objects->open;
  struct node *node = language_alloc(language, sizeof *node);
  *node = open->node;
  objects->whole = span_join(node->place, brace);
  objects->open = open->outer;
  open->outer = objects->closed;
  objects->closed = open;
  return node;
}

/* ---- patches ---- */

void patch_begin(struct language *language, struct span place)
{
  struct node *node = &node_begin(language, place)->node;
  node->net = language_alloc(language, sizeof *node->net);
  node->patch_count = 1;
}

void patch_number(struct language *language, int which, struct span item, const struct value *value)
{
  static const struct {
    const char *name;
    double high;
    bool whole;
  } settings[PATCH_SETTINGS] = {{"type", INFINITY, true},
                                {"flatness", INFINITY, false},
                                {"u_steps", MAX_STEPS, true},
                                {"v_steps", MAX_STEPS, true}};
  struct open_node *open = language->objects->open;
  if (open->stage != STAGE_SETTINGS) {
    language_error(language, item, "the settings of a bicubic_patch must come before its control points");
    return;
  }
  open->has_type |= which == PATCH_TYPE;
  value_in_range(language, value, settings[which].name, 0, settings[which].high, settings[which].whole,
                 &open->node.net->setting[which]);
  if (which == PATCH_TYPE && open->node.net->setting[PATCH_TYPE] > 1) {
    diagnostics_warning(language->diagnostics, sources_place(language, value->place),
                        "this type is read as 1, as in POV-Ray");
    open->node.net->setting[PATCH_TYPE] = 1;
  }
}

void patch_point(struct language *language, const struct value *value)
{
  struct open_node *open = language->objects->open;
  if (open->stage == STAGE_MODIFIERS) {
    language_error(language, value->place,
                   "the control points of a bicubic_patch must come before its texture and transforms");
    return;
  }
  open->stage = STAGE_BODY;
  double more[3]; /* converted all the same: it may be a misspelt word */
  const bool fits = open->points < PATCH_POINTS;
  value_to_vector(language, value, fits ? open->node.net->P[open->points / 4][open->points % 4] : more);
  open->points++;
}

void patch_modified(struct language *language)
{
  struct open_node *open = language->objects->open;
  open->stage = STAGE_MODIFIERS;
  if (!language_sound(language, &open->block)) return;
  if (open->points != PATCH_POINTS)
    language_error(language, open->block.place, "bicubic_patch needs %d control points, found %d", PATCH_POINTS,
                   open->points);
}

void patch_solver(struct language *language)
{
  patch_modified(language);
  language->objects->open->node.method = language->method;
}

void patch_end(struct language *language)
{
  const struct open_node *open = language->objects->open;
  patch_modified(language);
  if (!open->has_type)
    language_error_in(language, &open->block, open->block.place, "bicubic_patch needs its type, 0 or 1");
  sources_pass(language);
}

/* ---- unions ---- */

/* Patches are counted, and not built, until all text has been read. */
static void count_patches(struct language *language, const struct node *parent, struct span place)
{
  char text[100];
  const size_t affordable = language->max_memory / PATCH_BYTES;
  const size_t most = affordable < MAX_PATCHES ? affordable : MAX_PATCHES;
  if (parent->patch_count <= most) return;
  snprintf(text, sizeof text, "the scene has more than %zu patches%s", most,
           affordable < MAX_PATCHES ? "; --max-memory allows more" : "");
  language_limit(language, place, text);
}

/* A child without patches is not listed: each copy of the parent, of which there may be many, would search it in
 * vain. */
static void add_child(struct language *language, struct open_node *open, struct node *child)
{
  const struct objects *objects = language->objects;
  struct node *parent = &open->node;
  if (child->patch_count > 0) {
    if (open->last) open->last->next = child;
    else parent->first = child;
    open->last = child;
  }
  parent->patch_count += child->patch_count;
  count_patches(language, parent, objects->whole);
  if (child->height >= parent->height) parent->height = child->height + 1;
  if (parent->height == MAX_NESTING && open != &objects->scene)
    language_limit(language, objects->whole, "objects are nested more than 200 deep");
}

void union_add(struct language *language, struct node *object)
{
  struct open_node *open = language->objects->open;
  if (open->stage == STAGE_MODIFIERS)
    language_error_in(language, &open->block, language->objects->whole,
                      "the objects of a union must come before its texture and transforms");
  add_child(language, open, object);
}

void union_modified(struct language *language) { language->objects->open->stage = STAGE_MODIFIERS; }

void scene_add(struct language *language, struct node *object)
{
  if (!object->texture) object->texture = language->texture_default;
  add_child(language, &language->objects->scene, object);
}

/* ---- copies ---- */

static void take_object(struct language *language, struct span place, const struct node *object)
{
  struct open_node *open = language->objects->open;
  if (open->has_object || open->stage == STAGE_MODIFIERS) {
    language_error(language, place, "object { } holds one object, which must come first; use union for several");
    return;
  }
  const struct span begin = open->node.place;
  open->node = *object;
  open->node.place = begin;
  open->stage = STAGE_BODY;
  open->has_object = true;
}

void copy_object(struct language *language, const struct node *object)
{
  take_object(language, language->objects->whole, object);
}

/* Copies the name, whose text may be released before the scene is made. */
static void take_name(struct language *language, const struct value *value)
{
  struct name name = sources_name(language, value->place);
  name.text = language_keep(language, name.text, name.length);
  value->object->sharing->name = name;
}

void copy_named(struct language *language, const struct value *value)
{
  if (value->kind == VALUE_OBJECT) {
    if (value->object->sharing->uses++ == 0) take_name(language, value);
    language->objects->copies++;
    take_object(language, value->place, value->object);
  } else {
    symbol_mistaken(language, value, "an object");
  }
  language->objects->open->has_object = true; /* it was meant to have one */
}

void copy_modified(struct language *language, struct span place)
{
  struct open_node *open = language->objects->open;
  if (!open->has_object) language_error_in(language, &open->block, place, "the object in object { } must come first");
  open->stage = STAGE_MODIFIERS;
}

void copy_end(struct language *language)
{
  const struct open_node *open = language->objects->open;
  if (!open->has_object) language_error_in(language, &open->block, open->block.place, "object { } holds no object");
}

struct value *value_of_object(struct language *language, struct node *object)
{
  struct value *value = value_of(language, VALUE_OBJECT, object->place);
  if (!object->sharing) object->sharing = language_alloc(language, sizeof *object->sharing);
  value->object = object;
  return value;
}

struct node *shape_pass(struct language *language, struct span place)
{
  struct node *node = language_alloc(language, sizeof *node);
  language_lacks(language, place, place);
  node->place = place;
  language->objects->whole = span_join(place, tokens_pass_block(language));
  return node;
}

/* ---- modifiers ---- */

/* Copies share transforms and textures, so a change makes a new one. */
void node_transform(struct language *language, const struct transform *transform)
{
  struct open_node *open = language->objects->open;
  struct node *node = &open->node;
  if (transform->identity) return;
  const struct transform all = node->transform ? transform_then(node->transform, transform) : *transform;
  if (!transform_finite(&all)) {
    language_error(language, language->transform_place, "the transforms up to here are too large for numbers");
    return;
  }
  if (!open->own_transform) node->transform = language_alloc(language, sizeof *node->transform);
  open->own_transform = true;
  *node->transform = all;
}

void node_texture(struct language *language, struct texture *texture)
{
  struct node *node = &language->objects->open->node;
  struct texture all = node->texture ? *node->texture : *language->texture_default;
  texture_apply(&all, texture);
  *texture = all; /* not shared */
  node->texture = texture;
}
