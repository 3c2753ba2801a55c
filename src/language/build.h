/* What the grammar's actions do: from values, statements and objects to a scene.
 *
 * Internal to src/language and grammar/. An action that finds an error tells it and goes on with a harmless value,
 * so that one run finds many errors; a scene comes out only where none was found.
 */
#ifndef PSCN_LANGUAGE_BUILD_H
#define PSCN_LANGUAGE_BUILD_H

#include <stdbool.h>
#include <stddef.h>

#include "base/arena.h"
#include "base/diagnostics.h"
#include "base/double_double.h"
#include "base/source.h"
#include "language/table.h"
#include "scene/scene.h"

/* Blocks open within each other, and declared objects within declared objects. */
enum { MAX_NESTING = 200 };

/* What a token is beside its kind. The text is not terminated and lives as long as its source. */
struct token {
  const char *text;
  size_t length;
  union {
    double number[3];
    int index;
  };
};

struct symbol;
struct frame;

enum value_kind {
  VALUE_NUMBER, /* stands in all of x, so that it is a vector where one is wanted */
  VALUE_VECTOR,
  VALUE_COLOUR, /* red, green, blue */
  VALUE_NAMED,  /* no value, but the object or texture `symbol` */
  VALUE_UNKNOWN /* an error has been told; whatever is made of it is right */
};

struct value {
  enum value_kind kind;
  double x[3];
  const struct symbol *symbol;
  /* a colour that POV-Ray gives transparency: a number after `color` stands in all five parts there */
  bool transparent;
};

/* p' = p A + b with row vectors. `identity` where nothing has been applied, so that points stay as they are to the
 * bit. */
struct transform {
  bool identity;
  struct double_double A[3][3], b[3];
};

/* How far a block has come: what may follow. */
enum stage { STAGE_SETTINGS, STAGE_BODY, STAGE_MODIFIERS };

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
  struct texture *outer; /* while its block is open */
  unsigned block; /* TEXTURE_PIGMENT, TEXTURE_FINISH or TEXTURE_ALL: the statement it comes from */
  unsigned set;
  enum stage stage;        /* of the open block: its declared name or colour, then the rest */
  bool coloured, doubtful; /* a colour stands in the open pigment; or what may have been meant as one */
  struct scene_texture is;
};

/* What the copies of a declared object know of each other. */
struct sharing {
  size_t uses;     /* how often it is named */
  uint32_t object; /* one more than its index in scene.objects, once it is there */
};

/* A patch or a union, with what was said of it. Declared ones are shared: a copy has a node of its own, but the same
 * points or children. */
struct node {
  struct node *next, *first, *last; /* the list it stands in; its own children */
  struct node *outer;               /* while its block is open */
  struct place place;               /* of the word it begins with */
  double (*P)[4][3];                /* NULL: a union */
  int type, u_steps, v_steps;
  double flatness;
  const struct transform *transform;   /* NULL: none */
  const struct texture *texture;       /* NULL: none of its own */
  const struct method *solver; /* NULL: none of its own */
  struct sharing *sharing;             /* of the declared object that it is or copies; NULL: neither */
  size_t patch_count;                  /* in it and below */
  int height;                          /* unions below it within each other */

  /* While it is open. */
  enum stage stage;
  int points;
  bool has_type, has_object, after_comma;
  size_t errors; /* told before it began; if there are more, what is missing may be their consequence */
};

struct camera_items {
  double item[6][3];
  bool begun; /* an item has come */
  bool look_at;
  double angle; /* degrees, 0 where not given */
  struct place place, look_at_place;
  size_t errors; /* told before it began */
};

struct light_node {
  struct light_node *next;
  struct scene_light light;
  struct transform transform;
  struct place place;
  int values; /* position, colour: how many have come */
  bool after_comma, modified;
  size_t errors; /* told before it began */
};

/* The last token handed to the parser, and what it takes to hand it out again. */
struct delivered {
  int token;
  struct token value;
  struct place place;
  int depth; /* of braces, before it */
  bool again; /* it comes next once more */
};

/* The state of one reading. */
struct language {
  struct diagnostics *diagnostics;
  struct arena *arena; /* of what is needed while reading only */
  int width, height;
  bool ended_early;  /* memory, or a stated limit: STATUS_LIMIT */
  _Alignas(max_align_t) char spare[4096]; /* stands in for memory that there is not */
  size_t spare_used;

  /* tokens.c, sources.c */
  bool solver_only;    /* the text is what follows `solver` */
  int made_up;         /* tokens handed out before those of the text */
  struct frame *frame; /* the sources being read */
  struct source_list *all_sources;
  struct table files; /* the first source of each file read */
  int include_depth, source_count;
  size_t text_bytes;  /* of all sources together */
  size_t memory_bytes, max_memory; /* held while reading; allowed */
  bool unaffordable;               /* more was wanted */
  int raw_words; /* in a solver statement all words are plain: 1 before the name, 2 after it, 3 in its block */
  int depth;     /* braces open */
  struct place braces[MAX_NESTING];
  struct delivered last;
  struct place previous;        /* of the token before the last */
  struct place recovered, told; /* where the last recovery began, what the last syntax error was about */
  struct place unknown;         /* the last word told to be unknown */

