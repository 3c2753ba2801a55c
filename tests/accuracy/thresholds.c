/* Situations on both sides of the intersector's thresholds. */
#include "accuracy/generators.h"

#include <math.h>
#include <string.h>

#include "accuracy/cycle_nets.h"

enum { RAYS = SITUATION_RAYS };

typedef const double (*net)[4][3];

void threshold_aim(struct random *random, const double P[4][4][3], double size, struct ray *ray)
{
  double at[3], d[3];
  const double u = choose(random, 4) ? random_unit(random) : (double)choose(random, 3) / 2;
  const double v = choose(random, 4) ? random_unit(random) : (double)choose(random, 3) / 2;
  net_point(P, u, v, at);
  random_direction(random, d);
  const double off = choose(random, 2) ? size * random_decade(random, 0, 17) : 0, back = random_between(random, 0.5, 8);
  for (int axis = 0; axis < 3; axis++) at[axis] += off * random_between(random, -1, 1) - back * size * d[axis];
  ray_along(at, d, ray);
}

static void aim(struct random *random, const struct situation *s, double size, struct ray *ray)
{
  threshold_aim(random, (net)s->P[choose(random, s->count)], size, ray);
}

static void aim_all(struct random *random, double size, struct situation *s)
{
  for (int n = 0; n < RAYS; n++) aim(random, s, size, &s->rays[n]);
}

/* The lengths at which directions are taken for short or long (packet.c, view.h), and what a float can not hold. */
void threshold_directions(struct random *random, size_t index, struct situation *s)
{
  static const int limits[] = {16, -16, 80, -80, 40, -40, 127, -127, 300, -300};
  s->count = 1 + index % 2;
  for (size_t n = 0; n < s->count; n++) gentle(random, 1.5, s->P[n]);
  aim_all(random, 1, s);
  for (int n = 0; n < RAYS; n++) {
    const int limit = limits[choose(random, sizeof limits / sizeof limits[0])];
    const int power = choose(random, 2) ? limit + (int)choose(random, 5) - 2 : (int)choose(random, 600) - 300;
    double *d = s->rays[n].direction;
    if (choose(random, 3) == 0) d[choose(random, 3)] *= ldexp(1, -(int)choose(random, 200));
    for (int axis = 0; axis < 3; axis++) d[axis] = ldexp(d[axis], power);
  }
}

/* A net of degree `degree` in both parameters, raised to 3, with this much noise. */
static void raised(struct random *random, int degree, double noise, double P[4][4][3])
{
  for (int i = 0; i <= degree; i++)
    for (int j = 0; j <= degree; j++) {
      random_vector(random, 1, P[i][j]);
      P[i][j][0] += 3.0 * i / degree, P[i][j][1] += 3.0 * j / degree;
    }
  raise_net(degree, P);
  for (int k = 0; k < 16; k++)
    for (int axis = 0; axis < 3; axis++) P[k / 4][k % 4][axis] += noise * random_between(random, -1, 1);
}

/* Of degree 1 or 2 but for some noise, so that a degree is just seen, or not; and leaves that are nearly bilinear. */
void threshold_degrees(struct random *random, size_t index, struct situation *s)
{
  s->count = 1 + index % 2;
  for (size_t n = 0; n < s->count; n++)
    raised(random, 1 + (int)choose(random, 2), choose(random, 6) ? random_decade(random, 1, 17) : 0, s->P[n]);
  aim_all(random, 3, s);
}

/* Points anywhere: many roots, folds and turns. */
void threshold_random_nets(struct random *random, size_t index, struct situation *s)
{
  s->count = 1 + index % 3;
  const double size = index % 2 ? 1 : random_decade(random, -12, 12);
  for (size_t n = 0; n < s->count; n++)
    for (int k = 0; k < 16; k++) random_vector(random, size, s->P[n][k / 4][k % 4]);
  aim_all(random, size, s);
}

/* A patch, and itself with parameters turned round or exchanged, moved by nothing or by a little. */
void threshold_turned(struct random *random, size_t index, struct situation *s)
{
  s->count = 2;
  gentle(random, 1, s->P[0]);
  in_order(s->P[0], (int)(index % 8), s->P[1]);
  const double off = choose(random, 2) ? random_decade(random, 1, 17) : 0;
  for (int k = 0; k < 16; k++) s->P[1][k / 4][k % 4][2] += off;
  aim_all(random, 1, s);
}

/* Small whole numbers in another unit, and from another origin: all as exact as they were. */
void threshold_scaled_lattice(struct random *random, size_t index, struct situation *s)
{
  lattice(random, index, s);
  const int power = (int)choose(random, 400) - 200, turn = (int)choose(random, 60) - 30;
  double shift[3];
  for (int axis = 0; axis < 3; axis++) shift[axis] = choose(random, 2) ? ldexp(1, (int)choose(random, 30)) : 0;
  for (size_t n = 0; n < s->count; n++)
    for (int k = 0; k < 16; k++)
      for (int axis = 0; axis < 3; axis++)
        s->P[n][k / 4][k % 4][axis] = ldexp(s->P[n][k / 4][k % 4][axis] + shift[axis], power);
  for (int n = 0; n < RAYS; n++) {
    for (int axis = 0; axis < 3; axis++) {
      s->rays[n].origin[axis] = ldexp(s->rays[n].origin[axis] + shift[axis], power);
      s->rays[n].direction[axis] = ldexp(s->rays[n].direction[axis], power + turn);
    }
  }
}

/* Small patches on and over a large one: the boxes of all are those of one frame. */
void threshold_large_and_small(struct random *random, size_t index, struct situation *s)
{
  s->count = 2 + index % 4;
  const double large = random_decade(random, -12, -1);
  gentle(random, choose(random, 2) ? 0 : 0.1, s->P[0]);
  for (int k = 0; k < 16; k++)
    for (int axis = 0; axis < 3; axis++) s->P[0][k / 4][k % 4][axis] *= large;
  for (size_t n = 1; n < s->count; n++) {
    double middle[3];
    situation_point(s, 0, random_unit(random), random_unit(random), middle);
    if (choose(random, 2)) memset(middle, 0, sizeof middle);
    gentle(random, 1, s->P[n]);
    for (int k = 0; k < 16; k++)
      for (int axis = 0; axis < 3; axis++)
        s->P[n][k / 4][k % 4][axis] += middle[axis] + (axis == 2 && choose(random, 2) ? 1 : 0);
  }
  for (int n = 0; n < RAYS; n++) aim(random, s, choose(random, 2) ? 1 : large, &s->rays[n]);
}

void threshold_cycles(struct random *random, size_t index, struct situation *s)
{
  struct cycle cycle;
  cycle_make(index % cycle_shape_count(), random, &cycle);
  s->count = cycle.count;
  memcpy(s->P, cycle.P, cycle.count * sizeof cycle.P[0]);
  double size = 0;
  for (size_t k = 3; k < 48 * cycle.count; k++)
    size = fmax(size, fabs(s->P[k / 48][k / 12 % 4][k / 3 % 4][k % 3] - s->P[0][0][0][k % 3]));
  aim_all(random, size, s);
}
