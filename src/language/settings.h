/* global_settings, background, light sources, the solver statement and the camera. */
#ifndef PSCN_LANGUAGE_SETTINGS_H
#define PSCN_LANGUAGE_SETTINGS_H

#include "language/values.h"
#include "scene/method.h"
#include "scene/scene.h"

struct light_node {
  struct light_node *next;
  struct scene_light light;
  struct transform transform;
  struct block block;
  int values; /* how many have come: position, colour */
  bool modified;
};

/* The statements so far. */
struct settings {
  double background[3], ambient_light[3];
  double version, gamma;                           /* the last #version, the first assumed_gamma */
  bool version_said, gamma_said;                   /* they were given */
  struct method method;                            /* of all patches without one of their own */
  struct block block;                              /* of the open background */
  int background_values;                           /* colours in it */
  struct light_node *lights, **lights_end, *light; /* the last one, and the one open */
  size_t light_count;
};

void settings_default(struct settings *out);
/* Actions of the grammar, in the order of the text. Between a begin and its end they concern that block. */
void language_version(struct language *language, const struct value *value);
void global_gamma(struct language *language, struct span place,
                  const struct value *value); /* NULL: the word at `place` */
/* At the end, the space of the scene's colours. */
double settings_gamma(const struct settings *settings);
void global_ambient(struct language *language, const struct value *value);
void global_solver(struct language *language);
void background_begin(struct language *language, struct span place);
void background_value(struct language *language, const struct value *value);
void background_end(struct language *language);
void light_begin(struct language *language, struct span place);
void light_value(struct language *language, const struct value *value);
void light_shadowless(struct language *language, struct span place);
void light_transform(struct language *language, const struct transform *transform);
void light_end(struct language *language);

/* ---- the solver statement ---- */

/* Actions of the grammar: the name, which sets the method's defaults, then each item. `place`: that of the word. */
void solver_begin(struct language *language, struct span name);
void solver_misplaced(struct language *language, struct span place);
/* The item that the word names, in capitals or not; NULL if there is none. */
const struct method_item *solver_item_find(const struct name *word);
void solver_quantity(struct language *language, struct span item, const struct value *value);
/* A keyword of the item, or else the name of a number. */
void solver_word(struct language *language, struct span item, struct span value);

/* ---- the camera: its items, and how they fold into location, direction, right and up ---- */

enum { CAMERA_LOCATION, CAMERA_DIRECTION, CAMERA_RIGHT, CAMERA_UP, CAMERA_SKY, CAMERA_LOOK_AT };

struct camera_items {
  double item[6][3];
  bool said;    /* there is a camera statement */
  bool unknown; /* a vector is, because of an earlier error */
  bool look_at;
  double angle;               /* degrees; 0: not given */
  struct transform transform; /* applied to what all other items make */
  struct block block;
  struct span look_at_place;
  struct scene_camera folded; /* what they make */
};

void camera_default(struct camera_items *out);
/* Actions of the grammar, in the order of the text. `place`: that of the word. */
void camera_begin(struct language *language, struct span place);
void camera_vector(struct language *language, int which, const struct value *value);
void camera_angle(struct language *language, const struct value *value);
void camera_transform(struct language *language, const struct transform *transform);
void camera_end(struct language *language);

#endif
