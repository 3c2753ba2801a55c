/* Shading: colours by the formulas, and shadows. */
#include <float.h>

#include "base/srgb.h"
#include "geometry/vector.h"
#include "render/shade.h"
#include "scene/scene.h"
#include "unit/rendered.h"

/* Pixel n of a picture of "rgb,patch" and the point of the wall, patch 1, that it shows; NULL if it shows something
 * else. */
static const float *wall_pixel(const float *picture, size_t n, double out_point[3])
{
  point_on_wall(n % WIDTH, n / WIDTH, out_point);
  return picture[4 * n + 3] == 1 ? picture + 4 * n : NULL;
}

/* The colour of a point of the flat square, seen by the camera of scene_of, from the formulas of shade.h. */
static void expected_colour(const double point[3], const struct scene *scene, double out[3])
{
  const double normal[3] = {0, 0, -1};
  const struct scene_finish *finish = &texture.finish;
  double toward[3];
  vector_subtract(point, scene->camera.location, toward);
  vector_scale(1 / vector_length(toward), toward, toward);
  for (int c = 0; c < 3; c++) out[c] = finish->ambient[c] * scene->ambient_light[c] * texture.pigment[c];
  for (size_t k = 0; k < scene->light_count; k++) {
    const struct scene_light *light = &scene->lights[k];
    double to_light[3], half[3], reflected[3];
    vector_subtract(light->position, point, to_light);
    vector_scale(1 / vector_length(to_light), to_light, to_light);
    const double cosine = vector_dot(to_light, normal);
    if (cosine <= 0) continue;
    vector_add_scaled(toward, -2 * vector_dot(toward, normal), normal, reflected);
    vector_subtract(to_light, toward, half);
    const double mirror = fmax(0, vector_dot(reflected, to_light));
    const double blinn = vector_dot(half, normal) / vector_length(half);
    const double highlight = light->shadowless ? 0
                                               : finish->phong * pow(mirror, finish->phong_size) +
                                                   finish->specular * pow(blinn, 1 / finish->roughness);
    for (int c = 0; c < 3; c++)
      out[c] += light->color[c] * (finish->diffuse * pow(cosine, finish->brilliance) * texture.pigment[c] + highlight);
  }
}

TEST(colours_follow_the_formulas)
{
  struct scene scene = scene_of();
  const struct scene_texture saved = texture;
  patches[1] = square(9, 2, 0); /* fills the picture */
  scene.patches = &patches[1];
  scene.patch_count = 1;
  const struct scene_finish finishes[] = {
    saved.finish,
    {.diffuse = 0.7, .brilliance = 3, .phong_size = 40, .roughness = 0.05},
    {.phong = 0.8, .phong_size = 12, .brilliance = 1, .roughness = 0.05},
    {.specular = 0.9, .roughness = 0.02, .brilliance = 1, .phong_size = 40},
    {.ambient = {0.1, 0, 0.3},
     .diffuse = 0.4,
     .brilliance = 0.5,
     .phong = 0.3,
     .phong_size = 5,
     .specular = 0.3,
     .roughness = 0.1},
  };
  const struct render_options options = options_of("rgb");
  for (size_t k = 0; k < 2 * sizeof finishes / sizeof finishes[0]; k++) {
    const size_t f = k / 2;
    texture.finish = finishes[f];
    lights[0].position[2] = k % 2 == 0 ? -6 : 1; /* high above, and grazing: the mirrored ray may lead away from it */
    lights[1].position[2] = f == 3 ? 3 : -6;     /* behind the surface it adds nothing */
    struct render_stats stats;
    float *out = render(&scene, &options, &stats);
    for (size_t y = 0; y < HEIGHT; y++) {
      for (size_t x = 0; x < WIDTH; x++) {
        double point[3], expected[3];
        point_on_wall(x, y, point);
        expected_colour(point, &scene, expected);
        for (int c = 0; c < 3; c++) assert_true(is_float(out[(y * WIDTH + x) * 3 + (size_t)c], expected[c]));
      }
    }
    free(out);
  }
  texture = saved;
}

