/* Folds the camera's items into location, direction, right and up as POV-Ray 3.7 does, wherever they stand: the angle
 * sets the length of direction from that of right; look_at takes effect after all vectors and turns the frame, keeping
 * lengths and handedness; the transforms come last. */
#include "language/settings.h"

#include <math.h>
#include <string.h>

#include "base/number.h"
#include "geometry/vector.h"

#define RADIANS_A_DEGREE (3.14159265358979323846 / 180)

/* A limit for unit vectors: below it, they are in a line or in a plane, as far as their own rounding lets one tell. */
#define FLAT 0x1p-45

/* From this version on, POV-Ray sorts the items. In older ones, each acts where it stands, which matters for look_at. */
#define VERSION_SORTED 3.5

/* POV-Ray's absolute limit, in the units of `sky`: how far its tip may be from the line of sight for it to lie along
 * that. */
#define ALONG_SKY 1e-10

void camera_default(struct camera_items *out)
{
  static const double item[5][3] = {{0, 0, 0}, {0, 0, 1}, {1.33, 0, 0}, {0, 1, 0}, {0, 1, 0}};
  *out = (struct camera_items){.transform = transform_identity(), .folded = {{0}, {0, 0, 1}, {1.33, 0, 0}, {0, 1, 0}}};
  memcpy(out->item, item, sizeof item);
}

void camera_begin(struct language *language, struct span place)
{
  struct camera_items *camera = language->camera;
  if (camera->said) language_error(language, place, "the scene has a camera already");
  camera_default(camera);
  camera->said = true;
  camera->block = language_block(language, place);
}

void camera_vector(struct language *language, int which, const struct value *value)
{
  struct camera_items *camera = language->camera;
  value_to_vector(language, value, camera->item[which]);
  camera->unknown |= value->kind == VALUE_UNKNOWN;
  if (camera->look_at && language->settings->version < VERSION_SORTED)
    language_error(language, value->place, "before version 3.5, look_at must be the camera's last vector");
  if (which != CAMERA_LOOK_AT) return;
  camera->look_at = true;
  camera->look_at_place = value->place;
}

void camera_angle(struct language *language, const struct value *value)
{
  double angle;
  struct camera_items *camera = language->camera;
  if (!value_to_number(language, value, &angle)) return;
  if (angle >= 0 && angle < 180) camera->angle = angle;
  else language_error(language, value->place, "the angle must be at least 0 and less than 180 degrees");
}

void camera_transform(struct language *language, const struct transform *transform)
{
  struct camera_items *camera = language->camera;
  camera->transform = transform_then(&camera->transform, transform);
}

/* Returns the length of v, and writes v scaled to length 1. For a zero vector, returns 0 and writes nothing. */
static double unit(const double v[3], double out[3])
{
  const double length = vector_length(v);
  if (length > 0) vector_scale(1 / length, v, out);
  return length;
}

/* A camera while it is folded: unit vectors, and the lengths they had. */
struct camera_frame {
  double direction[3], right[3], up[3];
  double direction_length, right_length, up_length;
};

/* Whether the camera looks along the sky, of that length, so that the direction across both means nothing. This is
 * POV-Ray's criterion, without which the picture would be turned about its middle. */
static bool along_sky(const double across[3], double sky_length)
{
  const double largest = fmax(fabs(across[0]), fmax(fabs(across[1]), fabs(across[2])));
  return largest * sky_length < ALONG_SKY;
}

