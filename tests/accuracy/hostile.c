/* Generators of rays aimed at what the intersector treats apart; see hostile.h. */
#include "accuracy/hostile.h"

#include <math.h>
#include <string.h>

#include "accuracy/extremes.h"
#include "accuracy/generate.h"
#include "accuracy/lattice.h"
#include "accuracy/models.h"
#include "accuracy/thresholds.h"

enum { RAYS = SITUATION_RAYS };

/* One rounding of a number of size 1. */
#define ROUNDING 0x1p-53

/* ---- pieces ---- */

/* A ray along d through a point at the distance `off` from `at`, that starts before it: next to it or far, or a little
 * behind. */
static void ray_past(struct random *random, const double at[3], double off, double size, const double d[3],
                     struct ray *ray)
{
  double aside[3], back = choose(random, 2) ? random_between(random, 0.5, 8) : random_decade(random, 0, 18);
  if (choose(random, 8) == 0) back = -off;
  random_vector(random, off, aside);
  ray->t_min = 0, ray->t_max = INFINITY;
  for (int axis = 0; axis < 3; axis++) {
    ray->origin[axis] = at[axis] + aside[axis] - back * size * d[axis];
    ray->direction[axis] = d[axis];
  }
}

static void ray_round(struct random *random, const double at[3], double off, double size, struct ray *ray)
{
  double d[3];
  random_direction(random, d);
  ray_past(random, at, off, size, d, ray);
}

static double ring(struct random *random, double size)
{
  return choose(random, 8) ? size * random_decade(random, 0, 18) : 0;
}

/* A closed model, as it is, or turned, or with the point at (u,v) of its patch 0 moved to the middle, where rays next
 * to it have all their digits. */
static void place_model(struct random *random, struct model *made, double u, double v, struct situation *s)
{
  struct model model = *made;
  struct placement placement;
  const double scale = choose(random, 3) ? 1 : random_decade(random, -6, 6);
  placement_random(random, scale, choose(random, 2) ? scale * random_decade(random, -3, 3) : 0, &placement);
  const size_t kind = choose(random, 3);
  if (kind == 1) model_place(&model, &placement);
  if (kind == 2) {
    double at[3];
    net_point((const double(*)[4][3])model.P[0], u, v, at);
    for (size_t n = 0; n < model.count; n++)
      for (int k = 0; k < 16; k++)
        for (int axis = 0; axis < 3; axis++) model.P[n][k / 4][k % 4][axis] -= at[axis];
  }
  s->count = model.count;
  memcpy(s->P, model.P, sizeof s->P);
}

static void place(struct random *random, void (*make)(struct model *), double u, double v, struct situation *s)
{
  struct model model;
  make(&model);
  place_model(random, &model, u, v, s);
}

/* How large patch 0 is. */
static double size_of(const struct situation *s)
{
  double size = 0;
  for (int k = 0; k < 16; k++)
    for (int axis = 0; axis < 3; axis++) size = fmax(size, fabs(s->P[0][k / 4][k % 4][axis] - s->P[0][0][0][axis]));
  return size;
}

static void rays_round(struct random *random, double u, double v, struct situation *s)
{
  double at[3];
  const double size = size_of(s);
  net_point((const double(*)[4][3])s->P[0], u, v, at);
  for (int n = 0; n < RAYS; n++) ray_round(random, at, ring(random, size), size, &s->rays[n]);
}

static void (*const bodies[])(struct model *) = {model_ball, model_torus, model_dome};
static void (*const bodies_with_poles[])(struct model *) = {model_ball, model_dome, model_teapot};

/* Patch 0 becomes one whose row u = 0 is one point: of the teapot the lid's and the bottom's. */
static void pole_first(struct random *random, struct model *model)
{
  for (;;) {
    const size_t n = choose(random, model->count);
    double(*row)[3] = model->P[n][0], P[4][4][3];
    bool pole = true;
    for (int j = 1; j < 4; j++) pole = pole && memcmp(row[j], row[0], sizeof row[0]) == 0;
    if (!pole) continue;
    memcpy(P, model->P[0], sizeof P);
    memcpy(model->P[0], model->P[n], sizeof P), memcpy(model->P[n], P, sizeof P);
    return;
  }
}

static void place_pole(struct random *random, size_t index, struct situation *s)
{
  struct model model;
  bodies_with_poles[index % 3](&model);
  pole_first(random, &model);
  place_model(random, &model, 0, 0, s);
}

