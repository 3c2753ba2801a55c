/* Rays aimed at what the intersector treats apart; and the classes for the exact judge. */
#include "accuracy/generators.h"

#include <math.h>
#include <string.h>

enum { RAYS = SITUATION_RAYS };

/* One rounding of a number of size 1. */
#define ROUNDING 0x1p-53

/* ---- nets degenerate but for some roundings ---- */

enum degeneracy {
  ROW_IS_POINT,
  ALL_IS_LINE,
  FLAT,
  GRADED,
  NARROW,
  TWO_ROWS_ARE_ONE,
  SOME_POINTS_ARE_ONE,
  ALL_IS_POINT,
  LAST_ROW_FAR,
  ALL_ROWS_ARE_ONE,
  DEGENERACIES
};

static void degenerate_net(struct random *random, enum degeneracy kind, double P[4][4][3])
{
  gentle(random, 1, P);
  double line[3];
  random_vector(random, 1, line);
  for (int i = 0; i < 4; i++) {
    for (int j = 0; j < 4; j++) {
      double *p = P[i][j];
      switch (kind) {
      case ROW_IS_POINT:
        if (i == 3) memcpy(p, P[3][0], sizeof P[3][0]);
        break;
      case ALL_IS_LINE:
        for (int axis = 0; axis < 3; axis++) p[axis] = line[axis] * p[0];
        break;
      case FLAT: p[2] = line[0] * p[0] + line[1] * p[1]; break;
      case GRADED: /* each point a thousand times as far out as the one before it, along either parameter */
        for (int axis = 0; axis < 3; axis++) p[axis] *= pow(10, -3 * (6 - i - j));
        break;
      case NARROW: p[1] *= 1e-12; break;
      case TWO_ROWS_ARE_ONE:
        if (i == 2) memcpy(p, P[1][j], sizeof P[1][j]);
        break;
      case SOME_POINTS_ARE_ONE:
        if (choose(random, 3) == 0) memcpy(p, P[0][0], sizeof P[0][0]);
        break;
      case ALL_IS_POINT: memcpy(p, P[0][0], sizeof P[0][0]); break;
      case LAST_ROW_FAR: p[0] = i == 3 ? 1 : p[0] * 1e-9; break;
      default: memcpy(p, P[0][j], sizeof P[0][j]); break; /* ALL_ROWS_ARE_ONE: a curve */
      }
    }
  }
}

static void degenerate(struct random *random, size_t index, struct situation *s)
{
  static const double roundings[] = {0, 1, 10, 1e3, 1e6};
  s->count = 1 + index % 2;
  for (size_t n = 0; n < s->count; n++) {
    degenerate_net(random, (enum degeneracy)(index / 2 % DEGENERACIES), s->P[n]);
    const double off = roundings[choose(random, 5)] * ROUNDING;
    for (int k = 0; k < 16; k++)
      for (int axis = 0; axis < 3; axis++) {
        double *x = &s->P[n][k / 4][k % 4][axis];
        *x += off * random_between(random, -1, 1) * (choose(random, 2) ? 1 : fabs(*x));
      }
  }
  const double size = situation_size(s);
  for (int n = 0; n < RAYS; n++) {
    double at[3];
    const double u = choose(random, 4) ? random_unit(random) : (double)choose(random, 2), v = random_unit(random);
    situation_point(s, (size_t)n % s->count, u, v, at);
    ray_round(random, at, choose(random, 3) ? 0 : ring_radius(random, size), size > 0 ? size : 1, &s->rays[n]);
  }
}

/* As thin as 1e-2 ... 1e-15 of its length, in space. */
static void thin(struct random *random, size_t index, struct situation *s)
{
  const double width = decade(index, 2, 15);
  s->count = 1;
  gentle(random, 0.5, s->P[0]);
  struct placement turn;
  placement_random(random, 1, choose(random, 2) ? 1 : 0, &turn);
  for (int k = 0; k < 16; k++) {
    double *p = s->P[0][k / 4][k % 4], q[3] = {p[0], p[1] * width, p[2]};
    if (index % 3) placement_apply(&turn, q, p);
    else memcpy(p, q, sizeof q);
  }
  for (int n = 0; n < RAYS; n++) {
    double at[3];
    situation_point(s, 0, random_unit(random), random_unit(random), at);
    ray_round(random, at, choose(random, 2) ? 0 : width * random_unit(random), 1, &s->rays[n]);
  }
}

/* ---- starts, sizes ---- */

/* A ray in any direction from a point or a little beside it. */
static void start_beside(struct random *random, const double at[3], double size, struct ray *ray)
{
  double d[3], from[3];
  const double off = choose(random, 4) ? random_decade(random, 2, 17) * size : 0;
  random_direction(random, d);
  random_vector(random, off, from);
  for (int axis = 0; axis < 3; axis++) from[axis] += at[axis];
  ray_along(from, d, ray);
}

/* From within 1 % of a pole, on the surface or beside it, anywhere. */
static void pole_starts(struct random *random, size_t index, struct situation *s)
{
  place_pole(random, index, s);
  for (int n = 0; n < RAYS; n++) {
    double at[3];
    situation_point(s, 0, random_decade(random, 2, 16) * random_unit(random), random_unit(random), at);
    start_beside(random, at, situation_size(s), &s->rays[n]);
  }
}

