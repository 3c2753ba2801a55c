/* Nets and rays of small whole numbers. */
#include "accuracy/generators.h"

#include <math.h>
#include <string.h>

enum { RAYS = SITUATION_RAYS, PATCHES = 8 };

typedef double net[4][4][3];

static double whole(struct random *random, int most)
{
  return (double)((int)choose(random, 2 * (size_t)most + 1) - most);
}

static void whole_point(struct random *random, int most, double out[3])
{
  for (int axis = 0; axis < 3; axis++) out[axis] = whole(random, most);
}

static void any(struct random *random, int most, net P)
{
  for (int k = 0; k < 16; k++) whole_point(random, most, P[k / 4][k % 4]);
}

/* Heights over a square; `most` 0: flat. */
static void heights(struct random *random, int most, net P)
{
  for (int i = 0; i < 4; i++)
    for (int j = 0; j < 4; j++) P[i][j][0] = j, P[i][j][1] = i, P[i][j][2] = whole(random, most);
}

static void collapsed(struct random *random, int most, net P)
{
  heights(random, most, P);
  for (int row = 0; row < 4; row += 3) {
    if (row && choose(random, 3)) break;
    double pole[3];
    whole_point(random, most, pole);
    for (int j = 0; j < 4; j++) memcpy(P[row][j], pole, sizeof pole);
  }
}

/* The same from the left and from the right, from above and from below. */
static void bowl(struct random *random, int most, net P)
{
  static const double parabola[4] = {3, -1, -1, 3}, other[3][4] = {{0, 0, 0, 0}, {3, -1, -1, 3}, {1, 0, 0, 1}};
  const double *across = other[choose(random, 3)];
  heights(random, most, P);
  for (int i = 0; i < 4; i++)
    for (int j = 0; j < 4; j++) P[i][j][2] = parabola[i] + across[j];
}

static void ruled(struct random *random, int most, net P)
{
  for (int j = 0; j < 4; j++) {
    double from[3], to[3];
    whole_point(random, most, from), whole_point(random, most, to);
    for (int i = 0; i < 4; i++)
      for (int axis = 0; axis < 3; axis++) P[i][j][axis] = 3 * from[axis] + i * (to[axis] - from[axis]);
  }
}

/* A net of only three different points. */
static void doubled(struct random *random, int most, net P)
{
  double point[3][3];
  for (int k = 0; k < 3; k++) whole_point(random, most, point[k]);
  for (int k = 0; k < 16; k++) memcpy(P[k / 4][k % 4], point[choose(random, 3)], sizeof point[0]);
}

static void patch(struct random *random, net P)
{
  static void (*const kinds[])(struct random * random, int most, net P) = {any,  any,   heights, collapsed,
                                                                           bowl, ruled, doubled};
  const int most = 1 + (int)choose(random, 3);
  const size_t kind = choose(random, 1 + sizeof kinds / sizeof kinds[0]);
  if (kind == sizeof kinds / sizeof kinds[0]) heights(random, 0, P);
  else kinds[kind](random, most, P);
}

/* Continues where `before` ends, sometimes without a crease. */
static void join(struct random *random, const net before, net P)
{
  const bool smooth = choose(random, 2);
  for (int j = 0; j < 4; j++) {
    for (int axis = 0; axis < 3; axis++) {
      P[0][j][axis] = before[3][j][axis];
      if (smooth) P[1][j][axis] = 2 * before[3][j][axis] - before[2][j][axis];
    }
  }
}

static double parameter(struct random *random)
{
  const size_t eighths = choose(random, 12);
  return eighths <= 8 ? (double)eighths / 8 : random_unit(random);
}

static void some_point(struct random *random, const struct situation *s, double out[3])
{
  net_point(s->P[choose(random, s->count)], parameter(random), parameter(random), out);
}

static void aim(struct random *random, const struct situation *s, struct ray *ray)
{
  static const double back[] = {0, 0.5, 1, 2, 4, 8};
  double at[3], to[3];
  some_point(random, s, at), some_point(random, s, to);
  ray_between(at, to, ray);
  if (choose(random, 4))
    for (int axis = 0; axis < 3; axis++) ray->direction[axis] = whole(random, 2);
  if (ray->direction[0] == 0 && ray->direction[1] == 0 && ray->direction[2] == 0) ray->direction[2] = 1;
  const double way = back[choose(random, sizeof back / sizeof back[0])];
  for (int axis = 0; axis < 3; axis++) {
    ray->origin[axis] -= way * ray->direction[axis];
    if (choose(random, 8) == 0) ray->origin[axis] += ldexp(1, -20 - (int)choose(random, 50));
  }
  if (choose(random, 3)) return;
  for (int axis = 0; axis < 3; axis++) ray->origin[axis] = whole(random, 8) / 2;
}

void lattice(struct random *random, size_t index, struct situation *s)
{
  s->count = 1 + index % PATCHES;
  for (size_t n = 0; n < s->count; n++) {
    patch(random, s->P[n]);
    if (n > 0 && choose(random, 4) == 0) join(random, (const double(*)[4][3])s->P[n - 1], s->P[n]);
  }
  for (int n = 0; n < RAYS; n++) aim(random, s, &s->rays[n]);
}