  struct table symbols;  /* symbols.c */
  struct symbol *locals; /* of the files being read, the newest first */

  struct node *open; /* the innermost open object */
  int nesting;
  struct texture *texture; /* the innermost open texture, pigment or finish */
  struct transform transform; /* the last one said */
  double matrix[12];
  int matrix_count;
  struct method solver; /* the last one said */

  struct camera_items camera;
  bool has_camera;
  struct light_node *lights, **lights_end, *light;
  struct node scene; /* the union of all objects */
  struct method global_solver;
  double background[3], ambient_light[3];
  struct place background_place; /* of the open block */
  int background_values;
  size_t background_errors; /* told before it began */
};

/* ---- language.c ---- */
void language_error(struct language *language, struct place place, const char *format, ...)
    __attribute__((format(printf, 3, 4)));
/* Whether no error has been told since there were so many. */
bool language_sound(const struct language *language, size_t errors);
/* A stated limit: reading ends at the next token, with STATUS_LIMIT. */
void language_limit(struct language *language, struct place place, const char *text);
/* Whether so many more bytes are within what settings.max_memory allows; if so they are counted. */
bool language_afford(struct language *language, size_t bytes);
/* zeroed, never NULL: reading ends at the next token instead */
void *language_alloc(struct language *language, size_t size);

/* ---- errors.c ---- */
struct place language_span(const struct place *first, const struct place *last);
void language_unexpected(struct language *language, struct place place, bool is_word, const char *const expected[],
                         int count);

/* ---- values.c ---- */
struct value value_of_number(double x);
struct value value_of_vector(const double x[3]);
struct value value_of_parts(struct language *language, const struct value *x, const struct value *y,
                            const struct value *z, const struct place places[3]);
struct value value_axis(int axis);
struct value value_pi(void);
struct value value_named(struct language *language, struct place place, const struct token *name);
struct value value_binary(struct language *language, char op, const struct value *a, struct place a_place,
                          const struct value *b, struct place b_place);
struct value value_negative(struct language *language, struct place place, const struct value *a);
struct value value_component(struct language *language, struct place place, const struct value *a, int index);
struct value value_rgb(struct language *language, struct place place, const struct value *a);
struct value value_color(struct language *language, struct place place, const struct value *a);
/* What is wanted, or an error. Nothing is written to `out` then; value_to_number answers false. */
void value_to_vector(struct language *language, struct place place, const struct value *a, double out[3]);
void value_to_colour(struct language *language, struct place place, const struct value *a, double out[3]);
bool value_to_number(struct language *language, struct place place, const struct value *a, double *out);
/* As value_to_colour, where POV-Ray heeds transparency: a colour that has some there, or a bare number, is an error. */
void value_to_opaque(struct language *language, struct place place, const struct value *a, double out[3]);
/* As a number in [low, high], or an error saying that `what` must be so, and false. */
bool value_in_range(struct language *language, struct place place, const struct value *a, const char *what, double low,
                    double high, bool whole, double *out);

/* ---- symbols.c ---- */
enum symbol_kind { SYMBOL_BEGUN, SYMBOL_VALUE, SYMBOL_TEXTURE, SYMBOL_OBJECT, SYMBOL_BROKEN };
struct symbol {
  struct table_entry entry;
  struct symbol *older; /* local before it */
  const char *name;
  size_t length;
  int depth; /* 0: belongs to all; otherwise the include depth of its #local */
  enum symbol_kind kind;
  struct value value;
  const struct texture *texture;
  const struct node *object;
};
bool symbols_create(struct language *language); /* with `pscn` declared */
/* What a name stands for, or NULL: where it is not declared, or its declaration has only begun. */
const struct symbol *symbol_find(const struct language *language, const char *name, size_t length);
/* Whether #ifdef takes it for declared: from the = of its declaration on, as in POV-Ray. */
bool symbol_known(const struct language *language, const char *name, size_t length);
void symbols_leave(struct language *language, int depth); /* forgets the locals of that include depth */
/* Offers all declared names to a search for the nearest (words.h). */
void symbols_consider(const struct language *language, const char *word, size_t length, const char **best,
                      size_t *best_length, size_t *distance);
/* Tells that a name is unknown, with a guess; `wanted` says what was. */
void symbol_unknown(struct language *language, struct place place, const struct token *name, const char *wanted);
/* Tells that a name is something else than what is wanted. */
void symbol_mistaken(struct language *language, struct place place, const struct symbol *symbol, const char *wanted);
/* The symbol that a declaration writes to; declarations may stand within each other. */
struct symbol *declare_begin(struct language *language, const struct token *name, bool local);
void declare_value(struct symbol *symbol, const struct value *value);
void declare_object(struct language *language, struct symbol *symbol, struct node *object);
void declare_texture(struct language *language, struct symbol *symbol, const struct texture *texture);
void declare_broken(struct symbol *symbol); /* its declaration has an error */

