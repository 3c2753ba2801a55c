/* Scenes of the closed surfaces of cycle_nets.h, prepared, with a tracer.
 */
#ifndef TESTS_ACCURACY_CYCLE_SCENES_H
#define TESTS_ACCURACY_CYCLE_SCENES_H

#include <stdbool.h>

#include "accuracy/cycle_nets.h"
#include "intersect/intersect.h"

struct cycle_scene {
  struct scene scene;
  struct method solvers[CYCLE_MOST];
  struct scene_object object;
  double P[CYCLE_MOST][4][4][3]; /* the object's */
  struct intersector *intersector;
  struct tracer *tracer;
  double middle[3], size; /* all control points are closer than size to the middle */
};

/* One surface. Each patch has a solver and a split of its own, or all have the default. */
void cycle_scene_create(size_t shape, struct random *random, struct cycle_scene *out);

/* Many instances of one surface, turned, skew, long and short, crossing each other. There are so many patches that
 * copies share their leaves, if they are declared as `copied`, or else that neither patches nor leaves are kept. The
 * shape must be one that moves. */
void cycle_crowd_create(size_t shape, bool copied, struct random *random, struct cycle_scene *out);

void cycle_scene_destroy(struct cycle_scene *scene);

#endif
