/* Pieces shared by the generators of situations. */
#ifndef TESTS_ACCURACY_GENERATE_H
#define TESTS_ACCURACY_GENERATE_H

#include <math.h>
#include <stddef.h>
#include <string.h>

#include "intersect/intersect.h"
#include "net_order.h"
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

/* u and v exchanged. */
static inline void transpose(double P[4][4][3])
{
  double old[4][4][3];
  memcpy(old, P, sizeof old);
  in_order(old, 1, P);
}

/* Raises a net of degree 1 or 2 in both parameters to degree 3. This is exact for multiples of 9. */
static inline void raise_net(int degree, double P[4][4][3])
{
  for (int own = degree; own < 3; own++) { /* from degree `own` to own + 1 */
    for (int way = 0; way < 2; way++) {
      for (int n = 0; n <= own + way; n++)
        for (int i = own + 1; i >= 0; i--)
          for (int axis = 0; axis < 3; axis++)
            P[i][n][axis] = ((i ? i * P[i - 1][n][axis] : 0) + (i <= own ? (own + 1 - i) * P[i][n][axis] : 0)) /
                            (own + 1);
      transpose(P);
    }
  }
}

static inline void ray_along(const double origin[3], const double direction[3], struct ray *ray)
{
  *ray = (struct ray){.t_max = INFINITY};
  for (int axis = 0; axis < 3; axis++) ray->origin[axis] = origin[axis], ray->direction[axis] = direction[axis];
}

/* `origin` may be the ray's own. */
static inline void ray_between(const double origin[3], const double target[3], struct ray *ray)
{
  const double from[3] = {origin[0], origin[1], origin[2]};
  ray_along(from, target, ray);
  for (int axis = 0; axis < 3; axis++) ray->direction[axis] -= from[axis];
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