/* ---- settings.c: global_settings, background, light sources ---- */
void language_version(struct language *language, struct place place, const struct value *value);
void global_gamma(struct language *language, struct place place, const struct value *value);
void global_trace_level(struct language *language, struct place place, const struct value *value);
void global_solver(struct language *language);
void background_begin(struct language *language, struct place place);
void background_value(struct language *language, struct place place, const struct value *value);
void background_end(struct language *language);
void light_begin(struct language *language, struct place place);
void light_value(struct language *language, struct place place, const struct value *value);
void light_comma(struct language *language, struct place place);
void light_shadowless(struct language *language, struct place place);
void light_transform(struct language *language, struct place place);
void light_end(struct language *language);

/* ---- camera.c ---- */
enum { CAMERA_LOCATION, CAMERA_DIRECTION, CAMERA_RIGHT, CAMERA_UP, CAMERA_SKY, CAMERA_LOOK_AT };
void camera_default(struct camera_items *out);
void camera_begin(struct language *language, struct place place);
void camera_perspective(struct language *language, struct place place);
void camera_vector(struct language *language, int which, struct place place, const struct value *value);
void camera_angle(struct language *language, struct place place, const struct value *value);
void camera_transform(struct language *language, struct place place);
void camera_end(struct language *language);
/* Folds the items into `out`; false, and an error told, where they make no picture. */
bool camera_fold(struct language *language, const struct camera_items *items, struct scene_camera *out);

/* ---- objects.c ---- */
enum { PATCH_TYPE, PATCH_FLATNESS, PATCH_U_STEPS, PATCH_V_STEPS };
void patch_begin(struct language *language, struct place place);
void patch_number(struct language *language, int which, struct place item, struct place place,
                  const struct value *value);
void patch_point(struct language *language, struct place place, const struct value *value);
void patch_comma(struct language *language, struct place place);
void patch_modified(struct language *language);
void patch_solver(struct language *language);
void patch_end(struct language *language);
void union_begin(struct language *language, struct place place);
void union_add(struct language *language, struct place place, struct node *object);
void union_modified(struct language *language);
void copy_begin(struct language *language, struct place place);
void copy_named(struct language *language, struct place place, const struct token *name);
void copy_object(struct language *language, struct place place, const struct node *object);
void copy_modified(struct language *language, struct place place);
void copy_end(struct language *language);
struct node *node_end(struct language *language);
void node_transform(struct language *language, struct place place);
void node_texture(struct language *language, const struct texture *texture);
void scene_add(struct language *language, struct place place, struct node *object);

/* ---- expand.c ---- */
/* Puts all patches of language->scene, with their textures and solvers, into the scene. */
enum status objects_expand(struct language *language, struct scene *scene) STATUS_MUST_CHECK;

/* ---- transforms.c: each statement sets language->transform ---- */
void transform_translate(struct language *language, struct place place, const struct value *value);
void transform_rotate(struct language *language, struct place place, const struct value *value);
void transform_scale(struct language *language, struct place place, const struct value *value);
void matrix_begin(struct language *language);
void matrix_add(struct language *language, struct place place, const struct value *value);
void matrix_end(struct language *language, struct place place);
void matrix_short(struct language *language, struct place place); /* a matrix of three numbers */
struct transform transform_identity(void);
/* first, then second. */
struct transform transform_then(const struct transform *first, const struct transform *second);
bool transform_finite(const struct transform *transform);
void transform_point(const struct transform *transform, const double p[3], double out[3]); /* out may be p */

/* ---- textures.c ---- */
enum { FINISH_DIFFUSE, FINISH_BRILLIANCE, FINISH_PHONG, FINISH_PHONG_SIZE, FINISH_SPECULAR, FINISH_ROUGHNESS };
struct texture texture_default(void);
void texture_begin(struct language *language, unsigned block);
struct texture *texture_end(struct language *language);
void texture_named(struct language *language, struct place place, const struct token *name);
void texture_merge(struct language *language, const struct texture *texture);
void texture_moved(struct language *language); /* a transform, which changes nothing of one colour */
/* What is set in `from` replaces what is in `to`. */
void texture_apply(struct texture *to, const struct texture *from);
void pigment_value(struct language *language, struct place place, const struct value *value);
void finish_ambient(struct language *language, struct place place, const struct value *value);
void finish_number(struct language *language, int which, struct place place, const struct value *value);

/* ---- solver_statement.c ---- */
void solver_begin(struct language *language, struct place place, const struct token *name);
void solver_misplaced(struct language *language, struct place place);
void solver_quantity(struct language *language, struct place place, const struct token *item, struct place value_place,
                     const struct value *value);
/* A word of the item's, or else the name of a number. */
void solver_word(struct language *language, struct place place, const struct token *item, struct place value_place,
                 const struct token *value);

#endif
