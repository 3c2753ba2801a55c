/* Scenes of copies of an object. */
#ifndef TESTS_COPIED_H
#define TESTS_COPIED_H

#include <stdlib.h>

#include "cmocka_test.h"
#include "random.h"
#include "scene/scene.h"

/* out = net A + b, each coordinate rounded once. */
static inline void copied_net(const struct scene_copy *copy, double P[4][4][3], double out[4][4][3])
{
  for (int n = 0; n < 48; n++) {
    long double x = copy->b[n % 3];
    for (int i = 0; i < 3; i++) x += (long double)P[n / 12][n / 3 % 4][i] * copy->A[i][n % 3];
    out[n / 12][n / 3 % 4][n % 3] = (double)x;
  }
}

/* Any affine map: turned, skew, mirrored. */
static inline void copied_anyhow(struct random *random, double size, double apart, struct scene_copy *out)
{
  for (int i = 0; i < 3; i++) {
    for (int j = 0; j < 3; j++) out->A[i][j] = size * random_between(random, -1, 1);
    out->b[i] = apart * random_between(random, -1, 1);
  }
}

/* Gives the scene `count` copies of the object, which is borrowed, all where it is itself. */
static inline void copied_open(struct scene *scene, struct scene_object *object, size_t count)
{
  scene->objects = object, scene->object_count = 1;
  scene->copy_count = count, scene->copies = calloc(count, sizeof *scene->copies);
  scene->patch_count = count * object->patch_count;
  scene->patches = calloc(scene->patch_count, sizeof *scene->patches);
  assert_non_null(scene->copies);
  assert_non_null(scene->patches);
  for (size_t c = 0; c < count; c++)
    scene->copies[c] = (struct scene_copy){.first_patch = c * object->patch_count,
                                           .A = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
}

/* Makes the patches, once the maps are set. */
static inline void copied_place(struct scene *scene)
{
  for (size_t p = 0; p < scene->patch_count; p++) {
    const size_t count = scene->objects->patch_count;
    copied_net(&scene->copies[p / count], scene->objects->P[p % count], scene->patches[p].P);
  }
}

static inline void copied_close(struct scene *scene) { free(scene->copies), free(scene->patches); }

#endif
