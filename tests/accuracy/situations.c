/* Generators of the situations where methods fail. See situations.h. */
#include "accuracy/situations.h"

#include <math.h>
#include <string.h>

#include "accuracy/generate.h"
#include "accuracy/models.h"

enum { RAYS = SITUATION_RAYS };

/* ---- pieces the generators share ---- */

static double *point(struct situation *s, int i, int j) { return s->P[0][i][j]; }

/* Rays at random points of patch 0 from all around. */
static void rays_at_patch(struct random *random, struct situation *s)
{
  for (int n = 0; n < RAYS; n++) {
    double origin[3], target[3];
    random_vector(random, 6, origin);
    situation_point(s, 0, random_between(random, -0.1, 1.1), random_between(random, -0.1, 1.1), target);
    ray_between(origin, target, &s->rays[n]);
  }
}

/* ---- the classes ---- */

static void apex(struct random *random, size_t index, struct situation *s)
{
  struct closed_model model;
  model_dome(&model);
  s->count = model.count;
  memcpy(s->P, model.P, sizeof s->P);
  for (int n = 0; n < RAYS; n++) {
    double origin[3], target[3] = {0, n % 2 ? 1 : 0, 0}, off[3];
    random_vector(random, 3, origin);
    random_vector(random, n < RAYS / 4 ? 0 : decade(index, 1, 16), off);
    for (int axis = 0; axis < 3; axis++) target[axis] += off[axis];
    ray_between(origin, target, &s->rays[n]);
  }
}

/* A patch that its mirror image x -> -x maps to itself (u -> 1 - u, every other one v -> 1 - v), and rays in the
 * plane of symmetry and across it: the two hits of a ray along x share one v (one u). */
static void symmetry(struct random *random, size_t index, struct situation *s)
{
  s->count = 1;
  gentle(random, 2, s->P[0]);
  for (int j = 0; j < 4; j++) {
    for (int i = 0; i < 2; i++) {
      memcpy(point(s, 3 - i, j), point(s, i, j), sizeof(double[3]));
      point(s, 3 - i, j)[0] = -point(s, i, j)[0];
    }
  }
  if (index % 2) transpose(s->P[0]);
  for (int n = 0; n < RAYS; n++) {
    double origin[3], target[3];
    random_vector(random, 4, origin);
    random_vector(random, 1, target);
    if (n % 2) {
      origin[0] = target[0] = 0;
    } else {
      target[1] = origin[1];
      target[2] = origin[2];
    }
    ray_between(origin, target, &s->rays[n]);
  }
}

static void in_plane(struct random *random, size_t index, struct situation *s)
{
  s->count = 1;
  gentle(random, 0, s->P[0]);
  for (int n = 0; n < RAYS; n++) {
    double origin[3], target[3];
    random_vector(random, 4, origin);
    random_vector(random, 1, target);
    origin[2] = n % 2 ? 0 : decade(index, 6, 17);
    target[2] = n % 4 == 1 ? decade(index, 6, 17) : 0;
    ray_between(origin, target, &s->rays[n]);
  }
}

/* Bilinear, with whole coordinates that are multiples of 9, so that this is exact. */
static void bilinear(struct random *random, double P[4][4][3])
{
  for (int n = 0; n < 4; n++) {
    double *corner = P[n / 2][n % 2];
    corner[0] = n / 2 ? 9 : -9, corner[1] = n % 2 ? 9 : -9;
    corner[2] = 9 * (double)((int)(random_bits(random) % 5) - 2);
  }
  raise_net(1, P);
}

