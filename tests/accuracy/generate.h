/* Pieces shared by the generators of situations. */
#ifndef TESTS_ACCURACY_GENERATE_H
#define TESTS_ACCURACY_GENERATE_H

#include <math.h>
#include <stddef.h>

#include "intersect/intersect.h"
#include "random.h"

/* A nearly regular net over [-1.5,1.5]^2 with heights of +-`height`. */
static inline void gentle(struct random *random, double height, double P[4][4][3])
{
  for (int i = 0; i < 4; i++) {
    for (int j = 0; j < 4; j++) {
      P[i][j][0] = i - 1.5 + 0.2 * random_between(random, -1, 1);
      P[i][j][1] = j - 1.5 + 0.2 * random_between(random, -1, 1);
      P[i][j][2] = height * random_between(random, -1, 1);
    }
  }
}

/* `origin` may be the ray's own. */
static inline void ray_between(const double origin[3], const double target[3], struct ray *ray)
{
  for (int axis = 0; axis < 3; axis++) {
    ray->direction[axis] = target[axis] - origin[axis];
    ray->origin[axis] = origin[axis];
  }
  ray->t_min = 0;
  ray->t_max = INFINITY;
}

static inline void random_vector(struct random *random, double size, double out[3])
{
  for (int axis = 0; axis < 3; axis++) out[axis] = size * random_between(random, -1, 1);
}

static inline size_t choose(struct random *random, size_t count) { return (size_t)(random_bits(random) % count); }

/* 10^-k for a whole k in [first, last]. */
static inline double random_decade(struct random *random, int first, int last)
{
  return pow(10, -(double)(first + (int)choose(random, (size_t)(last - first + 1))));
}

static inline void random_direction(struct random *random, double out[3])
{
  random_vector(random, 1, out);
  if (choose(random, 4) == 0) { /* along an axis, or in a plane of two */
    const size_t axis = choose(random, 3);
    out[axis] = 0;
    if (choose(random, 2)) out[(axis + 1) % 3] = 0;
  }
  if (out[0] == 0 && out[1] == 0 && out[2] == 0) out[0] = 1;
}

/* 10^-k, where k counts with the index. */
static inline double decade(size_t index, int first, int last)
{
  return pow(10, -(double)(first + (int)(index % (size_t)(last - first + 1))));
}

#endif
