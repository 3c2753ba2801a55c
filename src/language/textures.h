/* Pigments, finishes and textures; the defaults are POV-Ray's. */
#ifndef PSCN_LANGUAGE_TEXTURES_H
#define PSCN_LANGUAGE_TEXTURES_H

#include "language/values.h"
#include "scene/scene.h"

/* The doubles of a scene_texture, by number; and those that a block can set, as bits. */
enum {
  PART_PIGMENT = 0,
  PART_AMBIENT = 3,
  PART_DIFFUSE = 6,
  PART_BRILLIANCE,
  PART_PHONG,
  PART_PHONG_SIZE,
  PART_SPECULAR,
  PART_ROUGHNESS,
  PARTS
};
enum texture_block { TEXTURE_PIGMENT = 0x007, TEXTURE_FINISH = 0xff8, TEXTURE_ALL = 0xfff };

struct texture {
  struct texture *outer; /* the block around it, while it is open */
  struct span place;
  enum texture_block block; /* the statement it comes from */
  unsigned set;
  enum stage stage;        /* of the open block: first its declared name or colour, then the rest */
  bool coloured, doubtful; /* the open pigment has a colour; or what may have been meant as one */
  union {
    struct scene_texture is;
    double part[PARTS];
  };
};

static inline const char *texture_kind(const struct texture *texture)
{
  const enum texture_block block = texture->block;
  return block == TEXTURE_ALL ? "a texture" : block == TEXTURE_FINISH ? "a finish" : "a pigment";
}

/* The texture until the first #default, which only affects what follows it. */
extern const struct texture TEXTURE_OF_POVRAY;
void texture_set_default(struct language *language, const struct texture *texture);
/* The parts that are set in `from` replace those in `to`. */
void texture_apply(struct texture *to, const struct texture *from);

/* Actions of the grammar, in the order of the text. Between a begin and its end they concern the innermost block. */
void texture_begin(struct language *language, struct span place, enum texture_block block);
struct texture *texture_end(struct language *language, struct span brace);
void texture_named(struct language *language, const struct value *value);
void texture_merge(struct language *language, const struct texture *texture);
void texture_moved(struct language *language); /* a transform, which does not change a plain colour */
void pigment_value(struct language *language, const struct value *value);
void finish_ambient(struct language *language, const struct value *value);
void finish_number(struct language *language, int part, const struct value *value);
/* A texture as a value. A declared block is complete: what it does not set has the default. */
struct value *value_of_texture(struct language *language, const struct texture *texture);
/* A declared texture, to which layers may be added. As what is rendered is opaque, the last one counts. */
void declare_texture(struct language *language, struct declaration *declaration, const struct texture *texture);
void layer_begin(struct language *language, struct span place);
void layer_end(struct language *language, struct span brace);

#endif
