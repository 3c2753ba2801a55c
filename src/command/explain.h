/* `pscn trace --explain`: what becomes of a ray, as text. */
#ifndef PSCN_COMMAND_EXPLAIN_H
#define PSCN_COMMAND_EXPLAIN_H

#include <stddef.h>

#include "intersect/intersect.h"
#include "scene/scene.h"

/* Traces the ray of that number, with a direction of any length, and tells its story on stdout. */
void explain_ray(const struct scene *scene, struct tracer *tracer, size_t number, const struct ray *ray);

#endif
