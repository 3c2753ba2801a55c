/* Rendering: the same pixels for any threads and crop, colours by the shading formulas, channels, samples. */
#include "render/render.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "cmocka_test.h"
#include "geometry/vector.h"
#include "render/shade.h"

enum { WIDTH = 70, HEIGHT = 45 }; /* several tiles, none of them whole at the right and lower edges */

static struct scene_texture texture = {
  .pigment = {0.8, 0.5, 0.3},
  .finish = {.ambient = {0.1, 0.2, 0.3}, .diffuse = 0.6, .brilliance = 1, .phong_size = 40, .roughness = 0.05}};
static struct method solver;
static struct scene_patch patches[2];
static struct scene_light lights[2];

/* The square |x|, |y| <= half at depth z; bulge pulls its inner control points towards the camera. */
static struct scene_patch square(double half, double z, double bulge)
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

/* A bulging square before a flat one that does not fill the picture, seen along z. Tests change it as they need. */
static struct scene scene_of(void)
{
  method_default(solver_at(0), &solver);
  patches[0] = square(1, 0, 1.5);
  patches[1] = square(3, 2, 0);
  lights[0] = (struct scene_light){.position = {2, 4, -6}, .color = {1, 0.9, 0.8}};
  lights[1] = (struct scene_light){.position = {-5, 1, -6}, .color = {0.2, 0.2, 0.4}, .shadowless = true};
  const struct scene_camera camera = {
    .location = {0, 0, -5}, .direction = {0, 0, 1}, .right = {1.4, 0, 0}, .up = {0, 0.9, 0}};
  return (struct scene){.camera = camera,
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

static struct render_options options_of(const char *channels)
{
  struct render_options options = {
    .width = WIDTH, .height = HEIGHT, .samples = 1, .threads = 1, .crop = {.width = WIDTH, .height = HEIGHT}};
  const char *bad;
  size_t length;
  assert_true(channel_list_parse(channels, &options.channels, &bad, &length));
  return options;
}

/* The values of a picture, to be freed. */
static float *render(const struct scene *scene, const struct render_options *options, struct render_stats *out_stats)
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

static void expect_invariance(const struct scene *scene)
{
  static const struct rectangle crops[] = {{0, 0, 1, 1},   {69, 44, 1, 1}, {31, 31, 2, 2},
                                           {5, 7, 40, 30}, {64, 3, 6, 40}, {0, 44, 70, 1}};
  struct render_options options = options_of("rgb,depth,u,v,patch,normal,status,iterations,roots,residual,deviation");
  struct render_stats stats;
  float *whole = render(scene, &options, &stats);
  const size_t pixel = options.channels.width * sizeof(float);
  for (size_t threads = 2; threads <= 7; threads += 5) {
    options.threads = threads;
    float *again = render(scene, &options, &stats);
    assert_memory_equal(again, whole, WIDTH * HEIGHT * pixel);
    free(again);
  }
  for (size_t k = 0; k < sizeof crops / sizeof crops[0]; k++) {
    options.crop = crops[k];
    float *part = render(scene, &options, &stats);
    for (size_t y = 0; y < crops[k].height; y++) {
      const size_t first = (crops[k].y + y) * WIDTH + crops[k].x;
      assert_memory_equal(part + y * crops[k].width * options.channels.width, whole + first * options.channels.width,
                          crops[k].width * pixel);
    }
    free(part);
  }
  free(whole);
}

/* A camera sees what is right before it, and to the end of the world. */
static void all_distances_are_seen(void **state)
{
  (void)state;
  for (int exponent = -20; exponent <= 20; exponent += 20) {
    struct scene scene = scene_of();
    patches[1] = square(ldexp(2, exponent), 2, 0);
    scene.camera.location[2] = 2 - ldexp(1, exponent);
    scene.patches = &patches[1], scene.patch_count = 1;
    struct render_options options = options_of("depth");
    options.crop = (struct rectangle){WIDTH / 2, HEIGHT / 2, 1, 1};
    struct render_stats stats;
    float *depth = render(&scene, &options, &stats);
    assert_true(fabs(ldexp((double)depth[0], -exponent) - 1) < 0.01);
    free(depth);
  }
}

static void threads_and_crop_change_nothing(void **state)
{
  (void)state;
  const struct scene scene = scene_of();
  expect_invariance(&scene);
}

/* Which one of the solvers asks for. */
static void nor_do_they_with_warm_starts(void **state)
{
  (void)state;
  struct scene scene = scene_of();
  struct method solvers[2] = {solver};
  const struct solver *aberth = solver_find("aberth", strlen("aberth"));
  assert_non_null(aberth);
  scene.solvers = solvers, scene.solver_count = 2;
  patches[0].solver = patches[1].solver = 1;
  method_default(aberth, &solvers[1]);
  solvers[1].roots.start = START_PREVIOUS;
  solvers[1].polish = false;
  solvers[1].split = 1;
  solvers[1].roots.tolerance = 0.05; /* coarse, so that answers do depend on where the solver starts */
  expect_invariance(&scene);
}

static void crop_counts_only_its_rays(void **state)
{
  (void)state;
  const struct scene scene = scene_of();
  struct render_options options = options_of("rgb");
  options.crop = (struct rectangle){10, 20, 9, 5};
  options.samples = 3;
  struct render_stats stats;
  free(render(&scene, &options, &stats));
  assert_int_equal(stats.counts.rays[0], 9 * 5 * 9);
  assert_true(stats.counts.rays[1] > 0 && stats.counts.rays[1] <= stats.counts.rays[0]);
  assert_true(stats.counts.patches_tested > 0 && stats.counts.roots_accepted > 0);
  assert_true(stats.counts.roots_found >= stats.counts.roots_accepted);
}

/* Where the ray of pixel (x, y) meets the plane z = 2 of the flat square. */
static void point_on_wall(size_t x, size_t y, double out[3])
{
  out[0] = 7 * (((double)x + 0.5) / WIDTH - 0.5) * 1.4;
  out[1] = 7 * (0.5 - ((double)y + 0.5) / HEIGHT) * 0.9;
  out[2] = 2;
}

/* Pixel n of a picture of "rgb,patch", and the point of the wall, patch 1, that it shows; NULL where it shows
 * another. */
static const float *wall_pixel(const float *picture, size_t n, double out_point[3])
{
  point_on_wall(n % WIDTH, n / WIDTH, out_point);
  return picture[4 * n + 3] == 1 ? picture + 4 * n : NULL;
}

/* Whether a value is the float of a number that was computed in another order: one unit in the last place, or of 1. */
static bool is_float(float value, double expected)
{
  return (double)value == expected || fabs((double)value - expected) <= 0x1p-23 * (1 + fabs(expected));
}

/* The colour of a point of the flat square, seen by the camera of scene_of, by the formulas of shade.h. */
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

static void colours_follow_the_formulas(void **state)
{
  (void)state;
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
  for (size_t f = 0; f < sizeof finishes / sizeof finishes[0]; f++) {
    texture.finish = finishes[f];
    lights[0].position[2] = f % 2 == 0 ? -6 : 1; /* high above, and grazing */
    lights[1].position[2] = f == 3 ? 3 : -6;     /* behind the surface it gives nothing */
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

/* A negative diffuse part takes nothing from the ambient colour. */
static void nothing_darkens(void **state)
{
  (void)state;
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

/* Powers, colours and products as large as a scene can ask for are too bright for a float at most. */
static void extreme_colours_are_numbers(void **state)
{
  (void)state;
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

/* In a mirror's direction cosines are above 1 by rounding: that to a large power is still 1, not a spot of all there is. */
static void highlights_are_no_brighter_than_their_light(void **state)
{
  (void)state;
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

/* The shadow ray begins beside the surface, and where the light is just there, it still has a direction. */
static void a_light_may_be_where_its_shadow_ray_begins(void **state)
{
  (void)state;
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
  assert_true(shade_shadow_ray(&light, &hit, &shadow));
  memcpy(light.position, shadow.origin, sizeof light.position);
  assert_true(shade_shadow_ray(&light, &hit, &shadow));
  assert_memory_equal(light.position, shadow.origin, sizeof light.position);
  assert_true(shadow.direction[2] < 0);
  tracer_destroy(tracer);
  intersector_destroy(intersector);
}

/* What is hidden from the only light has the ambient colour, unless the light is shadowless. */
static void shadows_are_cast(void **state)
{
  (void)state;
  struct scene scene = scene_of();
  scene.light_count = 1;
  /* Straight before both squares, flat ones: the front one, half a side 1, hides 5/3 of the other, more than the
   * camera's 7/5. */
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

/* A light that lies on a surface is not hidden by it, whichever way its place and the shadow rays' ends are rounded. */
static void a_light_may_lie_on_a_surface(void **state)
{
  (void)state;
  struct scene scene = scene_of();
  scene.light_count = 1;
  patches[0] = square(1, 0, 0);
  for (int i = 0; i < 4; i++) { /* a floor, wider than the wall, that leans to the left */
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

static void channels_tell_of_the_hit(void **state)
{
  (void)state;
  struct scene scene = scene_of();
  scene.patches = &patches[1];
  scene.patch_count = 1;
  const struct render_options options = options_of("depth,u,v,patch,normal,status,coverage");
  struct render_stats stats;
  float *out = render(&scene, &options, &stats);
  size_t hits = 0;
  for (size_t y = 0; y < HEIGHT; y++) {
    for (size_t x = 0; x < WIDTH; x++) {
      const float *pixel = out + 9 * (y * WIDTH + x);
      double point[3];
      point_on_wall(x, y, point);
      const bool hit = fmax(fabs(point[0]), fabs(point[1])) < 3;
      const double expected[9] = {hit ? sqrt(point[0] * point[0] + point[1] * point[1] + 49) : INFINITY,
                                  hit ? (point[1] + 3) / 6 : 0, /* rows of the net run along y: u */
                                  hit ? (point[0] + 3) / 6 : 0,
                                  hit ? 0 : -1,
                                  0,
                                  0,
                                  hit ? -1 : 0,
                                  hit ? CHANNEL_HIT_CERTAIN : CHANNEL_MISS_CERTAIN,
                                  hit};
      for (int k = 0; k < 9; k++) assert_true(is_float(pixel[k], expected[k]));
      hits += hit;
    }
  }
  assert_true(hits > 0 && hits < WIDTH * HEIGHT);
  free(out);
}

/* What the solver did: iterations, roots, eq 11, the distance from the certified answer. The other channels are the
 * same bits whether they are asked for or not. Returns how many pixels deviate by more than `off`, or are wrong. */
static size_t expect_measures(const struct scene *scene, double most_roots, double most_off)
{
  const struct render_options plain = options_of("rgb,depth,u,v,patch,normal,status");
  const struct render_options more = options_of(
    "rgb,depth,u,v,patch,normal,status,iterations,roots,residual,deviation");
  struct render_stats stats;
  float *expected = render(scene, &plain, &stats), *out = render(scene, &more, &stats);
  method_default(solver_at(0), &solver); /* the scene's */
  float *exact = render(scene, &plain, &stats);
  size_t off = 0, hits = 0, accurate = 0;
  for (size_t n = 0; n < WIDTH * HEIGHT; n++) {
    const float *pixel = out + 15 * n;
    assert_memory_equal(pixel, expected + 11 * n, 11 * sizeof *pixel);
    const double iterations = (double)pixel[11], roots = (double)pixel[12], residual = (double)pixel[13];
    const double depth = (double)pixel[3], right = (double)exact[11 * n + 3], deviation = (double)pixel[14];
    const bool hit = isfinite(depth);
    assert_true(roots <= most_roots);
    assert_true(!hit || (roots > 0 && iterations > 0));
    assert_true(hit ? residual >= 0 && isfinite(residual) : residual == 0);
    accurate += hit && residual < 1;
    if (hit != isfinite(right)) assert_true(isinf(deviation));
    else if (!hit) assert_true(deviation == 0);
    else assert_true(fabs(deviation - fabs(depth - right) / right) < 1e-6 * (1 + deviation));
    off += deviation > most_off, hits += hit;
  }
  assert_true(hits > WIDTH * HEIGHT / 4 && (most_off > 0 || accurate > hits / 2));
  free(expected), free(out), free(exact);
  return off;
}

static void channels_tell_of_the_solver(void **state)
{
  (void)state;
  struct scene scene = scene_of();
  assert_int_equal(expect_measures(&scene, INFINITY, 0), 0); /* the default is what is certified */
  static const char *const names[] = {"newton", "laguerre", "aberth", "durand_kerner"};
  size_t off = 0;
  for (int k = 0; k < 4; k++) {
    scene = scene_of();
    patches[1] = square(3, 2, 0.7); /* bidegree 3, as the other one */
    method_default(solver_find(names[k], strlen(names[k])), &solver);
    solver_options_form(&solver.roots, false);
    solver.basis = BASIS_POWER, solver.polish = false, solver.split = 1;
    solver.back_substitution = BACK_SUBSTITUTION_EUCLID, solver.resultant = RESULTANT_SYLVESTER;
    solver.roots.tolerance = 0.05, solver.residual = 1; /* so that answers are off */
    off += expect_measures(&scene, 2 * 18, 1e-6);
  }
  assert_true(off > 0 && off < 4 * WIDTH * HEIGHT / 2);
}

/* The status of a pixel is its answer's, certain by default and not where nothing is polished. */
static void statuses_are_the_answers(void **state)
{
  (void)state;
  const struct scene scene = scene_of();
  const struct render_options options = options_of("status,patch");
  for (int certain = 0; certain < 2; certain++) {
    if (!certain) method_default(solver_find("newton", 6), &solver);
    else method_default(solver_at(0), &solver);
    solver.polish = certain;
    struct render_stats stats;
    float *out = render(&scene, &options, &stats);
    for (size_t n = 0; n < WIDTH * HEIGHT; n++) {
      const bool hit = out[2 * n + 1] >= 0;
      const int misses = certain ? CHANNEL_MISS_CERTAIN : CHANNEL_MISS_GRAZING,
                hits = certain ? CHANNEL_HIT_CERTAIN : CHANNEL_HIT_GRAZING;
      assert_true(out[2 * n] == (float)(hit ? hits : misses));
    }
    free(out);
    assert_int_equal(certain ? stats.counts.certain : stats.counts.grazing, WIDTH * HEIGHT);
  }
}

/* N x N samples are the pixels of a picture N times as large, averaged; data are those of the middle sample. */
static void samples_are_a_finer_picture(void **state)
{
  (void)state;
  const struct scene scene = scene_of();
  for (size_t n = 2; n <= 3; n++) {
    struct render_options options = options_of("rgb,depth,coverage"), fine = options;
    struct render_stats stats;
    options.samples = n;
    fine.width = fine.crop.width = n * WIDTH;
    fine.height = fine.crop.height = n * HEIGHT;
    float *out = render(&scene, &options, &stats), *large = render(&scene, &fine, &stats);
    for (size_t y = 0; y < HEIGHT; y++) {
      for (size_t x = 0; x < WIDTH; x++) {
        const float *pixel = out + 5 * (y * WIDTH + x);
        double mean[5] = {0};
        for (size_t k = 0; k < n * n; k++) {
          const float *sample = large + 5 * ((y * n + k / n) * n * WIDTH + x * n + k % n);
          for (int c = 0; c < 5; c++) mean[c] += (double)sample[c] / (double)(n * n);
        }
        const float *middle = large + 5 * ((y * n + n / 2) * n * WIDTH + x * n + n / 2);
        const double slack = 1e-6; /* floats, and rays that differ in the last place */
        for (int c = 0; c < 3; c++) assert_true(fabs((double)pixel[c] - mean[c]) < slack);
        assert_true(fabs((double)pixel[4] - mean[4]) < slack);
        assert_true(pixel[3] == middle[3] || fabs((double)pixel[3] - (double)middle[3]) < slack * (double)middle[3]);
      }
    }
    free(out);
    free(large);
  }
}

static void a_stopped_rendering_says_so(void **state)
{
  (void)state;
  const struct scene scene = scene_of();
  const struct render_options options = options_of("rgb");
  static float out[WIDTH * HEIGHT * 3];
  const atomic_int stop = 15;
  const struct render_watch watch = {.stop = &stop};
  struct render_stats stats;
  struct intersector *intersector;
  assert_int_equal(intersector_create(&scene, &intersector), STATUS_OK);
  assert_int_equal(render_scene(&scene, intersector, &options, &watch, out, &stats), STATUS_INTERRUPTED);
  assert_int_equal(stats.counts.rays[0], 0);
  intersector_destroy(intersector);
}

/* What is told while tiles are done: of all pixels, and of all rays, the shadow rays, too. It stops when that has been seen. */
struct listening {
  atomic_int stop;
  size_t total, pixels;
  bool right;
};

static void listen(void *context, const struct render_progress *progress)
{
  struct listening *heard = context;
  assert_true(progress->pixels >= heard->pixels && progress->pixels <= progress->pixels_total && progress->seconds > 0);
  heard->total = progress->pixels_total, heard->pixels = progress->pixels;
  heard->right |= heard->pixels > 0 && progress->rays > 20 * 20 * heard->pixels;
  if (heard->right) atomic_store(&heard->stop, 15);
}

static void progress_is_told(void **state)
{
  (void)state;
  const struct scene scene = scene_of();
  struct render_options options = options_of("rgb");
  options.samples = 20;
  static float out[WIDTH * HEIGHT * 3];
  struct listening heard = {0};
  const struct render_watch watch = {.stop = &heard.stop, .progress = listen, .context = &heard};
  struct render_stats stats;
  struct intersector *intersector;
  assert_int_equal(intersector_create(&scene, &intersector), STATUS_OK);
  const enum status status = render_scene(&scene, intersector, &options, &watch, out, &stats);
  assert_true(status == STATUS_INTERRUPTED || status == STATUS_OK); /* in the last tile nobody stops any more */
  assert_int_equal(heard.total, WIDTH * HEIGHT);
  assert_true(heard.right);
  intersector_destroy(intersector);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(all_distances_are_seen),
    cmocka_unit_test(threads_and_crop_change_nothing),
    cmocka_unit_test(nor_do_they_with_warm_starts),
    cmocka_unit_test(crop_counts_only_its_rays),
    cmocka_unit_test(colours_follow_the_formulas),
    cmocka_unit_test(nothing_darkens),
    cmocka_unit_test(extreme_colours_are_numbers),
    cmocka_unit_test(shadows_are_cast),
    cmocka_unit_test(a_light_may_lie_on_a_surface),
    cmocka_unit_test(channels_tell_of_the_hit),
    cmocka_unit_test(channels_tell_of_the_solver),
    cmocka_unit_test(statuses_are_the_answers),
    cmocka_unit_test(highlights_are_no_brighter_than_their_light),
    cmocka_unit_test(a_light_may_be_where_its_shadow_ray_begins),
    cmocka_unit_test(progress_is_told),
    cmocka_unit_test(samples_are_a_finer_picture),
    cmocka_unit_test(a_stopped_rendering_says_so),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
