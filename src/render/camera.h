/* Primary rays of a perspective camera. */
#ifndef PSCN_RENDER_CAMERA_H
#define PSCN_RENDER_CAMERA_H

#include <math.h>

#include "intersect/intersect.h"
#include "scene/scene.h"

/* The ray through the point (s,t) of the picture, s and t in [0,1] from the left and the top edge. Its direction is not
 * normalised. */
static inline void camera_ray(const struct scene_camera *camera, double s, double t, struct ray *out)
{
  for (int k = 0; k < 3; k++) {
    out->origin[k] = camera->location[k];
    out->direction[k] = camera->direction[k] + (s - 0.5) * camera->right[k] + (0.5 - t) * camera->up[k];
  }
  out->t_min = 0;
  out->t_max = INFINITY;
}

#endif
