/* A scene: little more than its lifetime; src/language builds it. */
#include "scene/scene.h"

void scene_override_solver(struct scene *scene, const struct method *method)
{
  for (size_t i = 0; i < scene->solver_count; i++) scene->solvers[i] = *method;
}

void scene_destroy(struct scene *scene)
{
  /* The scene itself lies in its arena. */
  if (scene) arena_destroy(scene->arena);
}