static void ruling(struct random *random, size_t index, struct situation *s)
{
  s->count = 1;
  bilinear(random, s->P[0]);
  for (int n = 0; n < RAYS; n++) {
    double origin[3], target[3], start[3], end[3], u = (double)(random_bits(random) % 9) / 8;
    situation_point(s, 0, n % 2 ? u : 0, n % 2 ? 0 : u, start);
    situation_point(s, 0, n % 2 ? u : 1, n % 2 ? 1 : u, end);
    for (int axis = 0; axis < 3; axis++) {
      origin[axis] = 2 * start[axis] - end[axis];
      target[axis] = end[axis] + (n < RAYS / 2 ? 0 : decade(index, 1, 16) * random_between(random, -1, 1));
    }
    ray_between(origin, target, &s->rays[n]);
  }
}

static void elevated(struct random *random, size_t index, struct situation *s)
{
  s->count = 1;
  if (index % 2) {
    bilinear(random, s->P[0]);
  } else { /* biquadratic: multiples of 9 */
    for (int n = 0; n < 9; n++) {
      double *p = point(s, n / 3, n % 3);
      for (int axis = 0; axis < 3; axis++) p[axis] = 9 * (double)((int)(random_bits(random) % 9) - 4);
      p[0] += 36 * (n / 3 - 1), p[1] += 36 * (n % 3 - 1);
    }
    raise_net(2, s->P[0]);
  }
  for (int k = 0; k < 16; k++)
    for (int axis = 0; axis < 3; axis++) s->P[0][k / 4][k % 4][axis] /= 8;
  rays_at_patch(random, s);
}

/* z over a regular grid, seen along z and tilted by 1e-1 ... 1e-17. */
static void height_field(struct random *random, size_t index, struct situation *s)
{
  s->count = 1;
  for (int i = 0; i < 4; i++) {
    for (int j = 0; j < 4; j++) {
      const double p[3] = {i - 1.5, j - 1.5, random_between(random, -1, 1)};
      memcpy(point(s, i, j), p, sizeof p);
    }
  }
  for (int n = 0; n < RAYS; n++) {
    const double tilt = n % 4 ? decade(index, 1, 17) : 0;
    double target[3] = {random_between(random, -1.6, 1.6), random_between(random, -1.6, 1.6), 0};
    double origin[3] = {target[0] + tilt * random_between(random, -1, 1), target[1], n % 2 ? 4 : -4};
    ray_between(origin, target, &s->rays[n]);
  }
}

/* Rays at a point of the patch, off its tangent plane by 1e-1 ... 1e-8. */
static void tangent(struct random *random, size_t index, struct situation *s)
{
  s->count = 1;
  gentle(random, 1, s->P[0]);
  for (int n = 0; n < RAYS; n++) {
    double u = random_unit(random), v = random_unit(random), target[3], du[3], dv[3], normal[3], origin[3];
    situation_point(s, 0, u, v, target);
    net_tangents((const double(*)[4][3])s->P[0], u, v, du, dv);
    for (int axis = 0; axis < 3; axis++) {
      const int i = (axis + 1) % 3, j = (axis + 2) % 3;
      normal[axis] = du[i] * dv[j] - du[j] * dv[i];
    }
    const double along = random_between(random, -1, 1), across = random_between(random, -1, 1);
    const double off = decade(index, 1, 9) * (n % 2 ? 1 : -1);
    for (int axis = 0; axis < 3; axis++)
      origin[axis] = target[axis] - along * du[axis] - across * dv[axis] - off * normal[axis];
    ray_between(origin, target, &s->rays[n]);
    if (n % 4 == 0) /* past the point: a near miss or two close hits */
      for (int axis = 0; axis < 3; axis++) s->rays[n].origin[axis] += off * off * normal[axis];
  }
}

/* The patch's control points in one, where `edge` counts: those of u = 0, u = 1, v = 0, v = 1. */
static void collapse(struct situation *s, int edge)
{
  const int end = edge % 2 ? 3 : 0;
  for (int k = 0; k < 4; k++) {
    double *p = edge < 2 ? point(s, end, k) : point(s, k, end);
    const double *to = edge < 2 ? point(s, end, 0) : point(s, 0, end);
    if (p != to) memcpy(p, to, sizeof(double[3]));
  }
}