/* ---- rings ---- */

static void pole_rings(struct random *random, size_t index, struct situation *s)
{
  place_pole(random, index, s);
  rays_round(random, 0, random_unit(random), s);
}

static void edge_rings(struct random *random, size_t index, struct situation *s)
{
  const double v = choose(random, 4) ? random_unit(random) : 0.5, end = (double)choose(random, 2);
  const bool across = choose(random, 2);
  place(random, bodies[index % 3], across ? v : 1, across ? end : v, s);
  rays_round(random, across ? v : 1, across ? end : v, s);
}

static void corner_rings(struct random *random, size_t index, struct situation *s)
{
  const double u = index % 3 ? 1 : (double)choose(random, 2), v = (double)choose(random, 2);
  place(random, bodies[index % 3], u, v, s);
  rays_round(random, u, v, s);
}

/* Where leaves of a patch meet, and the lines that a leaf's box and its margin end at. */
static void leaf_rings(struct random *random, size_t index, struct situation *s)
{
  static const double steps[] = {8, 2, 4, 3, 16};
  static const double margins[] = {0, 1e-3, -1e-3, 1e-9, -1e-9, 1e-13, -1e-13};
  const double part = steps[choose(random, 5)];
  double u = ((double)choose(random, (size_t)part) + margins[choose(random, 7)]) / part, v = random_unit(random);
  if (choose(random, 3) == 0) v = (double)choose(random, (size_t)part) / part;
  place(random, bodies[index % 3], u, v, s);
  rays_round(random, u, v, s);
}

/* A point where the first derivative vanishes along u, at the border or within. */
static void cusp_rings(struct random *random, size_t index, struct situation *s)
{
  s->count = 1;
  gentle(random, 1, s->P[0]);
  const bool within = index % 2;
  for (int j = 0; j < 4; j++) {
    if (!within) memcpy(s->P[0][1][j], s->P[0][0][j], sizeof s->P[0][0][j]);
    static const double cusp[4] = {1, -1, 1, -1};
    for (int i = 0; i < 4 && within; i++) s->P[0][i][j][0] = cusp[i];
  }
  if (index % 4 > 1) memcpy(s->P[0][0][1], s->P[0][0][0], sizeof s->P[0][0][0]);
  rays_round(random, within ? 0.5 : 0, choose(random, 2) ? 0 : random_unit(random), s);
}

/* Next to a line of a ruled patch, along it. */
static void ruling_rings(struct random *random, size_t index, struct situation *s)
{
  s->count = 1;
  gentle(random, 1, s->P[0]);
  for (int j = 0; j < 4; j++)
    for (int i = 1; i < 3; i++)
      for (int axis = 0; axis < 3; axis++) {
        const double low = s->P[0][0][j][axis], high = s->P[0][3][j][axis];
        s->P[0][i][j][axis] = low + (high - low) * (index % 2 ? i / 3.0 : i * 0.5 - 0.25);
      }
  for (int n = 0; n < RAYS; n++) {
    double start[3], end[3], d[3];
    const double v = choose(random, 3) ? random_unit(random) : (double)choose(random, 9) / 8;
    net_point((const double(*)[4][3])s->P[0], 0, v, start), net_point((const double(*)[4][3])s->P[0], 1, v, end);
    for (int axis = 0; axis < 3; axis++) d[axis] = end[axis] - start[axis];
    ray_past(random, start, ring(random, 1), 1, d, &s->rays[n]);
  }
}

/* Nearly in the tangent plane at a point, and past it by a ring's radius. */
static void rays_tangent(struct random *random, double u, double v, double tilt, struct situation *s, struct ray *ray)
{
  double at[3], du[3], dv[3], d[3];
  net_point((const double(*)[4][3])s->P[0], u, v, at);
  net_tangents((const double(*)[4][3])s->P[0], u, v, du, dv);
  const double along = random_between(random, -1, 1), across = random_between(random, -1, 1);
  for (int axis = 0; axis < 3; axis++) {
    const int i = (axis + 1) % 3, j = (axis + 2) % 3;
    d[axis] = along * du[axis] + across * dv[axis] + tilt * (du[i] * dv[j] - du[j] * dv[i]);
  }
  ray_past(random, at, ring(random, size_of(s)), 1, d, ray);
}

