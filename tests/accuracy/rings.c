/* Rays round poles, edges, corners, cusps, rulings, tangencies and open borders. */
#include "accuracy/generators.h"

#include <math.h>
#include <string.h>

enum { RAYS = SITUATION_RAYS };

/* ---- pieces ---- */

/* A ray along d through a point at the distance `off` from `at`. It starts before that point, next to it or far away,
 * or a little behind it. */
static void ray_past(struct random *random, const double at[3], double off, double size, const double d[3],
                     struct ray *ray)
{
  double from[3], back = choose(random, 2) ? random_between(random, 0.5, 8) : random_decade(random, 0, 18);
  if (choose(random, 8) == 0) back = -off;
  random_vector(random, off, from);
  for (int axis = 0; axis < 3; axis++) from[axis] += at[axis] - back * size * d[axis];
  ray_along(from, d, ray);
}

void ray_round(struct random *random, const double at[3], double off, double size, struct ray *ray)
{
  double d[3];
  random_direction(random, d);
  ray_past(random, at, off, size, d, ray);
}

double ring_radius(struct random *random, double size)
{
  return choose(random, 8) ? size * random_decade(random, 0, 18) : 0;
}

/* Places a closed model: as it is, or turned, or with the point at (u,v) of its patch 0 moved to the middle, where rays
 * next to it have all their digits. */
static void place_model(struct random *random, struct closed_model *made, double u, double v, struct situation *s)
{
  struct closed_model model = *made;
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

void place_body(struct random *random, size_t index, double u, double v, struct situation *s)
{
  static void (*const bodies[])(struct closed_model *) = {model_ball, model_torus, model_dome};
  struct closed_model model;
  bodies[index % 3](&model);
  place_model(random, &model, u, v, s);
}

double situation_size(const struct situation *s)
{
  double size = 0;
  for (int k = 0; k < 16; k++)
    for (int axis = 0; axis < 3; axis++) size = fmax(size, fabs(s->P[0][k / 4][k % 4][axis] - s->P[0][0][0][axis]));
  return size;
}

static void rays_round(struct random *random, double u, double v, struct situation *s)
{
  double at[3];
  const double size = situation_size(s);
  situation_point(s, 0, u, v, at);
  for (int n = 0; n < RAYS; n++) ray_round(random, at, ring_radius(random, size), size, &s->rays[n]);
}

/* Makes patch 0 one whose row u = 0 is one point: of the teapot, one of the lid's or the bottom's. */
static void pole_first(struct random *random, struct closed_model *model)
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

void place_pole(struct random *random, size_t index, struct situation *s)
{
  static void (*const bodies_with_poles[])(struct closed_model *) = {model_ball, model_dome, model_teapot};
  struct closed_model model;
  bodies_with_poles[index % 3](&model);
  pole_first(random, &model);
  place_model(random, &model, 0, 0, s);
}

/* ---- rings ---- */

void ring_poles(struct random *random, size_t index, struct situation *s)
{
  place_pole(random, index, s);
  rays_round(random, 0, random_unit(random), s);
}

void ring_edges(struct random *random, size_t index, struct situation *s)
{
  const double v = choose(random, 4) ? random_unit(random) : 0.5, end = (double)choose(random, 2);
  const bool across = choose(random, 2);
  place_body(random, index, across ? v : 1, across ? end : v, s);
  rays_round(random, across ? v : 1, across ? end : v, s);
}

void ring_corners(struct random *random, size_t index, struct situation *s)
{
  const double u = index % 3 ? 1 : (double)choose(random, 2), v = (double)choose(random, 2);
  place_body(random, index, u, v, s);
  rays_round(random, u, v, s);
}

/* Where leaves of a patch meet, and where a leaf's box and its margin end. */
void ring_leaves(struct random *random, size_t index, struct situation *s)
{
  static const double steps[] = {8, 2, 4, 3, 16};
  static const double margins[] = {0, 1e-3, -1e-3, 1e-9, -1e-9, 1e-13, -1e-13};
  const double part = steps[choose(random, 5)];
  double u = ((double)choose(random, (size_t)part) + margins[choose(random, 7)]) / part, v = random_unit(random);
  if (choose(random, 3) == 0) v = (double)choose(random, (size_t)part) / part;
  place_body(random, index, u, v, s);
  rays_round(random, u, v, s);
}

/* A point where the derivative along u vanishes, on the border or inside. */
void ring_cusps(struct random *random, size_t index, struct situation *s)
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
void ring_rulings(struct random *random, size_t index, struct situation *s)
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
    situation_point(s, 0, 0, v, start), situation_point(s, 0, 1, v, end);
    for (int axis = 0; axis < 3; axis++) d[axis] = end[axis] - start[axis];
    ray_past(random, start, ring_radius(random, 1), 1, d, &s->rays[n]);
  }
}