/* Some rays exactly at corners. */
static void rays_at_corners(struct situation *s)
{
  for (int n = 0; n < RAYS / 4; n++)
    ray_between(s->rays[n].origin, point(s, 3 * (n & 1), 3 * (n >> 1 & 1)), &s->rays[n]);
}

/* Opposite edges collapsed, in u, in v, or in both: then all corners are the same point. */
static void collapsed(struct random *random, size_t index, struct situation *s)
{
  s->count = 1;
  gentle(random, 1, s->P[0]);
  if (index % 3 != 1) collapse(s, 0), collapse(s, 1);
  if (index % 3 == 2) memcpy(point(s, 3, 0), point(s, 0, 0), sizeof(double[3])), collapse(s, 1);
  if (index % 3 != 0) collapse(s, 2), collapse(s, 3);
  rays_at_patch(random, s);
  rays_at_corners(s);
}

/* The whole patch is a line, along u or along v, or a point. */
static void line_or_point(struct random *random, size_t index, struct situation *s)
{
  s->count = 1;
  gentle(random, 1, s->P[0]);
  for (int k = 0; k < 16; k++) {
    double *p = point(s, k / 4, k % 4);
    if (index % 3 == 2)
      for (int axis = 0; axis < 3; axis++) p[axis] = s->P[0][0][0][axis];
    else p[1 - index % 3] = p[2] = 0.25;
  }
  rays_at_patch(random, s);
  rays_at_corners(s);
}

/* Back over itself, along u, along v or along both: then a ray meets it up to 18 times. */
static void folded(struct random *random, size_t index, struct situation *s)
{
  s->count = 1;
  gentle(random, 1, s->P[0]);
  for (int j = 0; j < 4; j++) point(s, 1, j)[0] += 4, point(s, 2, j)[0] -= 4;
  for (int i = 0; i < 4 && index % 3 == 0; i++) point(s, i, 1)[1] += 4, point(s, i, 2)[1] -= 4;
  if (index % 2) transpose(s->P[0]);
  rays_at_patch(random, s);
}

/* A cusp, where a derivative vanishes: x = (1 - 2u)^3. Some rays exactly at it. */
static void cusped(struct random *random, size_t index, struct situation *s)
{
  static const double cusp[4] = {1, -1, 1, -1};
  s->count = 1;
  gentle(random, 1, s->P[0]);
  for (int i = 0; i < 4; i++) {
    for (int j = 0; j < 4; j++) {
      point(s, i, j)[0] = cusp[i];
      if (index % 4 > 1) point(s, i, j)[2] = cusp[i] * cusp[i] * point(s, 0, j)[2]; /* in z too: both derivatives */
    }
  }
  if (index % 2) transpose(s->P[0]);
  rays_at_patch(random, s);
  for (int n = 0; n < RAYS / 4; n++) {
    double target[3], v = random_unit(random);
    situation_point(s, 0, index % 2 ? v : 0.5, index % 2 ? 0.5 : v, target);
    ray_between(s->rays[n].origin, target, &s->rays[n]);
  }
}

/* Cutting itself along a line: an extruded loop of a cubic. With w = u (1 - u), x = (2u - 1)(3 - 18 w) and z = 6 w,
 * so it crosses itself at (0,1), w = 1/6. Some rays exactly at that line. */
static void self_intersecting(struct random *random, size_t index, struct situation *s)
{
  static const double loop_x[4] = {-3, 5, -5, 3}, loop_z[4] = {0, 2, 2, 0};
  s->count = 1;
  for (int i = 0; i < 4; i++) {
    for (int j = 0; j < 4; j++) {
      const double p[3] = {loop_x[i], j - 1.5 + 0.2 * random_between(random, -1, 1), loop_z[i]};
      memcpy(point(s, i, j), p, sizeof p);
    }
  }
  if (index % 2) transpose(s->P[0]);
  rays_at_patch(random, s);
  for (int n = 0; n < RAYS / 4; n++) {
    const double target[3] = {0, random_between(random, -1.5, 1.5), 1};
    ray_between(s->rays[n].origin, target, &s->rays[n]);
  }
}