static void tangent_rings(struct random *random, size_t index, struct situation *s)
{
  s->count = 1;
  gentle(random, index % 2 ? 1 : 0.1, s->P[0]);
  for (int n = 0; n < RAYS; n++)
    rays_tangent(random, random_unit(random), random_unit(random),
                 random_decade(random, 1, 18) * random_between(random, -1, 1), s, &s->rays[n]);
}

/* In the tangent plane at (u,v): what the surface bends there along du, along both and along dv, but for a factor. */
static void bends(const struct situation *s, double u, double v, double du[3], double dv[3], double out[3])
{
  static const double h = 0x1p-16;
  double before[2][3], behind[2][3], n[3], unused[3];
  const double(*P)[4][3] = (const double(*)[4][3])s->P[0];
  net_tangents(P, u, v, du, dv);
  for (int axis = 0; axis < 3; axis++) {
    const int i = (axis + 1) % 3, j = (axis + 2) % 3;
    n[axis] = du[i] * dv[j] - du[j] * dv[i];
  }
  net_tangents(P, u - h, v, before[0], before[1]), net_tangents(P, u + h, v, behind[0], behind[1]);
  out[0] = out[1] = out[2] = 0;
  for (int k = 0; k < 2; k++)
    for (int axis = 0; axis < 3; axis++) out[k] += (behind[k][axis] - before[k][axis]) * n[axis];
  net_tangents(P, u, v - h, unused, before[1]), net_tangents(P, u, v + h, unused, behind[1]);
  for (int axis = 0; axis < 3; axis++) out[2] += (behind[1][axis] - before[1][axis]) * n[axis];
}

/* The same, along a direction in which the surface does not bend, where it has one; half of the rays where that is the
 * only one. They meet it as a cubic does 0, or a quartic. */
static void unbent_tangents(struct random *random, size_t index, struct situation *s)
{
  s->count = 1;
  gentle(random, index % 2 ? 1 : 0.1, s->P[0]);
  for (int n = 0; n < RAYS; n++) {
    double at[2], to[2], du[3], dv[3], b[3], d[3], point[3];
    for (int k = 0; k < 2; k++) at[k] = random_unit(random), to[k] = random_unit(random);
    bends(s, at[0], at[1], du, dv, b);
    const bool saddle = b[1] * b[1] > b[0] * b[2];
    for (int halving = 0; halving < 40 && n % 2; halving++) {
      const double middle[2] = {(at[0] + to[0]) / 2, (at[1] + to[1]) / 2};
      bends(s, middle[0], middle[1], du, dv, b);
      memcpy((b[1] * b[1] > b[0] * b[2]) == saddle ? at : to, middle, sizeof at);
    }
    bends(s, at[0], at[1], du, dv, b);
    const double along = -b[1] + sqrt(fmax(b[1] * b[1] - b[0] * b[2], 0));
    net_point((const double(*)[4][3])s->P[0], at[0], at[1], point);
    for (int axis = 0; axis < 3; axis++) d[axis] = (along * du[axis] + b[0] * dv[axis]) / (fabs(along) + fabs(b[0]));
    ray_past(random, point, ring(random, size_of(s)), 1, d, &s->rays[n]);
  }
}

/* Two patches with a row in common, and rays that touch one of them, or both, next to it. */
static void creases(struct random *random, size_t index, struct situation *s)
{
  s->count = 2;
  gentle(random, index % 2 ? 0.5 : 0.1, s->P[0]), gentle(random, 0.1, s->P[1]);
  for (int j = 0; j < 4; j++) {
    memcpy(s->P[1][0][j], s->P[0][3][j], sizeof s->P[1][0][j]);
    for (int i = 1; i < 4; i++) {
      s->P[1][i][j][0] += 3;
      for (int axis = 0; axis < 3 && index % 3 == 0; axis++) /* smooth across the row but for rounding */
        s->P[1][i][j][axis] = (1 + i) * s->P[0][3][j][axis] - i * s->P[0][2][j][axis];
    }
  }
  for (int n = 0; n < RAYS; n++) {
    const double off = choose(random, 3) ? random_decade(random, 1, 16) : 0;
    rays_tangent(random, 1 - off, random_unit(random), random_decade(random, 0, 16) * random_between(random, -1, 1), s,
                 &s->rays[n]);
  }
}