/* From next to a surface point, a crease or a corner included. */
static void surface_starts(struct random *random, size_t index, struct situation *s)
{
  place_body(random, index, 0.5, 0.5, s);
  for (int n = 0; n < RAYS; n++) {
    double at[3];
    const double u = choose(random, 4) ? random_unit(random) : (double)choose(random, 2);
    const double v = choose(random, 4) ? random_unit(random) : (double)choose(random, 2);
    situation_point(s, 0, u, v, at);
    start_beside(random, at, situation_size(s), &s->rays[n]);
  }
}

/* The faces of a cube, bent or not, and rays in their planes and through their edges. */
static void cubes(struct random *random, size_t index, struct situation *s)
{
  s->count = 6;
  const double bulge = index % 2 ? 0.3 : 0;
  for (int face = 0; face < 6; face++) {
    const int k = face / 2, i = (k + 1) % 3, j = (k + 2) % 3;
    for (int n = 0; n < 16; n++) {
      double *p = s->P[face][n / 4][n % 4];
      const bool inner = n / 4 % 3 && n % 4 % 3;
      p[i] = n / 4 - 1.5, p[j] = n % 4 - 1.5, p[k] = (face % 2 ? 1 : -1) * (1.5 + inner * bulge);
    }
  }
  for (int n = 0; n < RAYS; n++) {
    double target[3], origin[3];
    for (int axis = 0; axis < 3; axis++) {
      target[axis] = choose(random, 2) ? random_between(random, -1.5, 1.5) : choose(random, 2) ? 1.5 : -1.5;
      origin[axis] = choose(random, 2) ? target[axis] : random_between(random, -3, 3);
      if (choose(random, 4) == 0) origin[axis] += random_decade(random, 6, 17);
    }
    if (memcmp(origin, target, sizeof origin) == 0) origin[0] -= 1;
    ray_between(origin, target, &s->rays[n]);
  }
}

/* The same patch twice and more, or but for some roundings. */
static void coincident(struct random *random, size_t index, struct situation *s)
{
  s->count = 2 + index % 3;
  gentle(random, 1, s->P[0]);
  for (size_t n = 1; n < s->count; n++) {
    memcpy(s->P[n], s->P[0], sizeof s->P[n]);
    const double off = index % 2 ? random_decade(random, 6, 17) : 0;
    for (int k = 0; k < 16; k++) s->P[n][k / 4][k % 4][2] += off * random_between(random, -1, 1);
  }
  for (int n = 0; n < RAYS; n++) {
    double at[3];
    situation_point(s, 0, random_unit(random), random_unit(random), at);
    ray_round(random, at, ring_radius(random, 1), 1, &s->rays[n]);
  }
}

static const struct situation_class classes[] = {
  {"rings round poles", 701, 1, ring_poles},
  {"rings round shared edges", 702, 1, ring_edges},
  {"rings round corners", 703, 1, ring_corners},
  {"rings round borders of leaves", 704, 1, ring_leaves},
  {"rings round cusps", 705, 0.3, ring_cusps},
  {"rings round rulings", 706, 0.1, ring_rulings},
  {"rings round tangencies", 707, 1, ring_tangencies},
  {"tangent where nothing bends", 729, 0.5, ring_unbent_tangents},
  {"tangent at creases", 708, 1, ring_creases},
  {"open borders", 709, 1, ring_open_borders},
  {"nearly degenerate nets", 710, 0.3, degenerate},
  {"thin patches", 711, 1, thin},
  {"starts next to poles", 712, 1, pole_starts},
  {"poles met but for nothing", 730, 0.5, extreme_met_poles},
  {"starts next to surfaces", 713, 1, surface_starts},
  {"uneven sizes", 718, 0.5, extreme_uneven_sizes},
  {"sizes beyond all digits", 714, 0.5, extreme_wild_sizes},
  {"far origins", 715, 1, extreme_far_origins},
  {"far origins, oblique", 719, 0.5, extreme_far_oblique},
  {"far origins, along a diagonal", 727, 0.1, extreme_far_diagonal},
  {"cubes from within their planes", 716, 0.1, cubes},
  {"coincident patches", 717, 0.5, coincident},
  {"small whole numbers", 720, 0.5, lattice},
  {"small whole numbers in other units", 721, 0.5, threshold_scaled_lattice},
  {"directions of any length", 722, 1, threshold_directions},
  {"nearly of a lower degree", 723, 1, threshold_degrees},
  {"points anywhere", 724, 0.5, threshold_random_nets},
  {"coincident, turned round", 725, 0.5, threshold_turned},
  {"large and small", 726, 0.5, threshold_large_and_small},
  {"closed surfaces nobody would draw", 728, 0.5, threshold_cycles},
};

size_t every_class_count(void) { return situation_class_count() + sizeof classes / sizeof classes[0]; }

const struct situation_class *every_class_at(size_t index)
{
  const size_t first = situation_class_count();
  return index < first ? situation_class_at(index) : &classes[index - first];
}

bool class_told_only(const struct situation_class *class)
{
  return class->generate == ring_unbent_tangents || class->generate == extreme_met_poles;
}
