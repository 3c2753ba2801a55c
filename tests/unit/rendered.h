/* A small scene, and pictures of it. Each test that includes this header has its own copy. */
#ifndef TESTS_UNIT_RENDERED_H
#define TESTS_UNIT_RENDERED_H

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "cmocka_test.h"
#include "render/render.h"

enum { WIDTH = 70, HEIGHT = 45 }; /* several tiles; those at the right and lower edges are cut off */

static struct scene_texture texture = {
  .pigment = {0.8, 0.5, 0.3},
  .finish = {.ambient = {0.1, 0.2, 0.3}, .diffuse = 0.6, .brilliance = 1, .phong_size = 40, .roughness = 0.05}};
static struct method solver;
static struct scene_patch patches[2];
static struct scene_light lights[2];

/* The square |x|, |y| <= half at depth z; bulge pulls its inner control points towards the camera. */
static inline struct scene_patch square(double half, double z, double bulge)
{
  struct scene_patch patch = {0};
  for (int i = 0; i < 4; i++) {
    for (int j = 0; j < 4; j++) {
      const bool inner = (i == 1 || i == 2) && (j == 1 || j == 2);
      const double point[3] = {half * (2 * j / 3.0 - 1), half * (2 * i / 3.0 - 1), inner ? z - bulge : z};
      memcpy(patch.P[i][j], point, sizeof point);
    }
  }
  return patch;
}

/* A bulging square in front of a flat one that does not fill the picture, seen along z. Tests change it as they
 * need. */
static inline struct scene scene_of(void)
{
  method_default(solver_at(0), &solver);
  patches[0] = square(1, 0, 1.5);
  patches[1] = square(3, 2, 0);
  lights[0] = (struct scene_light){.position = {2, 4, -6}, .color = {1, 0.9, 0.8}};
  lights[1] = (struct scene_light){.position = {-5, 1, -6}, .color = {0.2, 0.2, 0.4}, .shadowless = true};
  const struct scene_camera camera = {
    .location = {0, 0, -5}, .direction = {0, 0, 1}, .right = {1.4, 0, 0}, .up = {0, 0.9, 0}};
  return (struct scene){.gamma = 1,
                        .camera = camera,
                        .background = {0.1, 0.2, 0.4},
                        .ambient_light = {1, 0.5, 2},
                        .lights = lights,
                        .light_count = 2,
                        .patches = patches,
                        .patch_count = 2,
                        .textures = &texture,
                        .texture_count = 1,
                        .solvers = &solver,
                        .solver_count = 1};
}

static inline struct render_options options_of(const char *channels)
{
  struct render_options options = {
    .width = WIDTH, .height = HEIGHT, .samples = 1, .threads = 1, .crop = {.width = WIDTH, .height = HEIGHT}};
  const char *bad;
  size_t length;
  assert_true(channel_list_parse(channels, &options.channels, &bad, &length));
  return options;
}

/* The values of a picture; the caller frees them. */
static inline float *render(const struct scene *scene, const struct render_options *options,
                            struct render_stats *out_stats)
{
  const size_t values = options->crop.width * options->crop.height * options->channels.width;
  float *out = malloc(values * sizeof *out);
  assert_non_null(out);
  for (size_t k = 0; k < values; k++) out[k] = NAN;
  struct intersector *intersector;
  assert_int_equal(intersector_create(scene, &intersector), STATUS_OK);
  const struct render_watch watch = {0};
  assert_int_equal(render_scene(scene, intersector, options, &watch, out, out_stats), STATUS_OK);
  intersector_destroy(intersector);
  return out;
}

/* Where the ray of pixel (x, y) meets the plane z = 2 of the flat square. */
static inline void point_on_wall(size_t x, size_t y, double out[3])
{
  out[0] = 7 * (((double)x + 0.5) / WIDTH - 0.5) * 1.4;
  out[1] = 7 * (0.5 - ((double)y + 0.5) / HEIGHT) * 0.9;
  out[2] = 2;
}

/* Whether the value is the float of a number computed in another order, within one unit in the last place, or of 1. */
static inline bool is_float(float value, double expected)
{
  return (double)value == expected || fabs((double)value - expected) <= 0x1p-23 * (1 + fabs(expected));
}

#endif
