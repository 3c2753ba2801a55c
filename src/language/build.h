/* What the grammar's actions do: from values, statements and objects to a scene.
 *
 * Internal to src/language and grammar/. An action that finds an error tells it and goes on with a harmless value, so that one run
 * finds many errors; a scene comes out only where none was found.
 */
#ifndef PSCN_LANGUAGE_BUILD_H
#define PSCN_LANGUAGE_BUILD_H

#include <stdbool.h>
#include <stddef.h>

#include "base/arena.h"
#include "base/diagnostics.h"
#include "base/source.h"
#include "scene/scene.h"

/* A syntax error within so many tokens of a foreign word is its consequence, and not told. */
enum { FOREIGN_ECHO = 4 };

/* What a token is beside its kind. The text is not terminated and lives as long as its source. */
struct token {
  const char *text;
  size_t length;
  double number[3];
  int index;
  bool local;
};

enum value_kind { VALUE_NUMBER, VALUE_VECTOR };

/* A number stands in x[0]; colours are vectors (red, green, blue). */
struct value {
  enum value_kind kind;
  double x[3];
};

/* p' = p A + b with row vectors; `identity` where nothing has been applied, so that points stay as they are to the bit. */
struct transform {
  bool identity;
  long double A[3][3], b[3];
};

/* Which parts of a texture are set. */
enum {
  TEXTURE_PIGMENT = 1,
  TEXTURE_AMBIENT = 2,
  TEXTURE_DIFFUSE = 4,
  TEXTURE_BRILLIANCE = 8,
  TEXTURE_PHONG = 16,
  TEXTURE_PHONG_SIZE = 32,
  TEXTURE_SPECULAR = 64,
  TEXTURE_ROUGHNESS = 128,
  TEXTURE_FINISH = 254,
  TEXTURE_ALL = 255
};

struct texture {
  unsigned block; /* TEXTURE_PIGMENT, TEXTURE_FINISH or TEXTURE_ALL: the statement it comes from */
  unsigned set;
  struct scene_texture is;
};

/* A patch or a union, with what was said of it. Declared ones are shared: their children are never changed. */
struct node {
  struct node *next, *first, *last; /* the list it stands in; its own children */
  struct node *outer;               /* while its block is open */
  double (*P)[4][3];                /* NULL: a union */
  int points, type, u_steps, v_steps;
  double flatness;
  struct transform transform;
  struct texture texture;
  const struct solver_options *solver; /* or NULL */
  size_t patch_count;                  /* in it and below, saturating */
  int height;
};

struct symbol;
struct frame;

struct camera_items {
  double item[6][3];
  bool look_at;
  double angle; /* degrees, NAN where not given */
  size_t errors_before;
  struct place place, look_at_place;
};

struct light_node {
  struct light_node *next;
  struct scene_light light;
  struct transform transform;
};

/* The state of one reading. */
struct language {
  struct diagnostics *diagnostics;
  struct arena *arena; /* of what is needed while reading only */
  int width, height;
  bool no_memory;      /* memory, or a stated limit: STATUS_LIMIT */

  char spare[1024];    /* stands in for memory that there is not */

  bool solver_only, solver_begun; /* the text is what follows `solver` */
  struct frame *frame; /* tokens.c: the sources being read */
  struct source_list *all_sources;
  int include_depth;
  int foreign_distance; /* tokens since a foreign word: its consequences are not errors of their own */
  int raw_words;        /* in a solver statement all words are plain: 1 before the name, 2 after it, 3 in its block */

  struct symbol **symbols; /* symbols.c */

  struct node *open; /* the innermost open object */
  int nesting;
  struct texture *textures_open[3]; /* texture, and pigment or finish in it */
  int texture_depth;
  long double matrix[12];
  int matrix_count;
  struct solver_options solver;
  struct place solver_place;

  struct camera_items camera;
  bool has_camera;
  struct light_node *lights, **lights_end;
  struct light_node *light;
  struct node scene; /* the union of all objects */
  struct solver_options global_solver;
  double background[3], ambient_light[3];
};

/* ---- language.c ---- */
void language_error(struct language *language, struct place place, const char *format, ...)
    __attribute__((format(printf, 3, 4)));
struct place language_span(const struct place *first, const struct place *last);
void language_resume(struct language *language); /* after a broken statement: open blocks are closed */
void language_unexpected(struct language *language, struct place place, const char *found, bool found_word,
                         const char *const expected[], int count);
void *language_alloc(struct language *language, size_t size); /* zeroed, never NULL: the process of reading ends instead */

/* ---- values.c ---- */
struct value value_of_number(double x);
struct value value_of_vector(const double x[3]);
struct value value_axis(int axis);
struct value value_pi(void);
struct value value_named(struct language *language, struct place place, const struct token *name);
struct value value_binary(struct language *language, struct place place, char op, const struct value *a, const struct value *b);
struct value value_negative(const struct value *a);
struct value value_component(struct language *language, struct place place, const struct value *a, int index);
struct value value_rgb(const struct value *a);
struct value value_vector3(struct language *language, struct place place, const struct value *x, const struct value *y,
                           const struct value *z);
/* As a vector: a number stands for three of it. As a number: a vector is an error. */
void value_to_vector(const struct value *a, double out[3]);
double value_to_number(struct language *language, struct place place, const struct value *a);
/* As a number in [low, high] or an error saying `what` must be so. */
double value_in_range(struct language *language, struct place place, const struct value *a, const char *what, double low,
                      double high, bool whole);

