/* Patches, unions and copies of declared objects: a tree. */
#ifndef PSCN_LANGUAGE_OBJECTS_H
#define PSCN_LANGUAGE_OBJECTS_H

#include <stdint.h>

#include "language/language.h"
#include "language/textures.h"
#include "language/values.h"
#include "scene/method.h"
#include "scene/scene.h"

/* The settings of a patch, by number. */
enum { PATCH_TYPE, PATCH_FLATNESS, PATCH_U_STEPS, PATCH_V_STEPS, PATCH_SETTINGS };

/* The part that all copies of a declared object share. */
struct sharing {
  size_t uses;      /* how often it is named */
  uint32_t object;  /* its index in scene.objects plus 1, once it is there */
  struct name name; /* where it is first used */
  const char *kept; /* the name's text in the scene, once it is there */
};

/* The numbers of one patch, shared by its copies. */
struct net {
  double P[4][4][3];
  double setting[PATCH_SETTINGS];
};

/* A patch or a union, with its modifiers. Declared ones are shared: a copy has a node of its own, but the same net or
 * children. Scenes have millions of them. */
struct node {
  struct node *next, *first;     /* the next of its list; its own children */
  struct net *net;               /* NULL: a union */
  struct transform *transform;   /* NULL: none */
  const struct texture *texture; /* NULL: none of its own */
  const struct method *method;   /* NULL: none of its own */
  struct sharing *sharing;       /* of the declared object that it is or is a copy of; NULL: neither */
  size_t patch_count;            /* in it and below */
  struct span place;             /* of its first word */
  int height;                    /* unions nested below it */
};

/* A node whose block is open. */
struct open_node {
  struct open_node *outer;
  struct node node;  /* the node being made */
  struct node *last; /* of its children */
  struct block block;
  enum stage stage;
  int points;
  bool has_type, has_object, own_transform;
};

/* Zeroed: no objects. */
struct objects {
  struct open_node *open;   /* the innermost */
  struct open_node *closed; /* to be reused */
  struct span whole;        /* of the last that was closed */
  struct open_node scene;   /* the union of all objects */
  size_t copies;            /* how often declared objects are named */
};

/* Actions of the grammar, in the order of the text. What begins is open until its end, followed by node_end; the
 * actions between concern the innermost open node. `place`: that of the word or of the name. */
struct open_node *node_begin(struct language *language, struct span place); /* a union or a copy */
void patch_begin(struct language *language, struct span place);
void patch_number(struct language *language, int which, struct span item, const struct value *value);
void patch_point(struct language *language, const struct value *value);
void patch_modified(struct language *language);
void patch_solver(struct language *language);
void patch_end(struct language *language);
void union_add(struct language *language, struct node *object);
void union_modified(struct language *language);
void copy_named(struct language *language, const struct value *value);
void copy_object(struct language *language, const struct node *object);
void copy_modified(struct language *language, struct span place);
void copy_end(struct language *language);
struct node *node_end(struct language *language, struct span brace);
void node_transform(struct language *language, const struct transform *transform);
void node_texture(struct language *language, struct texture *texture); /* keeps it */
struct value *value_of_object(struct language *language, struct node *object);
/* A shape, which is not supported: an object without patches. Passes its block. */
struct node *shape_pass(struct language *language, struct span place);
void scene_add(struct language *language, struct node *object);

/* Puts all patches of language->objects, with their textures and solvers, into the scene. `method` becomes the scene's
 * first. `parts`, if not NULL, becomes the list of the outermost objects. Ends with STATUS_INPUT after reporting that a
 * point is too large. */
void objects_expand(struct language *language, const struct method *method, struct scene *scene,
                    struct language_parts *parts);

#endif
