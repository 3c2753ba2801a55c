/* Primary rays of a perspective camera. */
#include "render/camera.h"

#include <math.h>

void camera_ray(const struct scene_camera *camera, double s, double t, struct ray *out)
{
  for (int k = 0; k < 3; k++) {
    out->origin[k] = camera->location[k];
    out->direction[k] = camera->direction[k] + (s - 0.5) * camera->right[k] + (0.5 - t) * camera->up[k];
  }
  out->t_min = 0;
  out->t_max = INFINITY;
}
