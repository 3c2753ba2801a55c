/* global_settings, camera, light sources, background.
 *
 * The camera's items combine as in POV-Ray 3.7: the angle sets the length of direction from that of right; look_at, whatever
 * stands where, comes last and turns the frame, keeping the lengths and the handedness.
 */
#include <math.h>
#include <string.h>

#include "geometry/vector.h"
#include "language/build.h"

/* The version of POV-Ray's language that a scene may ask for. */
#define VERSION_LOW 3.0
#define VERSION_HIGH 3.8

void language_version(struct language *language, struct place place, const struct value *value)
{
  value_in_range(language, place, value, "the version", VERSION_LOW, VERSION_HIGH, false);
}

void global_gamma(struct language *language, struct place place, const struct value *value)
{
  const double gamma = value_to_number(language, place, value);
  if (value->kind == VALUE_NUMBER && gamma != 1)
    language_error(language, place, "assumed_gamma must be 1: colours are linear");
}

void global_trace_level(struct language *language, struct place place, const struct value *value)
{
  value_in_range(language, place, value, "max_trace_level", 1, 256, true);
}

void global_ambient(struct language *language, struct place place, const struct value *value)
{
  (void)place;
  value_to_vector(value, language->ambient_light);
}

void global_solver(struct language *language) { language->global_solver = language->solver; }

void camera_default(struct camera_items *out)
{
  *out = (struct camera_items){.angle = NAN};
  static const double item[5][3] = {{0, 0, 0}, {0, 0, 1}, {1.33, 0, 0}, {0, 1, 0}, {0, 1, 0}};
  memcpy(out->item, item, sizeof item);
}

void camera_begin(struct language *language, struct place place)
{
  if (language->has_camera) language_error(language, place, "a scene has one camera");
  language->has_camera = true;
  camera_default(&language->camera);
  language->camera.errors_before = language->diagnostics->error_count;
}

void camera_vector(struct language *language, int which, struct place place, const struct value *value)
{
  value_to_vector(value, language->camera.item[which]);
  if (which == CAMERA_LOOK_AT) language->camera.look_at = true, language->camera.look_at_place = place;
}

void camera_angle(struct language *language, struct place place, const struct value *value)
{
  const double angle = value_to_number(language, place, value);
  if (!(angle > 0 && angle < 180)) language_error(language, place, "a perspective camera's angle is between 0 and 180 degrees");
  else language->camera.angle = angle;
}

void camera_end(struct language *language, struct place place)
{
  language->camera.place = place;
  struct scene_camera unused;
  /* What an item that was not understood leaves behind is no error of its own. */
  if (language->diagnostics->error_count == language->camera.errors_before) camera_fold(language, &language->camera, &unused);
}

/* Relative to the lengths, below this the frame's vectors lie in a plane to within their own rounding. */
#define FRAME_FLAT 0x1p-45

bool camera_fold(struct language *language, const struct camera_items *items, struct scene_camera *out)
{
  memcpy(out->location, items->item[CAMERA_LOCATION], sizeof out->location);
  memcpy(out->direction, items->item[CAMERA_DIRECTION], sizeof out->direction);
  memcpy(out->right, items->item[CAMERA_RIGHT], sizeof out->right);
  memcpy(out->up, items->item[CAMERA_UP], sizeof out->up);
  const double right = vector_length(out->right), up = vector_length(out->up);
  double direction = vector_length(out->direction), cross[3];
  if (!(right > 0 && up > 0 && direction > 0)) {
    language_error(language, items->place, "the camera's direction, right and up must not be zero");
    return false;
  }
  if (!isnan(items->angle)) {
    const double wanted = 0.5 * right / tan(items->angle * (3.14159265358979323846 / 360));
    vector_scale(wanted / direction, out->direction, out->direction);
    direction = wanted;
  }
  if (items->look_at) {
    vector_cross(out->up, out->direction, cross);
    const double hand = vector_dot(cross, out->right) < 0 ? -right : right;
    double ahead[3], side[3], above[3];
    vector_subtract(items->item[CAMERA_LOOK_AT], out->location, ahead);
    const double distance = vector_length(ahead);
    if (!(distance > 0)) {
      language_error(language, items->look_at_place, "look_at is the camera's own location");
      return false;
    }
    vector_scale(1 / distance, ahead, ahead);
    vector_cross(items->item[CAMERA_SKY], ahead, side);
    const double sky = vector_length(items->item[CAMERA_SKY]), across = vector_length(side);
    if (!(across > FRAME_FLAT * sky)) {
      language_error(language, items->look_at_place, "the camera looks along its sky vector: give another sky");
      return false;
    }
    vector_scale(1 / across, side, side);
    vector_cross(ahead, side, above);
    vector_scale(direction, ahead, out->direction);
    vector_scale(hand, side, out->right);
    vector_scale(up, above, out->up);
  }
  vector_cross(out->right, out->up, cross);
  if (!(fabs(vector_dot(cross, out->direction)) > FRAME_FLAT * right * up * direction)) {
    language_error(language, items->place, "the camera's direction, right and up lie in one plane");
    return false;
  }
  return true;
}

void light_begin(struct language *language, struct place place, const struct value *at, struct place color_place,
                 const struct value *color)
{
  (void)place, (void)color_place;
  struct light_node *light = language_alloc(language, sizeof *light);
  value_to_vector(at, light->light.position);
  value_to_vector(color, light->light.color);
  light->transform = transform_identity();
  *language->lights_end = light;
  language->lights_end = &light->next;
  language->light = light;
}

void light_shadowless(struct language *language) { language->light->light.shadowless = true; }

void light_transform(struct language *language, struct place place, const struct transform *transform)
{
  (void)place;
  struct light_node *light = language->light;
  light->transform = transform_then(&light->transform, transform);
}

void background_set(struct language *language, struct place place, const struct value *value)
{
  (void)place;
  value_to_vector(value, language->background);
}
