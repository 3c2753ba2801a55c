/* Primary rays. */
#ifndef PSCN_RENDER_CAMERA_H
#define PSCN_RENDER_CAMERA_H

#include "intersect/intersect.h"
#include "scene/scene.h"

/* The ray through the point (s,t) of the picture, s and t in [0,1] from the left and the top edge. Its direction is not
 * normalised. */
void camera_ray(const struct scene_camera *camera, double s, double t, struct ray *out);

#endif
