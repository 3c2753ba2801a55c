/* Measures the cost of rays, for use by hand: one by one, in microseconds of this processor, the best of three times.
 *
 *   cost [SCENE...]
 *
 * The rays are those of every class of situations.h (PSCN_CLASS leaves the others out), and rays aimed at
 * each scene: tangent at a point of a patch as nearly as doubles allow, at points of edges, and at corners and poles,
 * exactly. Each line gives the median, the 99th percentile, the worst, and how many answers are grazing, for the
 * nearest hit and for all hits. PSCN_EFFORT sets the number of rays. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "accuracy/class_tests.h"
#include "accuracy/generate.h"
#include "base/clock.h"
#include "base/sort.h"
#include "cmocka_test.h"
#include "effort.h"
#include "random.h"

enum { FULL_RAYS = 40000, TURNS = 3 };

struct cost {
  size_t count, room, grazing, all_grazing;
  double *times; /* seconds */
  struct ray worst;
  double slowest;
};

static void time_ray(struct cost *cost, struct tracer *tracer, const struct ray *ray)
{
  double least = INFINITY;
  struct hit hit;
  for (int n = 0; n < TURNS; n++) {
    const double start = clock_seconds(CLOCK_THREAD_CPUTIME_ID);
    tracer_closest(tracer, 1, ray, &hit);
    least = fmin(least, clock_seconds(CLOCK_THREAD_CPUTIME_ID) - start);
  }
  if (cost->count == cost->room) {
    cost->room = cost->room ? 2 * cost->room : 1024;
    cost->times = realloc(cost->times, cost->room * sizeof *cost->times);
    if (!cost->times) abort();
  }
  cost->times[cost->count++] = least;
  cost->grazing += hit.certainty != CERTAINTY_CERTAIN;
  struct hit_list list;
  assert_int_equal(tracer_all(tracer, 1, ray, &list), STATUS_OK);
  cost->all_grazing += list.certainty != CERTAINTY_CERTAIN;
  if (least > cost->slowest) cost->slowest = least, cost->worst = *ray;
}

static void cost_print(struct cost *cost, const char *name, const char *kind)
{
  if (cost->count == 0) return;
  sort_numbers(cost->times, cost->count);
  printf("%s, %s: %zu rays, median %.1f, 99 %% %.1f, worst %.1f us, %.1f %% grazing, %.1f %% of all hits\n", name, kind,
         cost->count, 1e6 * cost->times[cost->count / 2], 1e6 * cost->times[cost->count - 1 - cost->count / 100],
         1e6 * cost->times[cost->count - 1], 100 * (double)cost->grazing / (double)cost->count,
         100 * (double)cost->all_grazing / (double)cost->count);
  if (getenv("PSCN_SHOW")) print_ray(&cost->worst);
  fflush(stdout);
  free(cost->times);
}

/* ---- classes ---- */

static void ask(const char *name, const struct situation *s, size_t most, void *cost)
{
  (void)name;
  struct trial trial;
  trial_create(&trial, (const double(*)[4][4][3])s->P, s->count, NULL);
  for (size_t n = 0; n < most; n++) time_ray(cost, trial.tracer, &s->rays[n]);
  trial_destroy(&trial);
}

static void classes(void **state)
{
  (void)state;
  for (size_t n = 0; n < every_class_count(); n++) {
    const struct situation_class *class = every_class_at(n);
    struct cost cost = {0};
    if (!class_wanted(class)) continue;
    class_ask_rays(class, FULL_RAYS, 16, effort_seed(class->seed), ask, &cost);
    cost_print(&cost, "class", class->name);
  }
}

/* ---- scenes ---- */

enum kind { TANGENT, EDGE, CORNER, KINDS };
static const char *const kind_names[KINDS] = {"tangent", "edge", "corner or pole"};

static void aim(struct random *random, const struct scene *scene, enum kind kind, double size, struct ray *ray)
{
  const double(*P)[4][3] = (const double(*)[4][3])scene->patches[choose(random, scene->patch_count)].P;
  double u = random_unit(random), v = random_unit(random), at[3], du[3], dv[3], d[3];
  if (kind == EDGE) *(choose(random, 2) ? &u : &v) = (double)choose(random, 2);
  if (kind == CORNER) u = (double)choose(random, 2), v = (double)choose(random, 2);
  net_point(P, u, v, at);
  net_tangents(P, u, v, du, dv);
  random_vector(random, 1, d);
  const double along = random_between(random, -1, 1), across = random_between(random, -1, 1);
  if (kind == TANGENT)
    for (int axis = 0; axis < 3; axis++) d[axis] = along * du[axis] + across * dv[axis];
  const double length = sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]), back = size * random_between(random, 0.01, 3);
  double origin[3];
  for (int axis = 0; axis < 3; axis++) origin[axis] = at[axis] - d[axis] / length * back;
  ray_between(origin, at, ray);
}

static const char *scene_name;

static void scene_rays(void **state)
{
  (void)state;
  struct scene *scene = trial_load(scene_name, NULL, 800, 600);
  assert_non_null(scene);
  struct trial trial;
  trial_of_scene(&trial, scene);
  struct random random = {.state = effort_seed(900)};
  double size = 0;
  for (size_t n = 0; n < scene->patch_count; n++) {
    double most = 0;
    for (int k = 0; k < 16; k++)
      for (int axis = 0; axis < 3; axis++)
        most = fmax(most, fabs(scene->patches[n].P[k / 4][k % 4][axis] - scene->patches[n].P[0][0][axis]));
    size = n == 0 ? most : fmin(size, most);
  }
  for (enum kind kind = 0; kind < KINDS; kind++) {
    struct cost cost = {0};
    for (size_t n = 0; n < effort_count(FULL_RAYS, 64); n++) {
      struct ray ray;
      aim(&random, scene, kind, size, &ray);
      time_ray(&cost, trial.tracer, &ray);
    }
    cost_print(&cost, scene_name, kind_names[kind]);
  }
  trial_destroy(&trial);
  scene_destroy(scene);
}

int main(int argc, char **argv)
{
  const struct CMUnitTest all[] = {cmocka_unit_test(classes)}, one[] = {cmocka_unit_test(scene_rays)};
  int failed = argc > 1 ? 0 : cmocka_run_group_tests_name("costs", all, NULL, NULL);
  for (int n = 1; n < argc; n++) {
    scene_name = argv[n];
    failed |= cmocka_run_group_tests_name(argv[n], one, NULL, NULL);
  }
  return failed;
}
