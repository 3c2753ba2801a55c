/* Pigments, finishes and textures; the defaults are POV-Ray's. */
#include <math.h>

#include "language/build.h"

struct texture texture_default(void)
{
  return (struct texture){TEXTURE_ALL, TEXTURE_ALL,
                          {.pigment = {0, 0, 0},
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

static struct texture *current(struct language *language) { return language->textures_open[language->texture_depth - 1]; }

void texture_begin(struct language *language, unsigned block)
{
  struct texture *texture = language_alloc(language, sizeof *texture);
  *texture = texture_default();
  texture->block = block;
  if (block != TEXTURE_ALL) texture->set = 0;
  if (language->texture_depth < 3) language->textures_open[language->texture_depth++] = texture;
}

struct texture texture_end(struct language *language) { return *language->textures_open[--language->texture_depth]; }

void texture_merge(struct language *language, const struct texture *texture) { texture_apply(current(language), texture); }

/* A flat colour looks the same from everywhere. */
void texture_transform(struct language *language, const struct transform *transform) { (void)language, (void)transform; }

static const char *block_name(unsigned block)
{
  return block == TEXTURE_ALL ? "a texture" : block == TEXTURE_FINISH ? "a finish" : "a pigment";
}

/* The declared texture, pigment or finish of that name for the open block, or NULL and an error. */
static const struct texture *named(struct language *language, struct place place, const struct token *name)
{
  const unsigned block = current(language)->block;
  const struct symbol *symbol = symbol_find(language, name->text, name->length);
  if (!symbol) symbol_unknown(language, place, name, block_name(block));
  else if (symbol->kind != SYMBOL_TEXTURE || symbol->texture.block != block)
    language_error(language, place, "'%.*s' is no name of %s", (int)name->length, name->text, block_name(block));
  else return &symbol->texture;
  return NULL;
}

void texture_named(struct language *language, struct place place, const struct token *name)
{
  const struct texture *texture = named(language, place, name);
  if (texture) texture_apply(current(language), texture);
}

void pigment_named(struct language *language, struct place place, const struct token *name)
{
  const struct symbol *symbol = symbol_find(language, name->text, name->length);
  if (symbol && symbol->kind == SYMBOL_VALUE) pigment_colour(language, place, &symbol->value);
  else texture_named(language, place, name);
}

void pigment_colour(struct language *language, struct place place, const struct value *value)
{
  (void)place;
  struct texture *texture = current(language);
  value_to_vector(value, texture->is.pigment);
  texture->set |= TEXTURE_PIGMENT;
}

void finish_ambient(struct language *language, struct place place, const struct value *value)
{
  (void)place;
  struct texture *texture = current(language);
  value_to_vector(value, texture->is.finish.ambient);
  texture->set |= TEXTURE_AMBIENT;
}

void finish_number(struct language *language, int which, struct place place, const struct value *value)
{
  struct texture *texture = current(language);
  struct scene_finish *finish = &texture->is.finish;
  const double x = value_to_number(language, place, value);
  switch (which) {
  case FINISH_DIFFUSE: finish->diffuse = x, texture->set |= TEXTURE_DIFFUSE; break;
  case FINISH_BRILLIANCE: finish->brilliance = x, texture->set |= TEXTURE_BRILLIANCE; break;
  case FINISH_PHONG: finish->phong = x, texture->set |= TEXTURE_PHONG; break;
  case FINISH_PHONG_SIZE: finish->phong_size = x, texture->set |= TEXTURE_PHONG_SIZE; break;
  case FINISH_SPECULAR: finish->specular = x, texture->set |= TEXTURE_SPECULAR; break;
  case FINISH_ROUGHNESS:
    if (!(x > 0)) language_error(language, place, "roughness must be above 0");
    else finish->roughness = x, texture->set |= TEXTURE_ROUGHNESS;
    break;
  }
}