/* Exactly tangent to the bowl 3 z = x^2 + y^2 at its middle: what of the ray is exact stays so, for whole numbers. */
static void exactly_tangent(struct random *random, size_t index, struct situation *s)
{
  static const double square[4] = {3, -1, -1, 3};
  (void)index;
  s->count = 1;
  for (int i = 0; i < 4; i++) {
    for (int j = 0; j < 4; j++) {
      const double p[3] = {2 * i - 3, 2 * j - 3, square[i] + square[j]};
      memcpy(point(s, i, j), p, sizeof p);
    }
  }
  for (int n = 0; n < RAYS; n++) {
    double target[3] = {0}, origin[3];
    random_vector(random, 8, origin);
    for (int axis = 0; axis < 3; axis++) origin[axis] = rint(origin[axis] * 1024) / 1024;
    origin[2] = 0;
    ray_between(origin, target, &s->rays[n]);
  }
}

static void repeated(struct random *random, size_t index, struct situation *s)
{
  s->count = 1;
  gentle(random, 1, s->P[0]);
  for (size_t k = 0; k < 1 + index % 6; k++) {
    const uint64_t bits = random_bits(random);
    const int i = (int)(bits % 4), j = (int)(bits / 4 % 4), other_i = (int)(bits / 16 % 4),
              other_j = (int)(bits / 64 % 4);
    memcpy(point(s, i, j), point(s, other_i, other_j), sizeof(double[3]));
  }
  rays_at_patch(random, s);
}

static void resize(struct situation *s, double scale, double shift)
{
  for (int k = 0; k < 16; k++)
    for (int axis = 0; axis < 3; axis++) point(s, k / 4, k % 4)[axis] = scale * point(s, k / 4, k % 4)[axis] + shift;
}

/* The patch scaled by 1e6 or 1e-6, or shifted by 1e6; the rays with it. */
static void sized(struct random *random, size_t index, struct situation *s)
{
  static const double scales[] = {1e6, 1e-6, 1, 1e-6}, shifts[] = {0, 0, 1e6, 1};
  const double scale = scales[index % 4], shift = shifts[index % 4];
  s->count = 1;
  gentle(random, 1, s->P[0]);
  resize(s, scale, shift);
  for (int n = 0; n < RAYS; n++) {
    double origin[3], target[3];
    random_vector(random, 6 * scale, origin);
    for (int axis = 0; axis < 3; axis++) origin[axis] += shift;
    situation_point(s, 0, random_unit(random), random_unit(random), target);
    ray_between(origin, target, &s->rays[n]);
  }
}

/* Magnitudes near the ends of what the reference works with. Beyond them: property/invariance_test.c,
 * image/magnitudes.sh. */
static void hostile_size(struct random *random, size_t index, struct situation *s)
{
  const double scale = index % 2 ? 1e50 : 1e-50;
  s->count = 1;
  gentle(random, 1, s->P[0]);
  rays_at_patch(random, s);
  resize(s, scale, 0);
  for (int n = 0; n < RAYS; n++) {
    double target[3];
    for (int axis = 0; axis < 3; axis++) {
      target[axis] = scale * (s->rays[n].origin[axis] + s->rays[n].direction[axis]);
      s->rays[n].origin[axis] *= scale;
    }
    ray_between(s->rays[n].origin, target, &s->rays[n]);
  }
}

static void far_camera(struct random *random, size_t index, struct situation *s)
{
  (void)index;
  s->count = 1;
  gentle(random, 1, s->P[0]);
  for (int n = 0; n < RAYS; n++) {
    double origin[3], target[3];
    random_vector(random, 1e8, origin);
    situation_point(s, 0, random_between(random, -0.1, 1.1), random_between(random, -0.1, 1.1), target);
    ray_between(origin, target, &s->rays[n]);
  }
}