/* Next to the border of an open surface; collapsed but for some roundings, too. */
static void open_borders(struct random *random, size_t index, struct situation *s)
{
  s->count = 1;
  gentle(random, 1, s->P[0]);
  if (index % 2)
    for (int j = 1; j < 4; j++)
      for (int axis = 0; axis < 3; axis++)
        s->P[0][3][j][axis] = s->P[0][3][0][axis] + random_decade(random, 10, 17) * random_between(random, -1, 1);
  for (int n = 0; n < RAYS; n++) {
    double at[3];
    const double along = choose(random, 5) ? random_unit(random) : (double)choose(random, 2);
    const double end = choose(random, 3) ? 1 : 0;
    net_point((const double(*)[4][3])s->P[0], n % 2 ? along : end, n % 2 ? end : along, at);
    ray_round(random, at, choose(random, 2) ? random_decade(random, 14, 18) : ring(random, 1), 1, &s->rays[n]);
  }
}

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
  const double size = size_of(s);
  for (int n = 0; n < RAYS; n++) {
    double at[3];
    const double u = choose(random, 4) ? random_unit(random) : (double)choose(random, 2), v = random_unit(random);
    net_point((const double(*)[4][3])s->P[n % (int)s->count], u, v, at);
    ray_round(random, at, choose(random, 3) ? 0 : ring(random, size), size > 0 ? size : 1, &s->rays[n]);
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
    net_point((const double(*)[4][3])s->P[0], random_unit(random), random_unit(random), at);
    ray_round(random, at, choose(random, 2) ? 0 : width * random_unit(random), 1, &s->rays[n]);
  }
}

/* ---- starts, sizes ---- */

/* From within 1 % of a pole, on the surface or beside it, anywhere. */
static void pole_starts(struct random *random, size_t index, struct situation *s)
{
  place_pole(random, index, s);
  const double size = size_of(s);
  for (int n = 0; n < RAYS; n++) {
    double d[3], at[3];
    random_direction(random, d);
    net_point((const double(*)[4][3])s->P[0], random_decade(random, 2, 16) * random_unit(random), random_unit(random),
              at);
    s->rays[n] = (struct ray){.t_min = 0, .t_max = INFINITY};
    const double off = choose(random, 4) ? random_decade(random, 2, 17) * size : 0;
    for (int axis = 0; axis < 3; axis++) {
      s->rays[n].origin[axis] = at[axis] + off * random_between(random, -1, 1);
      s->rays[n].direction[axis] = d[axis];
    }
  }
}

/* From next to a surface point, a crease or a corner included. */
static void surface_starts(struct random *random, size_t index, struct situation *s)
{
  place(random, bodies[index % 3], 0.5, 0.5, s);
  const double size = size_of(s);
  for (int n = 0; n < RAYS; n++) {
    double at[3];
    const double u = choose(random, 4) ? random_unit(random) : (double)choose(random, 2);
    const double v = choose(random, 4) ? random_unit(random) : (double)choose(random, 2);
    net_point((const double(*)[4][3])s->P[0], u, v, at);
    random_direction(random, s->rays[n].direction);
    s->rays[n].t_min = 0, s->rays[n].t_max = INFINITY;
    const double off = choose(random, 4) ? random_decade(random, 2, 17) * size : 0;
    for (int axis = 0; axis < 3; axis++) s->rays[n].origin[axis] = at[axis] + off * random_between(random, -1, 1);
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
    net_point((const double(*)[4][3])s->P[0], random_unit(random), random_unit(random), at);
    ray_round(random, at, ring(random, 1), 1, &s->rays[n]);
  }
}

static const struct situation_class classes[] = {
  {"rings round poles", 701, 1, pole_rings},
  {"rings round shared edges", 702, 1, edge_rings},
  {"rings round corners", 703, 1, corner_rings},
  {"rings round borders of leaves", 704, 1, leaf_rings},
  {"rings round cusps", 705, 0.3, cusp_rings},
  {"rings round rulings", 706, 0.1, ruling_rings},
  {"rings round tangencies", 707, 1, tangent_rings},
  {"tangent where nothing bends", 729, 0.5, unbent_tangents},
  {"tangent at creases", 708, 1, creases},
  {"open borders", 709, 1, open_borders},
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
  return class->generate == unbent_tangents || class->generate == extreme_met_poles;
}
