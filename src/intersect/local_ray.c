/* A ray in the frame of one patch. */
#include "intersect/local_ray.h"

#include <math.h>

#include "base/double_double.h"

/* (q_i d_k - q_k d_i)/d_k */
static double moment(struct double_double qi, struct double_double qk, double di, double dk)
{
  const struct double_double p = dd_two_product(qi.hi, dk), r = dd_two_product(qk.hi, di), s = dd_two_sum(p.hi, -r.hi);
  return (s.hi + (s.lo + (p.lo - r.lo) + (qi.lo * dk - qk.lo * di))) / dk;
}

void local_ray_make(const struct model_patch *patch, const struct ray *ray, struct local_ray *out)
{
  const double *d = ray->direction;
  const int k = dominant_axis(d), i = (k + 1) % 3, j = (k + 2) % 3;
  const double inverse = 1 / patch->scale;
  struct double_double q[3];
  for (int c = 0; c < 3; c++) {
    q[c] = dd_two_sum(ray->origin[c], -patch->center[c]);
    q[c].hi *= inverse, q[c].lo *= inverse;
  }
  out->axis = k;
  out->slope[0] = d[i] / d[k], out->slope[1] = d[j] / d[k];
  out->moment[0] = moment(q[i], q[k], d[i], d[k]), out->moment[1] = moment(q[j], q[k], d[j], d[k]);
  out->start[0] = -q[k].hi, out->start[1] = -q[k].lo;
  out->to_t = patch->scale / d[k];
  out->error = PLANE_ERROR(fabs(out->moment[0]), fabs(out->moment[1]));
}

void local_ray_nets(const struct local_ray *ray, const double x[3][16], double a[16], double b[16], double w[16])
{
  const double *xk = x[ray->axis], *xi = x[(ray->axis + 1) % 3], *xj = x[(ray->axis + 2) % 3];
  for (int c = 0; c < 16; c++) {
    a[c] = (xi[c] - ray->moment[0]) - ray->slope[0] * xk[c];
    b[c] = (xj[c] - ray->moment[1]) - ray->slope[1] * xk[c];
    w[c] = xk[c];
  }
}
