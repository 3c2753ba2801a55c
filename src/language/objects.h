/* Patches, unions and copies of declared objects: a tree. */
#ifndef PSCN_LANGUAGE_OBJECTS_H
#define PSCN_LANGUAGE_OBJECTS_H

#include <stdint.h>

#include "language/textures.h"
#include "language/transforms.h"
#include "scene/method.h"

/* The settings of a patch, by number. */
enum { PATCH_TYPE, PATCH_FLATNESS, PATCH_U_STEPS, PATCH_V_STEPS, PATCH_SETTINGS };

/* What the copies of a declared object know of each other. */
struct sharing {
  size_t uses;     /* how often it is named */
  uint32_t object; /* one more than its index in scene.objects, once it is there */
};

/* What a patch says itself, shared by its copies. */
struct net {
  double P[4][4][3];
  double setting[PATCH_SETTINGS];
};

/* A patch or a union, with what was said of it. Declared ones are shared: a copy has a node of its own, but the same
 * net or children. Scenes have millions of them. */
struct node {
  struct node *next, *first;     /* the list it stands in; its own children */
  struct net *net;               /* NULL: a union */
  struct transform *transform;   /* NULL: none */
  const struct texture *texture; /* NULL: none of its own */
  const struct method *method;   /* NULL: none of its own */
  struct sharing *sharing;       /* of the declared object that it is or copies; NULL: neither */
  size_t patch_count;            /* in it and below */
  struct span place;             /* of the word it begins with */
  int height;                    /* unions below it within each other */
};

/* One whose block is open. */
struct open_node {
  struct open_node *outer;
  struct node node;  /* what it is to be */
  struct node *last; /* of its children */
  struct block block;
  enum stage stage;
  int points;
  bool has_type, has_object, after_comma, own_transform;
};

/* Zeroed: no objects. */
struct objects {
  struct open_node *open;   /* the innermost */
  struct open_node *closed; /* for the next ones */
  struct span whole;        /* of the last that was closed */
  struct open_node scene;   /* the union of all objects */
  size_t copies;            /* how often declared ones are named */
};

/* Actions of the grammar, in the order of the text: what begins is open until its end, which node_end follows, and what is
 * said in between is of the innermost that is open. `place`: of the word, of the name or of the comma. */
void patch_begin(struct language *language, struct span place);
void patch_number(struct language *language, int which, struct span item, const struct value *value);
void patch_point(struct language *language, const struct value *value);
void patch_comma(struct language *language, struct span place);
void patch_modified(struct language *language);
void patch_solver(struct language *language);
void patch_end(struct language *language);
void union_begin(struct language *language, struct span place);
void union_add(struct language *language, struct node *object);
void union_modified(struct language *language);
void copy_begin(struct language *language, struct span place);
void copy_named(struct language *language, struct span name);
void copy_object(struct language *language, const struct node *object);
void copy_modified(struct language *language, struct span place);
void copy_end(struct language *language);
struct node *node_end(struct language *language, struct span brace);
void node_transform(struct language *language, const struct transform *transform);
void node_texture(struct language *language, struct texture *texture); /* keeps it */
void declare_object(struct language *language, struct declaration *declaration, struct node *object);
void scene_add(struct language *language, struct node *object);

#endif
