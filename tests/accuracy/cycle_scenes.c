/* See cycle_scenes.h. */
#include "accuracy/cycle_scenes.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "accuracy/generate.h"
#include "cmocka_test.h"

/* The least numbers of patches with shared leaves of copies, and with no leaves kept. */
enum { COPIED = 1100, UNKEPT = 66000, SPLITS = 16 };

/* The distance between surfaces of a crowd, in their size. */
#define APART 8

static void *room(size_t count, size_t size)
{
  void *made = calloc(count, size);
  assert_non_null(made);
  return made;
}

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
  scene->patches = room(cycle.count, sizeof *scene->patches),
  scene->solvers = room(cycle.count, sizeof *scene->solvers);
  const bool mixed = choose(random, 2);
  for (size_t n = 0; n < cycle.count; n++) {
    memcpy(scene->patches[n].P, cycle.P[n], sizeof cycle.P[n]);
    scene->patches[n].solver = mixed ? (uint32_t)n : 0;
    method_default(solver_at(mixed && choose(random, 3) == 0 ? choose(random, solver_count()) : 0), &scene->solvers[n]);
    if (choose(random, 3) == 0) scene->solvers[n].split = 1 + (int)choose(random, SPLITS);
  }
  prepare(out);
}

static void random_map(struct random *random, double apart, struct scene_copy *out)
{
  const double size = random_decade(random, 0, 2);
  for (int i = 0; i < 3; i++) {
    for (int j = 0; j < 3; j++) out->A[i][j] = size * random_between(random, -1, 1);
    out->b[i] = apart * random_between(random, -1, 1);
  }
}

static void moved(const struct scene_copy *copy, double P[4][4][3], double out[4][4][3])
{
  for (int n = 0; n < 48; n++) {
    const double *p = P[n / 12][n / 3 % 4];
    out[n / 12][n / 3 % 4][n % 3] = p[0] * copy->A[0][n % 3] + p[1] * copy->A[1][n % 3] + p[2] * copy->A[2][n % 3] +
                                    copy->b[n % 3];
  }
}

void cycle_crowd_create(size_t shape, bool copied, struct random *random, struct cycle_scene *out)
{
  struct cycle cycle;
  memset(out, 0, sizeof *out);
  cycle_make(shape, random, &cycle);
  const size_t copies = (copied ? COPIED : UNKEPT) / cycle.count + 1;
  struct scene *scene = &out->scene;
  scene->patch_count = copies * cycle.count, scene->solver_count = 1;
  scene->patches = room(scene->patch_count, sizeof *scene->patches), scene->solvers = room(1, sizeof *scene->solvers);
  method_default(solver_at(0), scene->solvers);
  out->object = (struct scene_object){room(cycle.count, sizeof cycle.P[0]), cycle.count};
  memcpy(out->object.P, cycle.P, cycle.count * sizeof cycle.P[0]);
  scene->objects = &out->object, scene->copies = room(copies, sizeof *scene->copies);
  if (copied) scene->object_count = 1, scene->copy_count = copies;
  double reach = 0;
  for (size_t k = 0; k < 48 * cycle.count; k++)
    reach = fmax(reach, fabs(cycle.P[k / 48][k / 12 % 4][k / 3 % 4][k % 3]));
  for (size_t n = 0; n < copies; n++) {
    struct scene_copy *copy = &scene->copies[n];
    random_map(random, APART * reach, copy);
    copy->first_patch = n * cycle.count;
    for (size_t p = 0; p < cycle.count; p++) moved(copy, out->object.P[p], scene->patches[copy->first_patch + p].P);
  }
  prepare(out);
}

void cycle_scene_destroy(struct cycle_scene *scene)
{
  tracer_destroy(scene->tracer);
  intersector_destroy(scene->intersector);
  free(scene->scene.patches), free(scene->scene.solvers), free(scene->scene.copies), free(scene->object.P);
}
