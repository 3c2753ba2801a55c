/* Closed models by revolution of cubic arcs: each point of the profile becomes a quarter of a circle, the other
 * quarters are its mirror images, which is exact. The arc is the usual cubic (G. Farin, Curves and Surfaces for
 * CAGD). */
#include "accuracy/models.h"

#include <math.h>
#include <string.h>

#include "cmocka_test.h"
#include "geometry/edges.h"
#include "teapot.h"

#define ARC 0.5522847498307936 /* 4/3 (sqrt 2 - 1): inner points of the cubic nearest to a quarter circle */

/* One quarter of the surface that the profile (r,y) makes about the y axis; mirrored by the signs. */
static void revolve(const double r[4], const double y[4], double sign_x, double sign_z, double P[4][4][3])
{
  for (int i = 0; i < 4; i++) {
    const double x[4] = {r[i], r[i], ARC * r[i], 0}, z[4] = {0, ARC * r[i], r[i], r[i]};
    for (int j = 0; j < 4; j++) {
      P[i][j][0] = sign_x * x[j];
      P[i][j][1] = y[i];
      P[i][j][2] = sign_z * z[j];
    }
  }
}

static void add_revolved(struct closed_model *model, const double r[4], const double y[4])
{
  for (int quarter = 0; quarter < 4; quarter++)
    revolve(r, y, quarter & 1 ? -1 : 1, quarter & 2 ? -1 : 1, model->P[model->count++]);
}

static const double arc_r[4] = {0, ARC, 1, 1}, arc_y[4] = {1, 1, ARC, 0};

void model_dome(struct closed_model *out)
{
  static const double base_r[4] = {0, 1.0 / 3, 2.0 / 3, 1}, base_y[4] = {0, 0, 0, 0};
  *out = (struct closed_model){.name = "dome"};
  add_revolved(out, arc_r, arc_y);
  add_revolved(out, base_r, base_y);
}

void model_ball(struct closed_model *out)
{
  static const double below_y[4] = {-1, -1, -ARC, 0};
  *out = (struct closed_model){.name = "ball"};
  add_revolved(out, arc_r, arc_y);
  add_revolved(out, arc_r, below_y);
}

void model_torus(struct closed_model *out)
{
  const double tube = 0.4;
  *out = (struct closed_model){.name = "torus"};
  for (int quarter = 0; quarter < 4; quarter++) {
    double r[4], y[4];
    for (int i = 0; i < 4; i++) {
      r[i] = 1 + (quarter & 1 ? -tube : tube) * arc_r[i];
      y[i] = (quarter & 2 ? -tube : tube) * arc_y[i];
    }
    add_revolved(out, r, y);
  }
}

void model_teapot(struct closed_model *out)
{
  enum { WALL = 12, BOTTOM = 28 }; /* rim and body come first, handle, spout and lid between */
  struct edge_neighbour neighbour[4 * MODEL_MOST_PATCHES];
  memset(out, 0, sizeof *out);
  out->name = "teapot";
  out->count = TEAPOT_PATCHES;
  teapot_read(out->P);
  for (size_t n = 0; n < 48 * out->count; n++) out->P[n / 48][n / 12 % 4][n / 3 % 4][n % 3] /= 2;
  assert_int_equal(edges_match(out->P, sizeof out->P[0], out->count, NULL, NULL, neighbour), 0);
  for (size_t n = 0; n < out->count; n++) {
    out->other[n] = n >= WALL && n < BOTTOM;
    for (int border = 0; border < 4; border++) {
      double edge[4][3];
      edge_points(out->P[n], border, edge);
      const bool collapsed = !memcmp(edge[0], edge[1], sizeof edge[0]) && !memcmp(edge[0], edge[3], sizeof edge[0]);
      out->open[n][border] = neighbour[4 * n + (size_t)border].patch == EDGE_NONE && !collapsed;
    }
  }
}

