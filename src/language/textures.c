/* Pigments, finishes and textures; the defaults are POV-Ray's. */
#include "language/build.h"

struct texture texture_default(void)
{
  return (struct texture){.block = TEXTURE_ALL, .set = TEXTURE_ALL,
                          .is = {.pigment = {0, 0, 0},
                                 .finish = {.ambient = {0.1, 0.1, 0.1}, .diffuse = 0.6, .brilliance = 1, .phong = 0,
                                            .phong_size = 40, .specular = 0, .roughness = 0.05}}};
}

void texture_apply(struct texture *to, const struct texture *from)
{
  struct scene_texture *t = &to->is;
  const struct scene_texture *f = &from->is;
  for (int k = 0; k < 3; k++) {
    if (from->set & TEXTURE_PIGMENT) t->pigment[k] = f->pigment[k];
    if (from->set & TEXTURE_AMBIENT) t->finish.ambient[k] = f->finish.ambient[k];
  }
  if (from->set & TEXTURE_DIFFUSE) t->finish.diffuse = f->finish.diffuse;
  if (from->set & TEXTURE_BRILLIANCE) t->finish.brilliance = f->finish.brilliance;
  if (from->set & TEXTURE_PHONG) t->finish.phong = f->finish.phong;
  if (from->set & TEXTURE_PHONG_SIZE) t->finish.phong_size = f->finish.phong_size;
  if (from->set & TEXTURE_SPECULAR) t->finish.specular = f->finish.specular;
  if (from->set & TEXTURE_ROUGHNESS) t->finish.roughness = f->finish.roughness;
  to->set |= from->set;
}

void texture_begin(struct language *language, unsigned block)
{
  struct texture *texture = language_alloc(language, sizeof *texture);
  *texture = texture_default();
  texture->block = block;
  if (block != TEXTURE_ALL) texture->set = 0;
  texture->outer = language->texture;
  language->texture = texture;
}

struct texture *texture_end(struct language *language)
{
  struct texture *texture = language->texture;
  language->texture = texture->outer;
  return texture;
}

void texture_merge(struct language *language, const struct texture *texture)
{
  language->texture->stage = STAGE_BODY;
  texture_apply(language->texture, texture);
}

void texture_moved(struct language *language) { language->texture->stage = STAGE_MODIFIERS; }

static const char *block_name(unsigned block)
{
  return block == TEXTURE_ALL ? "a texture" : block == TEXTURE_FINISH ? "a finish" : "a pigment";
}

static void tell_not_first(struct language *language, struct place place, const struct texture *texture)
{
  language_error(language, place, "a declared name stands first in %s", block_name(texture->block));
}

/* A texture may begin with a declared texture, pigment or finish; a pigment and a finish with one of their own. */
void texture_named(struct language *language, struct place place, const struct token *name)
{
  struct texture *texture = language->texture;
  const struct symbol *symbol = symbol_find(language, name->text, name->length);
  const bool first = texture->stage == STAGE_SETTINGS;
  texture->stage = STAGE_BODY;
  if (!symbol) {
    symbol_unknown(language, place, name, block_name(texture->block));
  } else if (symbol->kind == SYMBOL_TEXTURE && (symbol->texture->block & ~texture->block) == 0) {
    if (!first) tell_not_first(language, place, texture);
    texture_apply(texture, symbol->texture);
  } else if (symbol->kind != SYMBOL_BROKEN) {
    symbol_mistaken(language, place, symbol, block_name(texture->block));
  }
}

void pigment_value(struct language *language, struct place place, const struct value *value)
{
  struct texture *texture = language->texture;
  const struct symbol *symbol = value->symbol;
  const enum stage stage = texture->stage;
  texture->stage = STAGE_BODY;
  if (value->kind == VALUE_NAMED && symbol->kind == SYMBOL_TEXTURE && symbol->texture->block == TEXTURE_PIGMENT) {
    if (stage != STAGE_SETTINGS) tell_not_first(language, place, texture);
    texture_apply(texture, symbol->texture);
    return;
  }
  if (value->kind == VALUE_UNKNOWN) texture->doubtful = true;
  if (texture->doubtful) return;
  if (value->kind == VALUE_NUMBER || value->kind == VALUE_VECTOR) {
    language_error(language, place, "a pigment wants a colour: write rgb before this");
    return;
  }
  if (texture->coloured) language_error(language, place, "a pigment has one colour");
  else if (stage == STAGE_MODIFIERS)
    language_error(language, place, "the colour of a pigment stands before its transforms");
  texture->coloured = true;
  value_to_opaque(language, place, value, texture->is.pigment);
  texture->set |= TEXTURE_PIGMENT;
}

void finish_ambient(struct language *language, struct place place, const struct value *value)
{
  struct texture *texture = language->texture;
  texture->stage = STAGE_BODY;
  value_to_colour(language, place, value, texture->is.finish.ambient);
  texture->set |= TEXTURE_AMBIENT;
}

void finish_number(struct language *language, int which, struct place place, const struct value *value)
{
  struct texture *texture = language->texture;
  struct scene_finish *finish = &texture->is.finish;
  double x;
  texture->stage = STAGE_BODY;
  if (!value_to_number(language, place, value, &x)) return;
  switch (which) {
  case FINISH_DIFFUSE: finish->diffuse = x, texture->set |= TEXTURE_DIFFUSE; break;
  case FINISH_BRILLIANCE: finish->brilliance = x, texture->set |= TEXTURE_BRILLIANCE; break;
  case FINISH_PHONG: finish->phong = x, texture->set |= TEXTURE_PHONG; break;
  case FINISH_PHONG_SIZE: finish->phong_size = x, texture->set |= TEXTURE_PHONG_SIZE; break;
  case FINISH_SPECULAR: finish->specular = x, texture->set |= TEXTURE_SPECULAR; break;
  default:
    if (x > 0) finish->roughness = x, texture->set |= TEXTURE_ROUGHNESS;
    else language_error(language, place, "roughness must be above 0");
    break;
  }
}