/* Turns the frame towards look_at. If that is along the sky, right stays where it is. */
static bool turn_frame(struct language *language, const struct camera_items *items, struct camera_frame *frame)
{
  double across[3], sky[3], ahead[3], hand[3];
  for (int k = 0; k < 3; k++) /* halves, because the difference may overflow */
    ahead[k] = items->item[CAMERA_LOOK_AT][k] / 2 - items->item[CAMERA_LOCATION][k] / 2;
  if (!(unit(ahead, ahead) > 0)) {
    language_error(language, items->look_at_place, "the camera looks at its own location");
    return false;
  }
  vector_cross(frame->direction, frame->up, hand);
  const double sign = vector_dot(hand, frame->right) < 0 ? 1 : -1;
  const double sky_length = unit(items->item[CAMERA_SKY], sky);
  if (!(sky_length > 0)) {
    language_error(language, items->block.place, "the camera's sky must not be zero");
    return false;
  }
  vector_cross(sky, ahead, across);
  const bool along = along_sky(across, sky_length);
  if (along) memcpy(across, frame->right, sizeof across);
  else unit(across, across);
  memcpy(frame->direction, ahead, sizeof ahead);
  vector_cross(ahead, across, frame->up);
  vector_scale(sign, across, frame->right);
  const double height = unit(frame->up, frame->up);
  if (along) frame->up_length *= height; /* right may lean towards the direction, which shortens POV-Ray's up */
  if (height > 0) return true;
  language_error(language, items->look_at_place, "the camera looks along its sky and its right");
  return false;
}

/* Makes a frame of the vectors. False, after an error, if one is zero. */
static bool make_frame(struct language *language, struct span place, const double direction[3], const double right[3],
                       const double up[3], struct camera_frame *out)
{
  out->direction_length = unit(direction, out->direction);
  out->right_length = unit(right, out->right);
  out->up_length = unit(up, out->up);
  if (out->direction_length > 0 && out->right_length > 0 && out->up_length > 0) return true;
  language_error(language, place, "the camera's direction, right and up must not be zero");
  return false;
}

/* Whether the frame spans space. If not, this is reported. */
static bool spans(struct language *language, struct span place, const struct camera_frame *frame)
{
  double cross[3];
  vector_cross(frame->right, frame->up, cross);
  if (fabs(vector_dot(cross, frame->direction)) > FLAT) return true;
  language_error(language, place, "the camera's direction, right and up lie in one plane");
  return false;
}

static bool fold_frame(struct language *language, const struct camera_items *items, struct camera_frame *frame)
{
  const struct span place = items->block.place;
  if (!make_frame(language, place, items->item[CAMERA_DIRECTION], items->item[CAMERA_RIGHT], items->item[CAMERA_UP],
                  frame))
    return false;
  if (items->angle > 0)
    frame->direction_length = 0.5 * frame->right_length / tan(0.5 * items->angle * RADIANS_A_DEGREE);
  if (items->look_at && !turn_frame(language, items, frame)) return false;
  return spans(language, place, frame);
}

/* Returns false, after reporting an error, if the items make no picture. */
static bool fold(struct language *language, const struct camera_items *items, struct scene_camera *out)
{
  struct camera_frame frame;
  if (!fold_frame(language, items, &frame)) return false;
  /* What has not changed stays the same to the bit. */
  memcpy(out->location, items->item[CAMERA_LOCATION], sizeof out->location);
  memcpy(out->direction, items->item[CAMERA_DIRECTION], sizeof out->direction);
  memcpy(out->right, items->item[CAMERA_RIGHT], sizeof out->right);
  memcpy(out->up, items->item[CAMERA_UP], sizeof out->up);
  if (items->look_at || items->angle > 0) vector_scale(frame.direction_length, frame.direction, out->direction);
  if (items->look_at) {
    vector_scale(frame.right_length, frame.right, out->right);
    vector_scale(frame.up_length, frame.up, out->up);
  }
  transform_point(&items->transform, out->location, out->location);
  transform_direction(&items->transform, out->direction, out->direction);
  transform_direction(&items->transform, out->right, out->right);
  transform_direction(&items->transform, out->up, out->up);
  double *const vectors[] = {out->location, out->direction, out->right, out->up};
  bool in_range = true;
  for (int k = 0; k < 12; k++) in_range &= number_in_range(&vectors[k / 3][k % 3]);
  if (!in_range) {
    language_error(language, items->block.place, "the camera's vectors are larger than 1e100");
    return false;
  }
  /* Numbers may have become 0, and a transform may have left only what all three vectors share. */
  return make_frame(language, items->block.place, out->direction, out->right, out->up, &frame) &&
         spans(language, items->block.place, &frame);
}

void camera_end(struct language *language)
{
  struct camera_items *camera = language->camera;
  if (!camera->unknown && language_sound(language, &camera->block)) (void)fold(language, camera, &camera->folded);
}
