/* See facts.h. */
#include "reference/facts.h"

#include <float.h>
#include <math.h>

static struct quad_net net_of(const double P[4][4][3], int axis)
{
  struct quad_net net;
  for (int k = 0; k < 16; k++) net.c[k / 4][k % 4] = P[k / 4][k % 4][axis];
  return net;
}

/* out = components of |M^-1| times terms, in double, from a quadruple-precision inverse. */
static void floor_bound(quad M[3][3], const double terms[3], double t, double u, double v, struct facts_floor *out)
{
  quad determinant = 0;
  for (int k = 0; k < 3; k++)
    determinant += M[0][k] * (M[1][(k + 1) % 3] * M[2][(k + 2) % 3] - M[1][(k + 2) % 3] * M[2][(k + 1) % 3]);
  quad moved[3] = {0}; /* at the ends of the doubles' range not even the inverse exists */
  for (int row = 0; row < 3; row++) {
    for (int column = 0; column < 3; column++) {
      const int r1 = (column + 1) % 3, r2 = (column + 2) % 3, c1 = (row + 1) % 3, c2 = (row + 2) % 3;
      const quad cofactor = M[r1][c1] * M[r2][c2] - M[r1][c2] * M[r2][c1];
      moved[row] += quad_abs(cofactor / determinant) * terms[column];
    }
  }
  out->u = DOUBLE_UNIT * (double)(moved[0] + fabs(u));
  out->v = DOUBLE_UNIT * (double)(moved[1] + fabs(v));
  out->t = DOUBLE_UNIT * (double)(moved[2] + fabs(t)) + DBL_TRUE_MIN;
}

void facts_find(const double P[4][4][3], const double origin[3], const double direction[3], quad t, quad u, quad v,
                struct facts *out)
{
  quad M[3][3], normal[3];
  double data[3], whole[3];
  for (int axis = 0; axis < 3; axis++) {
    const struct quad_net net = net_of(P, axis);
    struct quad_net sizes, spread;
    struct quad_jet jet = quad_net_jet(&net, u, v);
    for (int k = 0; k < 16; k++) {
      sizes.c[k / 4][k % 4] = quad_abs(net.c[k / 4][k % 4]);
      spread.c[k / 4][k % 4] = quad_abs(net.c[k / 4][k % 4] - jet.value);
    }
    M[axis][0] = jet.du;
    M[axis][1] = jet.dv;
    M[axis][2] = -(quad)direction[axis];
    data[axis] = (double)quad_net_jet(&sizes, u, v).value + fabs(origin[axis]) + fabs((double)t * direction[axis]);
    whole[axis] = (double)quad_net_magnitude(&spread);
  }
  floor_bound(M, data, (double)t, (double)u, (double)v, &out->data);
  floor_bound(M, whole, (double)t, (double)u, (double)v, &out->whole);

  quad square = 0, along = 0, length = 0, tangents[2] = {0};
  for (int axis = 0; axis < 3; axis++) {
    const int i = (axis + 1) % 3, j = (axis + 2) % 3;
    normal[axis] = M[i][0] * M[j][1] - M[j][0] * M[i][1];
    square += normal[axis] * normal[axis];
    along += normal[axis] * direction[axis];
    length += (quad)direction[axis] * direction[axis];
    for (int k = 0; k < 2; k++) tangents[k] += M[axis][k] * M[axis][k];
  }
  const quad norm = quad_sqrt(square);
  out->has_normal = norm > (quad)0x1p-60 * quad_max(tangents[0], tangents[1]);
  out->incidence = out->has_normal ? (double)(quad_abs(along) / (norm * quad_sqrt(length))) : 0;
  for (int axis = 0; axis < 3; axis++)
    out->normal[axis] = out->has_normal ? (double)((along > 0 ? -normal[axis] : normal[axis]) / norm) : 0;
}

double facts_residual(const double P[4][4][3], const double origin[3], const double direction[3], double t, double u,
                      double v)
{
  quad square = 0;
  for (int axis = 0; axis < 3; axis++) {
    const struct quad_net net = net_of(P, axis);
    const quad difference = quad_net_jet(&net, u, v).value - ((quad)origin[axis] + (quad)t * direction[axis]);
    square += difference * difference;
  }
  return (double)quad_sqrt(square);
}

double facts_length(const double a[3]) { return hypot(hypot(a[0], a[1]), a[2]); }
