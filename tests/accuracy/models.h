/* Models of patches that share their edges bit for bit. Arrays are P[patch][i][j][xyz]. All except the teapot are
 * closed and about the origin, of outer radius 1 (torus: 1.4). */
#ifndef TESTS_ACCURACY_MODELS_H
#define TESTS_ACCURACY_MODELS_H

#include <stdbool.h>
#include <stddef.h>

#include "random.h"

enum { MODEL_MOST_PATCHES = 32 };

struct closed_model {
  const char *name;
  size_t count;
  double P[MODEL_MOST_PATCHES][4][4][3];
  bool other[MODEL_MOST_PATCHES];   /* not part of the wall round the inside: nothing is aimed at it */
  bool open[MODEL_MOST_PATCHES][4]; /* borders, as in geometry/edges.h, that are neither shared nor collapsed */
};

/* Half a ball with poles at (0,1,0), closed by a flat base whose centre is collapsed too: 8 patches. Row i = 0 is the
 * pole. */
void model_dome(struct closed_model *out);

/* A ball of 8 octants with collapsed poles at (0,1,0) and (0,-1,0). */
void model_ball(struct closed_model *out);

/* A torus about the y axis, radii 1 and 0.4: 16 patches; u runs around the tube. */
void model_torus(struct closed_model *out);

/* The body of the teapot of scenes/teapot.pscn: rim, body and bottom, open between rim and lid. Handle, spout and lid
 * are present, and not part of the wall. In units of 2: the body's radius is 1, the bottom at y = 0. */
void model_teapot(struct closed_model *out);

/* A point well inside: at most half as far from the middle (torus: from the circle inside the tube) as the surface
 * is. */
void model_inside(const struct closed_model *model, struct random *random, double out_point[3]);

/* A rotation (rows orthonormal to rounding) times `scale`, and a shift. One function of the point alone applies it, so
 * shared points stay shared. */
struct placement {
  double M[3][3], shift[3];
};
void placement_random(struct random *random, double scale, double shift, struct placement *out);
void placement_apply(const struct placement *placement, const double p[3], double out[3]);
void model_place(struct closed_model *model, const struct placement *placement);

/* A model as it is made, and as it is placed: the same unless `moved`. */
struct placed_model {
  struct closed_model model, placed;
  struct placement placement;
  bool moved;
};
void model_placed(void (*make)(struct closed_model *out), struct random *random, double scale, double shift, bool moved,
                  struct placed_model *out);

/* Takes a point that belongs to the model along. */
void placed_point(const struct placed_model *at, double point[3]);

/* S(u,v) in double. */
void net_point(const double P[4][4][3], double u, double v, double out_point[3]);

/* S_u and S_v in double. */
void net_tangents(const double P[4][4][3], double u, double v, double out_u[3], double out_v[3]);

#endif