/* ---- symbols.c ---- */
enum symbol_kind { SYMBOL_VALUE, SYMBOL_TEXTURE, SYMBOL_OBJECT };
struct symbol {
  struct symbol *next;
  const char *name;
  size_t length;
  unsigned hash;
  int depth; /* 0: #declare; otherwise the include depth of its #local */
  enum symbol_kind kind;
  struct value value;
  struct texture texture;
  struct node *object;
};
bool symbols_create(struct language *language);
void symbols_destroy(struct language *language);
struct symbol *symbol_find(struct language *language, const char *name, size_t length);
void symbols_leave(struct language *language, int depth); /* forgets the locals of that include depth */
/* Tells that a name is unknown, with a guess; `where` names what was wanted. */
void symbol_unknown(struct language *language, struct place place, const struct token *name, const char *where);
void declare_value(struct language *language, struct place place, const struct token *name, const struct value *value);
void declare_object(struct language *language, struct place place, const struct token *name, struct node *object);
void declare_texture(struct language *language, struct place place, const struct token *name, const struct texture *texture);

/* ---- settings.c: global_settings, camera, lights, background ---- */
enum { CAMERA_LOCATION, CAMERA_DIRECTION, CAMERA_RIGHT, CAMERA_UP, CAMERA_SKY, CAMERA_LOOK_AT };
void language_version(struct language *language, struct place place, const struct value *value);
void global_gamma(struct language *language, struct place place, const struct value *value);
void global_trace_level(struct language *language, struct place place, const struct value *value);
void global_ambient(struct language *language, struct place place, const struct value *value);
void global_solver(struct language *language);
void camera_default(struct camera_items *out);
void camera_begin(struct language *language, struct place place);
void camera_vector(struct language *language, int which, struct place place, const struct value *value);
void camera_angle(struct language *language, struct place place, const struct value *value);
void camera_end(struct language *language, struct place place);
/* Folds the items into `out`; false, and an error told, where they make no picture. */
bool camera_fold(struct language *language, const struct camera_items *items, struct scene_camera *out);
void light_begin(struct language *language, struct place place, const struct value *at, struct place color_place,
                 const struct value *color);
void light_shadowless(struct language *language);
void light_transform(struct language *language, struct place place, const struct transform *transform);
void background_set(struct language *language, struct place place, const struct value *value);

/* ---- objects.c ---- */
enum { PATCH_TYPE, PATCH_FLATNESS, PATCH_U_STEPS, PATCH_V_STEPS };
void patch_begin(struct language *language, struct place place);
void patch_number(struct language *language, int which, struct place place, const struct value *value);
void patch_point(struct language *language, struct place place, const struct value *value);
void patch_points_end(struct language *language, struct place place);
void union_begin(struct language *language, struct place place);
void union_add(struct language *language, struct place place, struct node *object);
void named_begin(struct language *language, struct place place, const struct token *name);
void wrapped_begin(struct language *language, struct place place, struct node *object);
struct node *node_end(struct language *language);
void node_transform(struct language *language, struct place place, const struct transform *transform);
void node_texture(struct language *language, const struct texture *texture);
void node_solver(struct language *language, struct place place);
void scene_add(struct language *language, struct place place, struct node *object);
/* Puts all patches of language->scene, with their textures and solvers, into the scene. */
enum status objects_expand(struct language *language, struct scene *scene) STATUS_MUST_CHECK;

/* ---- transforms.c ---- */
struct transform transform_identity(void);
struct transform transform_translate(struct language *language, struct place place, const struct value *value);
struct transform transform_rotate(struct language *language, struct place place, const struct value *value);
struct transform transform_scale(struct language *language, struct place place, const struct value *value);
void matrix_begin(struct language *language);
void matrix_add(struct language *language, struct place place, const struct value *value);
struct transform matrix_end(struct language *language, struct place place);
/* first, then second. */
struct transform transform_then(const struct transform *first, const struct transform *second);
void transform_point(const struct transform *transform, const double p[3], double out[3]); /* out may be p */

/* ---- textures.c ---- */
enum { FINISH_DIFFUSE, FINISH_BRILLIANCE, FINISH_PHONG, FINISH_PHONG_SIZE, FINISH_SPECULAR, FINISH_ROUGHNESS };
struct texture texture_default(void);
void texture_begin(struct language *language, unsigned block);
struct texture texture_end(struct language *language);
void texture_named(struct language *language, struct place place, const struct token *name);
void texture_merge(struct language *language, const struct texture *texture);
void texture_transform(struct language *language, const struct transform *transform);
/* What is set in `from` replaces what is in `to`. */
void texture_apply(struct texture *to, const struct texture *from);
void pigment_named(struct language *language, struct place place, const struct token *name);
void pigment_colour(struct language *language, struct place place, const struct value *value);
void finish_ambient(struct language *language, struct place place, const struct value *value);
void finish_number(struct language *language, int which, struct place place, const struct value *value);

/* ---- solver_statement.c ---- */
void solver_begin(struct language *language, struct place place, const struct token *name);
/* A solver statement by itself: allowed in --solver only. */
void solver_statement(struct language *language, struct place place);
void solver_number(struct language *language, struct place place, const struct token *item, struct place value_place, double value);
void solver_word(struct language *language, struct place place, const struct token *item, struct place value_place,
                 const struct token *value);

#endif
