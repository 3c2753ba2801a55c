/* The camera's items, and how they fold into location, direction, right and up. */
#ifndef PSCN_LANGUAGE_CAMERA_H
#define PSCN_LANGUAGE_CAMERA_H

#include "language/transforms.h"
#include "language/values.h"
#include "scene/scene.h"

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
