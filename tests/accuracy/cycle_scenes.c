/* See cycle_scenes.h. */
#include "accuracy/cycle_scenes.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "accuracy/generate.h"
#include "cmocka_test.h"
#include "copied.h"

/* The least numbers of patches with shared leaves of copies, and with no leaves kept. */
enum { COPIED = 1100, UNKEPT = 66000, SPLITS = 16 };

/* The distance between surfaces of a crowd, in their size. */
#define APART 8

/* Makes intersector, tracer, middle and size. */
static void prepare(struct cycle_scene *out)
{
  assert_int_equal(intersector_create(&out->scene, &out->intersector), STATUS_OK);
  assert_int_equal(tracer_create(out->intersector, &out->tracer), STATUS_OK);
  for (int axis = 0; axis < 3; axis++) {
    double low = INFINITY, high = -INFINITY;
    for (size_t k = 0; k < 16 * out->scene.patch_count; k++) {
      const double x = out->scene.patches[k / 16].P[k / 4 % 4][k % 4][axis];
      low = fmin(low, x), high = fmax(high, x);
    }
    out->middle[axis] = low + (high - low) / 2, out->size += high - low;
  }
}

void cycle_scene_create(size_t shape, struct random *random, struct cycle_scene *out)
{
  struct cycle cycle;
  memset(out, 0, sizeof *out);
  cycle_make(shape, random, &cycle);
  struct scene *scene = &out->scene;
  scene->patch_count = scene->solver_count = cycle.count;
  scene->patches = calloc(cycle.count, sizeof *scene->patches);
  scene->solvers = out->solvers;
  assert_non_null(scene->patches);
  const bool mixed = choose(random, 2);
  for (size_t n = 0; n < cycle.count; n++) {
    memcpy(scene->patches[n].P, cycle.P[n], sizeof cycle.P[n]);
    scene->patches[n].solver = mixed ? (uint32_t)n : 0;
    method_default(solver_at(mixed && choose(random, 3) == 0 ? choose(random, solver_count()) : 0), &scene->solvers[n]);
    if (choose(random, 3) == 0) scene->solvers[n].split = 1 + (int)choose(random, SPLITS);
  }
  prepare(out);
}

void cycle_crowd_create(size_t shape, bool copied, struct random *random, struct cycle_scene *out)
{
  struct cycle cycle;
  memset(out, 0, sizeof *out);
  cycle_make(shape, random, &cycle);
  memcpy(out->P, cycle.P, sizeof out->P);
  out->object = (struct scene_object){out->P, cycle.count};
  struct scene *scene = &out->scene;
  scene->solvers = out->solvers, scene->solver_count = 1;
  method_default(solver_at(0), scene->solvers);
  copied_open(scene, &out->object, (copied ? COPIED : UNKEPT) / cycle.count + 1);
  double reach = 0;
  for (size_t k = 0; k < 48 * cycle.count; k++)
    reach = fmax(reach, fabs(cycle.P[k / 48][k / 12 % 4][k / 3 % 4][k % 3]));
  for (size_t n = 0; n < scene->copy_count; n++)
    copied_anyhow(random, random_decade(random, 0, 2), APART * reach, &scene->copies[n]);
  copied_place(scene);
  if (!copied) scene->object_count = scene->copy_count = 0;
  prepare(out);
}

void cycle_scene_destroy(struct cycle_scene *scene)
{
  tracer_destroy(scene->tracer);
  intersector_destroy(scene->intersector);
  copied_close(&scene->scene);
}
