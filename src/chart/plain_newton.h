/* The baseline of the chart: only Newton's method in two dimensions on the surface, from the middle of every part of a
 * patch whose box the ray meets, one ray a lane as in the renderer. It has no resultant, no proof and no second try:
 * what it does not find is lost. Never a way to render. */
#ifndef PSCN_CHART_PLAIN_NEWTON_H
#define PSCN_CHART_PLAIN_NEWTON_H

#include "chart/judge.h"
#include "chart/measure.h"

struct plain_newton;

enum { PLAIN_NEWTON_SPLIT = 8 }; /* each patch is cut into this many parts a side */

/* Borrows scene and rays[RAY_KINDS]. NULL if memory is short. */
struct plain_newton *plain_newton_create(const struct scene *scene, const struct ray_list *rays);
void plain_newton_destroy(struct plain_newton *plain);
struct runner plain_newton_face(struct plain_newton *plain);

#endif