/* A ray nearly in the tangent plane at a point, past it at a ring's radius. */
static void rays_tangent(struct random *random, double u, double v, double tilt, struct situation *s, struct ray *ray)
{
  double at[3], du[3], dv[3], d[3];
  situation_point(s, 0, u, v, at);
  net_tangents((const double(*)[4][3])s->P[0], u, v, du, dv);
  const double along = random_between(random, -1, 1), across = random_between(random, -1, 1);
  for (int axis = 0; axis < 3; axis++) {
    const int i = (axis + 1) % 3, j = (axis + 2) % 3;
    d[axis] = along * du[axis] + across * dv[axis] + tilt * (du[i] * dv[j] - du[j] * dv[i]);
  }
  ray_past(random, at, ring_radius(random, situation_size(s)), 1, d, ray);
}

void ring_tangencies(struct random *random, size_t index, struct situation *s)
{
  s->count = 1;
  gentle(random, index % 2 ? 1 : 0.1, s->P[0]);
  for (int n = 0; n < RAYS; n++)
    rays_tangent(random, random_unit(random), random_unit(random),
                 random_decade(random, 1, 18) * random_between(random, -1, 1), s, &s->rays[n]);
}

/* How far the surface bends from the tangent plane at (u,v), up to a factor: along du, along both, along dv. */
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

/* The same along a direction in which the surface does not bend, if there is one. For half of the rays it is the only
 * one; they meet the surface as a cubic meets 0, or a quartic. */
void ring_unbent_tangents(struct random *random, size_t index, struct situation *s)
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
    situation_point(s, 0, at[0], at[1], point);
    for (int axis = 0; axis < 3; axis++) d[axis] = (along * du[axis] + b[0] * dv[axis]) / (fabs(along) + fabs(b[0]));
    ray_past(random, point, ring_radius(random, situation_size(s)), 1, d, &s->rays[n]);
  }
}

/* Two patches that share a row, and rays that touch one of them, or both, next to it. */
void ring_creases(struct random *random, size_t index, struct situation *s)
{
  s->count = 2;
  gentle(random, index % 2 ? 0.5 : 0.1, s->P[0]), gentle(random, 0.1, s->P[1]);
  for (int j = 0; j < 4; j++) {
    memcpy(s->P[1][0][j], s->P[0][3][j], sizeof s->P[1][0][j]);
    for (int i = 1; i < 4; i++) {
      s->P[1][i][j][0] += 3;
      for (int axis = 0; axis < 3 && index % 3 == 0; axis++) /* smooth across the row up to rounding */
        s->P[1][i][j][axis] = (1 + i) * s->P[0][3][j][axis] - i * s->P[0][2][j][axis];
    }
  }
  for (int n = 0; n < RAYS; n++) {
    const double off = choose(random, 3) ? random_decade(random, 1, 16) : 0;
    rays_tangent(random, 1 - off, random_unit(random), random_decade(random, 0, 16) * random_between(random, -1, 1), s,
                 &s->rays[n]);
  }
}

/* Next to the border of an open surface; some borders are collapsed up to rounding. */
void ring_open_borders(struct random *random, size_t index, struct situation *s)
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
    situation_point(s, 0, n % 2 ? along : end, n % 2 ? end : along, at);
    ray_round(random, at, choose(random, 2) ? random_decade(random, 14, 18) : ring_radius(random, 1), 1, &s->rays[n]);
  }
}
