/* Generators of situations with rays round every special feature of a surface, of every radius from 1e-18 to 1, and the
 * pieces that they share with others of hostile.h. */
#ifndef TESTS_ACCURACY_RINGS_H
#define TESTS_ACCURACY_RINGS_H

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

/* ---- generators ---- */

void ring_poles(struct random *random, size_t index, struct situation *s);
void ring_edges(struct random *random, size_t index, struct situation *s);
void ring_corners(struct random *random, size_t index, struct situation *s);
void ring_leaves(struct random *random, size_t index, struct situation *s);
void ring_cusps(struct random *random, size_t index, struct situation *s);
void ring_rulings(struct random *random, size_t index, struct situation *s);
void ring_tangencies(struct random *random, size_t index, struct situation *s);
void ring_unbent_tangents(struct random *random, size_t index, struct situation *s);
void ring_creases(struct random *random, size_t index, struct situation *s);
void ring_open_borders(struct random *random, size_t index, struct situation *s);

#endif
