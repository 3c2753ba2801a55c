/* Generators of situations on both sides of the intersector's thresholds for how to treat a patch or ray: lengths of
 * directions, degrees, leaves, sizes within one scene. See hostile.h. */
#ifndef TESTS_ACCURACY_THRESHOLDS_H
#define TESTS_ACCURACY_THRESHOLDS_H

#include "accuracy/situations.h"

void threshold_directions(struct random *random, size_t index, struct situation *s);
void threshold_degrees(struct random *random, size_t index, struct situation *s);
void threshold_random_nets(struct random *random, size_t index, struct situation *s);
void threshold_turned(struct random *random, size_t index, struct situation *s);
void threshold_scaled_lattice(struct random *random, size_t index, struct situation *s);
void threshold_large_and_small(struct random *random, size_t index, struct situation *s);
void threshold_cycles(struct random *random, size_t index, struct situation *s); /* of cycle_nets.h */

/* A ray through a point of the patch or up to `size` beside it, from about `size` away. The point is exactly at a
 * corner or border, or anywhere. */
void threshold_aim(struct random *random, const double P[4][4][3], double size, struct ray *ray);

#endif
