/* Pigments, finishes and textures. */
#include "language/textures.h"

#include <assert.h>

#include "language/symbols.h"

static_assert(sizeof(struct scene_texture) == PARTS * sizeof(double), "a texture is PARTS doubles");

const struct texture TEXTURE_OF_POVRAY = {.block = TEXTURE_ALL,
                                          .set = TEXTURE_ALL,
                                          .is = {.pigment = {0, 0, 0},
                                                 .finish = {.ambient = {0.1, 0.1, 0.1},
                                                            .diffuse = 0.6,
                                                            .brilliance = 1,
                                                            .phong = 0,
                                                            .phong_size = 40,
                                                            .specular = 0,
                                                            .roughness = 0.05}}};

void texture_apply(struct texture *to, const struct texture *from)
{
  for (int k = 0; k < PARTS; k++)
    if (from->set >> k & 1) to->part[k] = from->part[k];
  to->set |= from->set;
}

void texture_begin(struct language *language, struct span place, enum texture_block block)
{
  struct texture *texture = language_alloc(language, sizeof *texture);
  *texture = *language->texture_default;
  texture->stage = STAGE_SETTINGS;
  texture->place = place;
  texture->block = block;
  if (block != TEXTURE_ALL) texture->set = 0;
  texture->outer = language->texture;
  language->texture = texture;
}

struct texture *texture_end(struct language *language, struct span brace)
{
  struct texture *texture = language->texture;
  texture->place = span_join(texture->place, brace);
  language->texture = texture->outer;
  return texture;
}

void texture_merge(struct language *language, const struct texture *texture)
{
  language->texture->stage = STAGE_BODY;
  texture_apply(language->texture, texture);
}

void texture_moved(struct language *language) { language->texture->stage = STAGE_MODIFIERS; }

static void apply_named(struct language *language, const struct value *value, bool first)
{
  struct texture *texture = language->texture;
  if (!first) language_error(language, value->place, "a declared name must come first in %s", texture_kind(texture));
  texture_apply(texture, value->texture);
}

/* A texture may begin with a declared texture, pigment or finish; a pigment or a finish with one of its own kind. */
void texture_named(struct language *language, const struct value *value)
{
  struct texture *texture = language->texture;
  const bool first = texture->stage == STAGE_SETTINGS;
  texture->stage = STAGE_BODY;
  if (value->kind == VALUE_TEXTURE && (value->texture->block & ~texture->block) == 0)
    apply_named(language, value, first);
  else symbol_mistaken(language, value, texture_kind(texture));
}

void pigment_value(struct language *language, const struct value *value)
{
  struct texture *texture = language->texture;
  const enum stage stage = texture->stage;
  texture->stage = STAGE_BODY;
  if (value->kind == VALUE_TEXTURE && value->texture->block == TEXTURE_PIGMENT) {
    apply_named(language, value, stage == STAGE_SETTINGS);
    return;
  }
  if (value->kind >= VALUE_NONE) {
    symbol_mistaken(language, value, "a colour");
    texture->doubtful = true;
  }
  if (texture->doubtful) return;
  if (value->kind == VALUE_NUMBER || value->kind == VALUE_VECTOR) {
    language_error(language, value->place, "a pigment needs a colour: write rgb before this");
    return;
  }
  if (texture->coloured) language_error(language, value->place, "a pigment has one colour");
  else if (stage == STAGE_MODIFIERS)
    language_error(language, value->place, "the colour of a pigment must come before its transforms");
  texture->coloured = true;
  value_to_opaque(language, value, texture->is.pigment);
  texture->set |= TEXTURE_PIGMENT;
}

void finish_ambient(struct language *language, const struct value *value)
{
  struct texture *texture = language->texture;
  texture->stage = STAGE_BODY;
  value_to_colour(language, value, texture->is.finish.ambient);
  texture->set |= 7u << PART_AMBIENT;
}

void finish_number(struct language *language, int part, const struct value *value)
{
  struct texture *texture = language->texture;
  double x;
  texture->stage = STAGE_BODY;
  if (!value_to_number(language, value, &x)) return;
  if (!value_is_float(x)) {
    language_error(language, value->place, "a finish's numbers must be from -3.4e38 to 3.4e38");
    return;
  }
  if (part == PART_ROUGHNESS && !((float)x > 0)) { /* POV-Ray's are floats, and it ignores a 0 */
    language_error(language, value->place, "roughness must be above 0");
    return;
  }
  texture->part[part] = x;
  texture->set |= 1u << part;
}

struct value *value_of_texture(struct language *language, const struct texture *texture)
{
  struct value *value = value_of(language, VALUE_TEXTURE, texture->place);
  struct texture *whole = language_alloc(language, sizeof *whole);
  *whole = *texture;
  whole->set = texture->block;
  value->texture = whole;
  return value;
}

void declare_texture(struct language *language, struct declaration *declaration, const struct texture *texture)
{
  language->layered = declaration->to;
  declare_value(language, declaration, value_last(language, value_of_texture(language, texture)));
}

void layer_begin(struct language *language, struct span place)
{
  declare_again(language, language->layered);
  texture_begin(language, place, TEXTURE_ALL);
}

void layer_end(struct language *language, struct span brace)
{
  declare_texture(language, language->declaration, texture_end(language, brace));
}

void texture_set_default(struct language *language, const struct texture *texture)
{
  if (language->texture)
    language_error(language, texture->place, "in POV-Ray, a #default within a texture ends with it");
  struct texture *whole = language_alloc(language, sizeof *whole);
  *whole = *language->texture_default;
  texture_apply(whole, texture);
  language->texture_default = whole;
}
