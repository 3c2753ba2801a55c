/* A scene: little more than its lifetime. src/language builds it. */
#include "scene/scene.h"

void scene_override_solver(struct scene *scene, const struct method *method)
{
  scene->solvers[0] = *method;
  scene->solver_count = 1;
  for (size_t i = 0; i < scene->patch_count; i++) scene->patches[i].solver = 0;
}

bool scene_starts_warm(const struct scene *scene)
{
  for (size_t k = 0; k < scene->solver_count; k++)
    if (scene->solvers[k].roots.start == START_PREVIOUS) return true;
  return false;
}

void scene_destroy(struct scene *scene)
{
  /* The scene itself is in its arena. */
  if (scene) arena_destroy(scene->arena);
}
