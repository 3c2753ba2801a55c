/* `pscn trace --explain`: the story of a ray, as text. */
#ifndef PSCN_COMMAND_EXPLAIN_H
#define PSCN_COMMAND_EXPLAIN_H

#include <stddef.h>

#include "intersect/intersect.h"
#include "scene/scene.h"

/* Traces ray `number`, whose direction may have any length, and prints its story to stdout. */
void explain_ray(const struct scene *scene, struct tracer *tracer, size_t number, const struct ray *ray);

#endif
