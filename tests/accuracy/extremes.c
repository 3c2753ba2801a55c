/* Situations at the limits of double. */
#include "accuracy/generators.h"

#include <math.h>
#include <string.h>

#include "base/wide.h"

enum { RAYS = SITUATION_RAYS };

/* A patch long along one axis and short along another, by a factor from `thinnest` on; small beside its distance, or
 * with some coordinates up to 1e`farthest`; a far origin. */
static void uneven(struct random *random, size_t index, size_t thinnest, int farthest, struct situation *s)
{
  static const double factors[] = {1e-160, 1e-12, 1e-9, 1e-6, 1, 1, 1e6};
  s->count = 1;
  gentle(random, 1, s->P[0]);
  double factor[3], shift[3];
  for (int axis = 0; axis < 3; axis++) {
    factor[axis] = factors[thinnest + choose(random, 7 - thinnest)];
    shift[axis] = choose(random, 3) ? 0 : factor[axis] * random_decade(random, -6, 6) * random_between(random, -1, 1);
  }
  for (int k = 0; k < 48; k++) {
    double *at = &s->P[0][k / 12][k / 3 % 4][k % 3];
    *at = *at * factor[k % 3] + shift[k % 3];
  }
  for (int axis = 0; axis < 3 && index % 3 == 0; axis++) {
    double *at = &s->P[0][choose(random, 4)][choose(random, 4)][axis];
    *at = random_decade(random, -farthest, 0) * random_between(random, -1, 1);
  }
  for (int n = 0; n < RAYS; n++) {
    double at[3], d[3], away = choose(random, 3) ? 1 : random_decade(random, -9, 3);
    situation_point(s, 0, random_unit(random), random_unit(random), at);
    random_direction(random, d);
    for (int axis = 0; axis < 3; axis++) {
      d[axis] *= choose(random, 2) ? factor[axis] : 1;
      at[axis] -= away * d[axis];
    }
    ray_along(at, d, &s->rays[n]);
  }
}

void extreme_uneven_sizes(struct random *random, size_t index, struct situation *s) { uneven(random, index, 1, 12, s); }
void extreme_wild_sizes(struct random *random, size_t index, struct situation *s) { uneven(random, index, 0, 29, s); }

/* Rays past a pole, which is the origin, at 2^-50 ... 2^-150 of its patch. They start before it, next to it or behind
 * it, and go in any direction or along the surface there; some go through it. */
void extreme_met_poles(struct random *random, size_t index, struct situation *s)
{
  s->count = 1 + index % 2;
  for (size_t n = 0; n < s->count; n++) {
    double pole[3];
    gentle(random, 1, s->P[n]);
    memcpy(pole, s->P[n][0][0], sizeof pole);
    for (int k = 0; k < 48; k++)
      s->P[n][k / 12][k / 3 % 4][k % 3] = k < 12 ? 0 : s->P[n][k / 12][k / 3 % 4][k % 3] - pole[k % 3];
  }
  for (int n = 0; n < RAYS; n++) {
    double d[3], along[3];
    random_vector(random, 1, d);
    situation_point(s, (size_t)n % s->count, 1e-9, random_unit(random), along);
    if (choose(random, 3) == 0)
      for (int axis = 0; axis < 3; axis++)
        d[axis] = 1e9 * along[axis] + (choose(random, 2) ? random_decade(random, 3, 30) * d[axis] : 0);
    if (choose(random, 2)) d[choose(random, 3)] = 0;
    const double back = ldexp(choose(random, 4) ? 1 : -1, choose(random, 2) ? 1 : -(int)choose(random, 100));
    const double off = choose(random, 3) ? ldexp(1, -50 - (int)choose(random, 100)) : 0;
    for (int axis = 0; axis < 3; axis++) along[axis] = off * random_between(random, -1, 1) - back * d[axis];
    ray_along(along, d, &s->rays[n]);
  }
}

/* Rays from where doubles end. */
void extreme_far_origins(struct random *random, size_t index, struct situation *s)
{
  s->count = 1;
  gentle(random, 1, s->P[0]);
  for (int n = 0; n < RAYS; n++) {
    const double far = index % 2 ? 1.7e308 : pow(10, (double)choose(random, 300));
    const size_t axis = choose(random, 3);
    double at[3];
    situation_point(s, 0, random_unit(random), random_unit(random), at);
    s->rays[n] = (struct ray){.t_min = 0, .t_max = INFINITY};
    memcpy(s->rays[n].origin, at, sizeof at);
    const double sign = choose(random, 2) ? 1 : -1;
    s->rays[n].origin[axis] = -sign * far, s->rays[n].direction[axis] = sign;
    if (choose(random, 3) == 0)
      for (int k = 0; k < 3; k++) s->rays[n].direction[k] = at[k] / far - s->rays[n].origin[k] / far;
  }
}

/* A ray in any direction that starts so far from the patch, relative to its size, that a rounding of start or direction
 * would make it miss: the patch is placed where the ray happens to pass. The other rays mostly miss. */
void extreme_far_oblique(struct random *random, size_t index, struct situation *s)
{
  const double far = ldexp(random_between(random, 1, 2), (int)(44 + index % 36));
  double at[3], d[3];
  s->count = 1;
  gentle(random, choose(random, 2) ? 1 : 20, s->P[0]);
  const double u = choose(random, 2) ? random_unit(random) : 1 - random_decade(random, 4, 18);
  situation_point(s, 0, u, random_unit(random), at);
  for (int n = 0; n < RAYS; n++) {
    random_vector(random, 1, d);
    s->rays[n] = (struct ray){.t_min = 0, .t_max = INFINITY};
    for (int axis = 0; axis < 3; axis++) s->rays[n].direction[axis] = d[axis], s->rays[n].origin[axis] = -far * d[axis];
  }
  const struct ray *ray = &s->rays[0];
  for (int axis = 0; axis < 3; axis++) {
    const wide shift = (wide)ray->origin[axis] + (wide)far * ray->direction[axis] - at[axis];
    for (int k = 0; k < 16; k++) s->P[0][k / 4][k % 4][axis] += (double)shift;
  }
}

/* Rays exactly along a diagonal, from as far as each direction allows, through many patches one behind the other.
 * Double precision can exclude no leaf of any. */
void extreme_far_diagonal(struct random *random, size_t index, struct situation *s)
{
  s->count = 1 + index % MODEL_MOST_PATCHES;
  for (size_t n = 0; n < s->count; n++) {
    gentle(random, 1, s->P[n]);
    for (int k = 0; k < 16; k++)
      for (int axis = 0; axis < 3; axis++) s->P[n][k / 4][k % 4][axis] += 0.25 * (double)n - 2;
  }
  for (int n = 0; n < RAYS; n++) {
    const double far = ldexp(1, (int)(40 + 30 * (index % 7) + choose(random, 30)));
    const bool straight = choose(random, 4) != 0; /* along the line on which the patches stand */
    s->rays[n] = (struct ray){.t_min = 0, .t_max = INFINITY};
    for (int axis = 0; axis < 3; axis++) {
      const double sign = straight || choose(random, 2) ? 1 : -1;
      s->rays[n].direction[axis] = sign, s->rays[n].origin[axis] = -far * sign;
    }
  }
}