/* Light is added up in the scene's space, and then becomes linear. */
TEST(light_is_added_in_its_space)
{
  struct scene scene = scene_of();
  const struct render_options options = options_of("rgb");
  const double gammas[] = {2, GAMMA_SRGB, 0.001, 30};
  struct render_stats stats;
  float *parts = render(&scene, &options, &stats);
  for (size_t g = 0; g < sizeof gammas / sizeof *gammas; g++) {
    scene.gamma = gammas[g];
    float *out = render(&scene, &options, &stats);
    for (size_t n = 0; n < WIDTH * HEIGHT * 3; n++) {
      const double part = (double)parts[n], light = gammas[g] == GAMMA_SRGB ? srgb_decode(part) : pow(part, gammas[g]);
      assert_true(isfinite(out[n]) && fabs((double)out[n] - light) <= 1e-6 * fmax(1, gammas[g]) * light);
    }
    free(out);
  }
  free(parts);
  assert_true(gamma_to_light(2, -3) == -9 && gamma_to_light(30, 1e30) == (double)FLT_MAX);
}

/* A negative diffuse part does not reduce the ambient colour. */
TEST(nothing_darkens)
{
  struct scene scene = scene_of();
  const struct scene_texture saved = texture;
  scene.patches = &patches[1];
  scene.patch_count = 1;
  texture.finish.diffuse = -1, texture.finish.phong = -1, texture.finish.specular = -1;
  const struct render_options options = options_of("rgb,patch");
  struct render_stats stats;
  float *out = render(&scene, &options, &stats);
  for (size_t n = 0; n < WIDTH * HEIGHT; n++)
    for (int c = 0; c < 3 && out[4 * n + 3] == 0; c++)
      assert_true(
        is_float(out[4 * n + (size_t)c], texture.finish.ambient[c] * scene.ambient_light[c] * texture.pigment[c]));
  free(out);
  assert_true(stats.counts.rays[1] > 0);
  texture = saved;
}

/* Powers, colours and products as large as a scene can ask for are at most too bright for a float, never NaN. */
TEST(extreme_colours_are_numbers)
{
  struct scene scene = scene_of();
  const struct scene_texture saved = texture;
  const struct scene_light light = lights[0];
  const double most = FLT_MAX, powers[] = {-most, -40, 40, most}, colours[] = {-most, 0, most};
  const struct render_options options = options_of("rgb");
  for (size_t p = 0; p < 4; p++) {
    for (size_t c = 0; c < 9; c++) {
      const double pigment = colours[c % 3], shine = colours[c / 3];
      texture = (struct scene_texture){.pigment = {pigment, 0, -pigment},
                                       .finish = {.ambient = {most, most, -most},
                                                  .diffuse = most,
                                                  .brilliance = powers[p],
                                                  .phong = most,
                                                  .phong_size = powers[p],
                                                  .specular = most,
                                                  .roughness = 1 / powers[p]}};
      lights[0].color[0] = shine, lights[0].color[1] = 0, lights[0].color[2] = -shine;
      struct render_stats stats;
      float *out = render(&scene, &options, &stats);
      for (size_t k = 0; k < (size_t)WIDTH * HEIGHT * 3; k++) assert_true(out[k] <= INFINITY);
      free(out);
    }
  }
  texture = saved;
  lights[0] = light;
}

/* In a mirror's direction rounding makes cosines exceed 1. Their large powers must still be 1, not a blinding spot. */
TEST(highlights_are_no_brighter_than_their_light)
{
  struct scene scene = scene_of();
  const struct scene_texture saved = texture;
  const struct scene_light light = lights[0];
  scene.patches = &patches[1];
  scene.patch_count = scene.light_count = 1;
  struct render_options options = options_of("rgb");
  lights[0].color[0] = lights[0].color[1] = lights[0].color[2] = 1;
  for (size_t n = 0; n < 400; n++) {
    double point[3];
    options.crop = (struct rectangle){25 + n % 20, 12 + n / 20, 1, 1};
    point_on_wall(options.crop.x, options.crop.y, point);
    memcpy(lights[0].position, (const double[3]){2 * point[0], 2 * point[1], -5}, sizeof lights[0].position);
    texture.finish = (struct scene_finish){.brilliance = 1, .roughness = 1 / (double)FLT_MAX, .phong_size = FLT_MAX};
    texture.finish.phong = n % 2 == 0, texture.finish.specular = n % 2 == 1;
    struct render_stats stats;
    float *out = render(&scene, &options, &stats);
    for (int c = 0; c < 3; c++) assert_true(out[c] >= 0 && (double)out[c] <= 1);
    free(out);
  }
  texture = saved;
  lights[0] = light;
}

