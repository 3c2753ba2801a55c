/* Rendering: the pixels do not depend on threads and crop; channels, samples and progress reports are right. */
#include "base/clock.h"
#include "unit/rendered.h"

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

/* A camera sees what is just in front of it, and what is very far away. */
TEST(all_distances_are_seen)
{
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

TEST(threads_and_crop_change_nothing)
{
  const struct scene scene = scene_of();
  expect_invariance(&scene);
}

/* Only one of the two solvers asks for them. */
TEST(nor_do_they_with_warm_starts)
{
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
  solvers[1].roots.tolerance = 0.05; /* coarse, so that answers depend on where the solver starts */
  expect_invariance(&scene);
}

TEST(crop_counts_only_its_rays)
{
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

TEST(channels_tell_of_the_hit)
{
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

/* The channels that show the solver's work: iterations, roots, eq 11, the deviation from the certified answer. The
 * other channels have the same bits, whether these are asked for or not. Returns how many pixels are wrong, or deviate
 * by more than `most_off`. */
static size_t expect_measures(const struct scene *scene, double most_roots, double most_off)
{
  const struct render_options plain = options_of("rgb,depth,u,v,patch,normal,status");
  const struct render_options more = options_of(
    "rgb,depth,u,v,patch,normal,status,iterations,roots,residual,deviation");
  struct render_stats stats;
  float *expected = render(scene, &plain, &stats), *out = render(scene, &more, &stats);
  method_default(solver_at(0), &solver); /* of the scene */
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

TEST(channels_tell_of_the_solver)
{
  struct scene scene = scene_of();
  assert_int_equal(expect_measures(&scene, INFINITY, 0), 0); /* the default's answers are the certified ones */
  static const char *const names[] = {"newton", "laguerre", "aberth", "durand_kerner"};
  size_t off = 0;
  for (int k = 0; k < 4; k++) {
    scene = scene_of();
    patches[1] = square(3, 2, 0.7); /* bidegree 3, as the other patch has */
    method_default(solver_find(names[k], strlen(names[k])), &solver);
    solver_options_form(&solver.roots, false);
    solver.basis = BASIS_POWER, solver.polish = false, solver.split = 1;
    solver.back_substitution = BACK_SUBSTITUTION_EUCLID, solver.resultant = RESULTANT_SYLVESTER;
    solver.roots.tolerance = 0.05, solver.residual = 1; /* so that answers are off */
    off += expect_measures(&scene, 2 * 18, 1e-6);
  }
  assert_true(off > 0 && off < 4 * WIDTH * HEIGHT / 2);
}

/* The solver's work is measured if any channel shows it. */
TEST(one_channel_is_enough)
{
  static const struct {
    const char *text;
    bool measures;
  } cases[] = {{"rgb,depth,deviation", false}, {"iterations", true}, {"roots", true}, {"rgb,residual", true}};
  for (size_t k = 0; k < sizeof cases / sizeof cases[0]; k++) {
    const struct render_options options = options_of(cases[k].text);
    assert_int_equal(channel_list_measures(&options.channels), cases[k].measures);
  }
}

/* The status of a pixel is that of its answer: certain by default, and never without polish. Either way a hit
 * covers. */
TEST(statuses_are_the_answers)
{
  const struct scene scene = scene_of();
  const struct render_options options = options_of("status,patch,coverage");
  for (int certain = 0; certain < 2; certain++) {
    if (!certain) method_default(solver_find("newton", 6), &solver);
    else method_default(solver_at(0), &solver);
    solver.polish = certain;
    struct render_stats stats;
    float *out = render(&scene, &options, &stats);
    for (size_t n = 0; n < WIDTH * HEIGHT; n++) {
      const bool hit = out[3 * n + 1] >= 0;
      const int misses = certain ? CHANNEL_MISS_CERTAIN : CHANNEL_MISS_GRAZING,
                hits = certain ? CHANNEL_HIT_CERTAIN : CHANNEL_HIT_GRAZING;
      assert_true(out[3 * n] == (float)(hit ? hits : misses) && out[3 * n + 2] == (float)hit);
    }
    free(out);
    assert_int_equal(certain ? stats.counts.certain : stats.counts.grazing, WIDTH * HEIGHT);
  }
}

/* N x N samples are the pixels of a picture N times as large, averaged; data are those of the middle sample. */
TEST(samples_are_a_finer_picture)
{
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

TEST(a_stopped_rendering_says_so)
{
  const struct scene scene = scene_of();
  const struct render_options options = options_of("rgb");
  static float out[WIDTH * HEIGHT * 3];
  const atomic_int stop = 15;
  const struct render_watch watches[] = {{.stop = &stop}, {.failed = &stop}}; /* its file could not be written */
  struct render_stats stats;
  struct intersector *intersector;
  assert_int_equal(intersector_create(&scene, &intersector), STATUS_OK);
  for (size_t k = 0; k < sizeof watches / sizeof *watches; k++) {
    assert_int_equal(render_scene(&scene, intersector, &options, &watches[k], out, &stats), STATUS_INTERRUPTED);
    assert_int_equal(stats.counts.rays[0], 0);
  }
  intersector_destroy(intersector);
}

/* Progress while tiles are done: all pixels and all rays, shadow rays included, are counted. Once that has been seen,
 * it stops the rendering. */
struct listening {
  atomic_int stop;
  size_t total, pixels;
  double start; /* of the clock */
  bool right;
};

static void listen(void *context, const struct render_progress *progress)
{
  struct listening *heard = context;
  assert_true(progress->pixels >= heard->pixels && progress->pixels <= progress->pixels_total && progress->seconds > 0);
  assert_true(progress->seconds <= clock_seconds(CLOCK_MONOTONIC) - heard->start);
  heard->total = progress->pixels_total, heard->pixels = progress->pixels;
  heard->right |= heard->pixels > 0 && progress->rays > 20 * 20 * heard->pixels;
  if (heard->right) atomic_store(&heard->stop, 15);
}

TEST(progress_is_told)
{
  const struct scene scene = scene_of();
  struct render_options options = options_of("rgb");
  options.samples = 20;
  static float out[WIDTH * HEIGHT * 3];
  struct listening heard = {.start = clock_seconds(CLOCK_MONOTONIC)};
  const struct render_watch watch = {.stop = &heard.stop, .progress = listen, .context = &heard};
  struct render_stats stats;
  struct intersector *intersector;
  assert_int_equal(intersector_create(&scene, &intersector), STATUS_OK);
  const enum status status = render_scene(&scene, intersector, &options, &watch, out, &stats);
  assert_true(status == STATUS_INTERRUPTED || status == STATUS_OK); /* in the last tile it is too late to stop */
  assert_int_equal(heard.total, WIDTH * HEIGHT);
  assert_true(heard.right);
  intersector_destroy(intersector);
}
