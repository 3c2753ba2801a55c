/* Generators of situations on both sides of what decides how the intersector goes about a patch or a ray: lengths of directions,
 * degrees, leaves, sizes within one scene. See hostile.h.
 */
#ifndef TESTS_ACCURACY_THRESHOLDS_H
#define TESTS_ACCURACY_THRESHOLDS_H

#include "accuracy/situations.h"

void threshold_directions(struct random *random, size_t index, struct situation *s);
void threshold_degrees(struct random *random, size_t index, struct situation *s);
void threshold_random_nets(struct random *random, size_t index, struct situation *s);
void threshold_turned(struct random *random, size_t index, struct situation *s);
void threshold_scaled_lattice(struct random *random, size_t index, struct situation *s);
void threshold_large_and_small(struct random *random, size_t index, struct situation *s);

#endif