/* The shadow ray begins beside the surface and ends at the light, also along an axis. It has a direction even if the
 * light is exactly where it begins. */
TEST(a_light_may_be_where_its_shadow_ray_begins)
{
  const struct scene scene = scene_of();
  struct intersector *intersector;
  struct tracer *tracer;
  assert_int_equal(intersector_create(&scene, &intersector), STATUS_OK);
  assert_int_equal(tracer_create(intersector, &tracer), STATUS_OK);
  const struct ray ray = {.origin = {2, 1, -5}, .direction = {0, 0, 1}, .t_max = INFINITY};
  struct hit hit;
  tracer_closest(tracer, 1, &ray, &hit);
  struct scene_light light = {.position = {2, 1, 1}};
  struct ray shadow;
  bool sent;
  assert_int_equal(shade_shadow_rays(&light, tracer, 1, &ray, &hit, &shadow, &sent), 1);
  assert_true(shadow.direction[0] == 0 && shadow.direction[2] == light.position[2] - shadow.origin[2]);
  memcpy(light.position, shadow.origin, sizeof light.position);
  assert_int_equal(shade_shadow_rays(&light, tracer, 1, &ray, &hit, &shadow, &sent), 1);
  assert_true(sent);
  assert_memory_equal(light.position, shadow.origin, sizeof light.position);
  assert_true(shadow.direction[2] < 0);
  tracer_destroy(tracer);
  intersector_destroy(intersector);
}

/* A point hidden from the only light has the ambient colour, unless the light is shadowless. */
TEST(shadows_are_cast)
{
  struct scene scene = scene_of();
  scene.light_count = 1;
  /* The light is straight in front of two flat squares. The front one, with half a side of 1, hides 5/3 of the other,
   * more than the camera's 7/5. */
  patches[0] = square(1, 0, 0);
  memcpy(lights[0].position, (const double[3]){0, 0, -3}, sizeof lights[0].position);
  const struct render_options options = options_of("rgb,patch");
  struct render_stats stats;
  size_t dark = 0, lit = 0;
  for (int shadowless = 0; shadowless <= 1; shadowless++) {
    lights[0].shadowless = shadowless != 0;
    float *out = render(&scene, &options, &stats);
    for (size_t n = 0; n < WIDTH * HEIGHT; n++) {
      double point[3];
      const float *pixel = wall_pixel(out, n, point);
      if (pixel == NULL) continue;
      const bool hidden = shadowless == 0 && fmax(fabs(point[0]), fabs(point[1])) < 5.0 / 3;
      const bool ambient = fabs((double)pixel[0] - 0.1 * 1 * 0.8) < 1e-6;
      assert_int_equal(ambient, hidden);
      dark += hidden;
      lit += !hidden;
    }
    free(out);
    assert_true(lit > 0);
    if (shadowless != 0) assert_int_equal(stats.counts.rays[1], 0);
  }
  assert_true(dark > 0);
}

/* A light on a surface is not hidden by it, however its position and the shadow rays' ends are rounded. */
TEST(a_light_may_lie_on_a_surface)
{
  struct scene scene = scene_of();
  scene.light_count = 1;
  patches[0] = square(1, 0, 0);
  for (int i = 0; i < 4; i++) { /* a floor, wider than the wall, leaning to the left */
    for (int j = 0; j < 4; j++) {
      const double x = 2.4 * j - 3.6, floor[3] = {x, 0.1 * x - 0.7, 1.3 * i - 2.1};
      memcpy(patches[0].P[i][j], floor, sizeof floor);
    }
  }
  memcpy(lights[0].position, (const double[3]){0.3, 0.1 * 0.3 - 0.7, -0.4}, sizeof lights[0].position);
  const struct render_options options = options_of("rgb,patch");
  struct render_stats stats;
  float *out = render(&scene, &options, &stats);
  size_t lit = 0;
  for (size_t n = 0; n < WIDTH * HEIGHT; n++) {
    double point[3];
    const float *pixel = wall_pixel(out, n, point);
    if (pixel == NULL || point[1] < 0.1 * point[0] - 0.7) continue;
    assert_true((double)pixel[0] > 0.1 * 1 * 0.8 + 1e-3);
    lit++;
  }
  free(out);
  assert_true(lit > 1000);
}