void model_inside(const struct closed_model *model, struct random *random, double out_point[3])
{
  double p[3], square;
  do {
    square = 0;
    for (int axis = 0; axis < 3; axis++) {
      p[axis] = random_between(random, -1, 1);
      square += p[axis] * p[axis];
    }
  } while (square > 1);
  if (!strcmp(model->name, "torus")) {
    double turn = random_between(random, -1, 1) * 3.14159265358979, r = 1 + 0.2 * p[0];
    out_point[0] = r * cos(turn);
    out_point[1] = 0.2 * p[1];
    out_point[2] = r * sin(turn);
  } else {
    const double lift = !strcmp(model->name, "dome") ? 0.35 : !strcmp(model->name, "teapot") ? 0.5 : 0;
    const double reach = lift > 0 ? 0.17 : 0.5;
    for (int axis = 0; axis < 3; axis++) out_point[axis] = reach * p[axis] + (axis == 1 ? lift : 0);
  }
}

void placement_random(struct random *random, double scale, double shift, struct placement *out)
{
  double q[4], square = 0; /* a quaternion */
  for (int k = 0; k < 4; k++) {
    q[k] = random_between(random, -1, 1);
    square += q[k] * q[k];
  }
  for (int k = 0; k < 4; k++) q[k] /= sqrt(square);
  const double w = q[0], x = q[1], y = q[2], z = q[3];
  const double M[3][3] = {{1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)},
                          {2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)},
                          {2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)}};
  for (int i = 0; i < 3; i++) {
    for (int j = 0; j < 3; j++) out->M[i][j] = scale * M[i][j];
    out->shift[i] = shift * random_between(random, -1, 1);
  }
}

void placement_apply(const struct placement *placement, const double p[3], double out[3])
{
  double moved[3];
  for (int i = 0; i < 3; i++) {
    const double *row = placement->M[i];
    moved[i] = row[0] * p[0] + row[1] * p[1] + row[2] * p[2] + placement->shift[i];
  }
  memcpy(out, moved, sizeof moved);
}

void model_place(struct closed_model *model, const struct placement *placement)
{
  for (size_t n = 0; n < model->count; n++)
    for (int k = 0; k < 16; k++) placement_apply(placement, model->P[n][k / 4][k % 4], model->P[n][k / 4][k % 4]);
}

void model_placed(void (*make)(struct closed_model *out), struct random *random, double scale, double shift, bool moved,
                  struct placed_model *out)
{
  make(&out->model);
  out->placed = out->model, out->moved = moved;
  placement_random(random, scale, shift, &out->placement);
  if (moved) model_place(&out->placed, &out->placement);
}

void placed_point(const struct placed_model *at, double point[3])
{
  if (at->moved) placement_apply(&at->placement, point, point);
}

static double cubic(const double c[4], double t, double *derivative)
{
  double s = 1 - t;
  double p0 = s * c[0] + t * c[1], p1 = s * c[1] + t * c[2], p2 = s * c[2] + t * c[3];
  double q0 = s * p0 + t * p1, q1 = s * p1 + t * p2;
  *derivative = 3 * (q1 - q0);
  return s * q0 + t * q1;
}

static void net_jet(const double P[4][4][3], double u, double v, double point[3], double du[3], double dv[3])
{
  for (int axis = 0; axis < 3; axis++) {
    double row[4], row_dv[4], mixed;
    for (int i = 0; i < 4; i++) {
      const double c[4] = {P[i][0][axis], P[i][1][axis], P[i][2][axis], P[i][3][axis]};
      row[i] = cubic(c, v, &row_dv[i]);
    }
    point[axis] = cubic(row, u, &du[axis]);
    dv[axis] = cubic(row_dv, u, &mixed);
  }
}

void net_point(const double P[4][4][3], double u, double v, double out_point[3])
{
  double du[3], dv[3];
  net_jet(P, u, v, out_point, du, dv);
}

void net_tangents(const double P[4][4][3], double u, double v, double out_u[3], double out_v[3])
{
  double point[3];
  net_jet(P, u, v, point, out_u, out_v);
}
