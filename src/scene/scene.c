/* A scene: little more than its lifetime; src/language builds it. */
#include "scene/scene.h"

void scene_override_solver(struct scene *scene, const struct method *method)
{
  scene->solvers[0] = *method;
  scene->solver_count = 1;
  for (size_t i = 0; i < scene->patch_count; i++) scene->patches[i].solver = 0;
}

void scene_destroy(struct scene *scene)
{
  /* The scene itself lies in its arena. */
  if (scene) arena_destroy(scene->arena);
}