/* A fan of rays around a tangent one, `width` times as wide as the patch. */
static void silhouette(struct random *random, double width, struct situation *s)
{
  s->count = 1;
  gentle(random, 1.5, s->P[0]);
  double target[3], du[3], dv[3], origin[3];
  const double u = random_between(random, 0.1, 0.9), v = random_between(random, 0.1, 0.9);
  situation_point(s, 0, u, v, target);
  net_tangents((const double(*)[4][3])s->P[0], u, v, du, dv);
  const double along = random_between(random, -1, 1), across = random_between(random, -1, 1);
  for (int axis = 0; axis < 3; axis++) origin[axis] = target[axis] - 2 * along * du[axis] - 2 * across * dv[axis];
  for (int n = 0; n < RAYS; n++) {
    double aim[3];
    random_vector(random, width, aim);
    for (int axis = 0; axis < 3; axis++) aim[axis] += target[axis];
    ray_between(origin, aim, &s->rays[n]);
  }
}

static void magnified_200(struct random *random, size_t index, struct situation *s)
{
  (void)index;
  silhouette(random, 1.0 / 200, s);
}

static void magnified_million(struct random *random, size_t index, struct situation *s)
{
  (void)index;
  silhouette(random, 1e-6, s);
}

/* Rays of a picture: from one point, at a whole model. */
static void pictures(struct random *random, size_t index, struct situation *s)
{
  static void (*const models[])(struct closed_model *) = {model_teapot, model_torus, model_ball, model_dome};
  struct closed_model model;
  double origin[3], target[3];
  models[index % 4](&model);
  s->count = model.count;
  memcpy(s->P, model.P, sizeof s->P);
  random_vector(random, 5, origin);
  for (int n = 0; n < RAYS; n++) random_vector(random, 1.2, target), ray_between(origin, target, &s->rays[n]);
}

/* Rays that start on the surface, or a little off it. */
static void on_surface(struct random *random, size_t index, struct situation *s)
{
  s->count = 1;
  gentle(random, 2, s->P[0]);
  for (int n = 0; n < RAYS; n++) {
    double start[3], direction[3], off = n % 2 ? 0 : decade(index, 3, 17);
    situation_point(s, 0, random_unit(random), random_unit(random), start);
    random_vector(random, 1, direction);
    for (int axis = 0; axis < 3; axis++) start[axis] += off * direction[axis];
    ray_along(start, direction, &s->rays[n]);
  }
}

static const struct situation_class classes[] = {
  {"apex", 501, 0.2, apex},
  {"axis of symmetry", 502, 1, symmetry},
  {"in the plane of a flat patch", 503, 0.05, in_plane},
  {"along a ruling", 504, 0.05, ruling},
  {"elevated degree", 505, 1, elevated},
  {"height field along its axis", 506, 1, height_field},
  {"near tangent", 507, 1, tangent},
  {"exactly tangent", 515, 0.1, exactly_tangent},
  {"collapsed edges", 508, 0.1, collapsed},
  {"collapsed to a line or a point", 516, 0.1, line_or_point},
  {"folded", 509, 1, folded},
  {"cusped", 517, 0.2, cusped},
  {"self-intersecting", 518, 1, self_intersecting},
  {"repeated points", 510, 1, repeated},
  {"scaled and shifted", 511, 1, sized},
  {"hostile magnitudes", 519, 1, hostile_size},
  {"camera far away", 512, 1, far_camera},
  {"silhouette magnified 200 times", 513, 1, magnified_200},
  {"silhouette magnified a million times", 521, 1, magnified_million},
  {"start on the surface", 514, 1, on_surface},
  {"pictures of models", 522, 1, pictures},
};

size_t situation_class_count(void) { return sizeof classes / sizeof classes[0]; }

const struct situation_class *situation_class_at(size_t index) { return &classes[index]; }
