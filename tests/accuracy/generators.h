/* The generators of situations for the exact judge, which hostile.c lists, and the pieces that they share. */
#ifndef TESTS_ACCURACY_GENERATORS_H
#define TESTS_ACCURACY_GENERATORS_H

#include "accuracy/generate.h"
#include "accuracy/situations.h"

/* ---- pieces ---- */

/* How large patch 0 is. */
double situation_size(const struct situation *s);

/* 1e-18 ... 1 of `size`, and sometimes 0. */
double ring_radius(struct random *random, double size);

/* A ray in any direction that passes `at` at the distance `off`, and starts before it. */
void ray_round(struct random *random, const double at[3], double off, double size, struct ray *ray);

/* The patches become a closed model: as made, or turned, or with the point at (u,v) of patch 0 moved to the middle. */
void place_body(struct random *random, size_t index, double u, double v, struct situation *s);

/* As place_body, with a model that has poles: the row u = 0 of patch 0 is one. */
void place_pole(struct random *random, size_t index, struct situation *s);

/* A ray through a point of the patch or up to `size` beside it, from about `size` away. The point is exactly at a
 * corner or border, or anywhere. */
void threshold_aim(struct random *random, const double P[4][4][3], double size, struct ray *ray);

typedef void generator(struct random *random, size_t index, struct situation *s);

/* ---- rings.c: rays round every special feature of a surface, of every radius from 1e-18 to 1 ---- */

generator ring_poles, ring_edges, ring_corners, ring_leaves, ring_cusps, ring_rulings, ring_tangencies;
generator ring_unbent_tangents, ring_creases, ring_open_borders;

/* ---- extremes.c: at the limits of double: sizes of one patch many decades apart, starts so far away that a rounding
 * moves the ray by many patches ---- */

generator extreme_uneven_sizes, extreme_met_poles, extreme_far_origins, extreme_far_diagonal, extreme_far_oblique;
generator extreme_wild_sizes; /* beyond wide arithmetic's digits */

/* ---- thresholds.c: on both sides of the thresholds for how to treat a patch or ray: lengths of directions, degrees,
 * leaves, sizes within one scene ---- */

generator threshold_directions, threshold_degrees, threshold_random_nets, threshold_turned, threshold_scaled_lattice;
generator threshold_large_and_small, threshold_cycles; /* the last: of cycle_nets.h */

/* ---- lattice.c: everything that can coincide does. Control points, origins and directions are small whole numbers, so
 * rays meet corners and borders exactly, touch surfaces, and lie in them, several at once ---- */

generator lattice;

#endif
