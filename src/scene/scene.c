/* A scene: little more than its lifetime, and the space of its colours. src/language builds it. */
#include "scene/scene.h"

#include <float.h>
#include <math.h>

#include "base/srgb.h"

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

double gamma_to_light(double gamma, double part)
{
  const double size = fabs(part), light = gamma == GAMMA_SRGB ? srgb_decode(size) : pow(size, gamma);
  return copysign(fmin(light, FLT_MAX), part);
}

double gamma_of_srgb(double gamma, double code)
{
  return gamma == GAMMA_SRGB ? code : pow(srgb_decode(code), 1 / gamma);
}
