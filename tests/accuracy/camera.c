/* Proves that camera rays of the shipped scenes are answered as the reference answers them: the teapot at 800x600, the
 * others smaller. PSCN_EFFORT=full takes every pixel, otherwise a seeded choice. Also proves that the text of `pscn
 * trace` gives the same answers. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "accuracy/trial.h"
#include "cmocka_test.h"
#include "effort.h"
#include "random.h"

struct view {
  const char *path;
  int width, height;
};

static const struct view views[] = {
  {PSCN_SOURCE_DIR "/scenes/teapot.pscn", 800, 600},         {PSCN_SOURCE_DIR "/scenes/dome.pscn", 320, 240},
  {PSCN_SOURCE_DIR "/scenes/bent.pscn", 320, 240},           {PSCN_SOURCE_DIR "/scenes/waves.pscn", 320, 240},
  {PSCN_SOURCE_DIR "/scenes/degrees.pscn", 320, 240},        {PSCN_SOURCE_DIR "/scenes/nested.pscn", 320, 240},
  {PSCN_SOURCE_DIR "/tests/accuracy/copies.pscn", 320, 240},
};
enum { VIEWS = sizeof views / sizeof views[0], COMMAND_RAYS = 2000 };

/* The limits for each picture. */
#define T_RELATIVE_MEDIAN 1e-15
#define CERTAIN_SHARE 0.9999

static struct scene *load(const struct view *view)
{
  struct scene *scene = trial_load(view->path, NULL, view->width, view->height);
  assert_non_null(scene);
  return scene;
}

/* The ray through the middle of pixel number `index`. */
static void pixel_ray(const struct scene *scene, const struct view *view, size_t index, struct ray *ray)
{
  const size_t width = (size_t)view->width;
  const double s = ((double)(index % width) + 0.5) / view->width, t = ((double)(index / width) + 0.5) / view->height;
  const struct scene_camera *camera = &scene->camera;
  *ray = (struct ray){.t_min = 0, .t_max = INFINITY};
  for (int axis = 0; axis < 3; axis++) {
    ray->origin[axis] = camera->location[axis];
    ray->direction[axis] = camera->direction[axis] + (s - 0.5) * camera->right[axis] + (0.5 - t) * camera->up[axis];
  }
}

static void test_view(void **state)
{
  const struct view *view = *state;
  struct scene *scene = load(view);
  struct trial trial;
  trial_of_scene(&trial, scene);
  struct tally tally = {.name = strrchr(view->path, '/') + 1};
  struct random random = {.state = 601};
  const size_t pixels = (size_t)view->width * (size_t)view->height, wanted = effort_count(pixels, 400);
  while (tally.rays < wanted) {
    struct ray rays[PACKET_SIZE];
    for (size_t n = 0; n < PACKET_SIZE; n++) {
      const size_t index = wanted == pixels ? tally.rays + n : (size_t)(random_bits(&random) % pixels);
      pixel_ray(scene, view, index, &rays[n]);
    }
    const size_t left = wanted - tally.rays;
    trial_rays(&trial, rays, left < PACKET_SIZE ? left : PACKET_SIZE, &tally);
  }
  tally_print(&tally);
  tally_assert(&tally);
  assert_true(tally.hits > wanted / 4);
  assert_true(tally.t_errors[tally.t_count - 1] <= TRIAL_T_RELATIVE);
  assert_true(tally.t_errors[tally.t_count / 2] <= T_RELATIVE_MEDIAN);
  assert_true((double)tally.grazing <= (1 - CERTAIN_SHARE) * (double)tally.rays + 1);
  tally_free(&tally);
  trial_destroy(&trial);
  scene_destroy(scene);
}

/* Compares a line of `pscn trace` with the answer in memory. 17 digits restore every double, so everything is the same
 * bit for bit, except T, which is scaled by the direction's length. */
static void compare_line(const char *line, const struct ray *ray, const struct hit *hit)
{
  if (hit->patch == HIT_NONE) {
    assert_string_equal(line, "miss\n");
    return;
  }
  double T, u, v, normal[3];
  unsigned patch;
  const int read = sscanf(line, "hit %lf %lf %lf %u %lf %lf %lf", &T, &u, &v, &patch, &normal[0], &normal[1],
                          &normal[2]);
  assert_int_equal(read, 7);
  const double *d = ray->direction;
  const double length = sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]);
  assert_true(fabs(T - hit->t * length) <= 4 * DOUBLE_UNIT * T);
  assert_true(u == hit->u && v == hit->v && patch == hit->patch);
  for (int axis = 0; axis < 3; axis++) assert_true(normal[axis] == hit->normal[axis]); /* the text has no -0 */
}

static void test_command(void **state)
{
  (void)state;
  const char *program = getenv("PSCN");
  assert_non_null(program);
  const struct view *view = &views[0];
  struct scene *scene = load(view);
  struct trial trial;
  trial_of_scene(&trial, scene);
  struct random random = {.state = 602};
  static struct ray rays[COMMAND_RAYS];
  char input[] = "/tmp/pscn-rays-XXXXXX";
  const int descriptor = mkstemp(input);
  assert_true(descriptor >= 0);
  FILE *file = fdopen(descriptor, "w");
  assert_non_null(file);
  for (int n = 0; n < COMMAND_RAYS; n++) {
    pixel_ray(scene, view, (size_t)(random_bits(&random) % ((size_t)view->width * (size_t)view->height)), &rays[n]);
    const struct ray *r = &rays[n];
    fprintf(file, "%.17g %.17g %.17g %.17g %.17g %.17g\n", r->origin[0], r->origin[1], r->origin[2], r->direction[0],
            r->direction[1], r->direction[2]);
  }
  assert_int_equal(fclose(file), 0);
  char command[4096];
  snprintf(command, sizeof command, "'%s' trace '%s' --quiet < '%s'", program, view->path, input);
  FILE *answers = popen(command, "r");
  assert_non_null(answers);
  int hits = 0;
  for (int n = 0; n < COMMAND_RAYS; n++) {
    char line[512];
    struct hit hit;
    tracer_closest(trial.tracer, 1, &rays[n], &hit);
    assert_non_null(fgets(line, sizeof line, answers));
    compare_line(line, &rays[n], &hit);
    hits += hit.patch != HIT_NONE;
  }
  assert_int_equal(fgetc(answers), EOF);
  assert_int_equal(pclose(answers), 0);
  remove(input);
  assert_true(hits > COMMAND_RAYS / 4);
  trial_destroy(&trial);
  scene_destroy(scene);
}

int main(void)
{
  struct CMUnitTest tests[VIEWS + 1];
  for (int n = 0; n < VIEWS; n++) {
    void *view = (void *)(uintptr_t)&views[n]; /* cmocka's state is not const */
    const char *name = strrchr(views[n].path, '/') + 1;
    tests[n] = (struct CMUnitTest){.name = name, .test_func = test_view, .initial_state = view};
  }
  tests[VIEWS] = (struct CMUnitTest)cmocka_unit_test(test_command);
  return cmocka_run_group_tests(tests, NULL, NULL);
}
