/* A ray in the frame of one patch. */
#include "intersect/local_ray.h"

#include <float.h>
#include <math.h>

#include "base/double_double.h"
#include "base/real.h"
#include "base/wide.h"

/* (q_i d_k - q_k d_i)/d_k */
static double moment(struct double_double qi, struct double_double qk, double di, double dk)
{
  const struct double_double p = dd_two_product(qi.hi, dk), r = dd_two_product(qk.hi, di), s = dd_two_sum(p.hi, -r.hi);
  return (s.hi + (s.lo + (p.lo - r.lo) + (qi.lo * dk - qk.lo * di))) / dk;
}

/* The largest power of two, at most 1, times which `largest` over `scale` does not overflow. */
static double unit_for(double largest, double scale)
{
  int exponent, scale_exponent;
  frexp(largest, &exponent);
  frexp(scale, &scale_exponent);
  const int excess = exponent - scale_exponent + 2 - DBL_MAX_EXP;
  return excess > 0 ? ldexp(1, -excess) : 1;
}

void local_ray_make(const struct model_patch *patch, const struct ray *ray, struct local_ray *out)
{
  const double *d = ray->direction;
  const int k = dominant_axis(d), i = (k + 1) % 3, j = (k + 2) % 3;
  struct double_double q[3];
  double largest = 0;
  for (int c = 0; c < 3; c++) {
    q[c] = dd_two_sum(ray->origin[c], -patch->center[c]);
    largest = real_max(largest, fabs(q[c].hi));
  }
  const double unit = unit_for(largest, patch->scale), inverse = unit / patch->scale;
  for (int c = 0; c < 3; c++) q[c].hi *= inverse, q[c].lo *= inverse;
  out->axis = k;
  out->slope[0] = d[i] / d[k], out->slope[1] = d[j] / d[k];
  out->moment[0] = moment(q[i], q[k], d[i], d[k]) / unit, out->moment[1] = moment(q[j], q[k], d[j], d[k]) / unit;
  out->depth = (struct depth_map){unit, {-q[k].hi, -q[k].lo}, patch->scale / d[k] / unit};
  const double far[2] = {MOMENT_ERROR(fabs(q[i].hi), fabs(q[k].hi * out->slope[0])),
                         MOMENT_ERROR(fabs(q[j].hi), fabs(q[k].hi * out->slope[1]))};
  out->error = PLANE_ERROR(fabs(out->moment[0]), fabs(out->moment[1])) + real_max(far[0], far[1]) / unit;
}

/* The point of the ray's line on the plane x_k = middle_k across its dominant axis k, minus `middle`. The line's
 * moments about the origin are differences of exact products. Returns t there. */
static wide line_at(const struct ray *ray, const double middle[3], wide out[3])
{
  const double *d = ray->direction, *o = ray->origin;
  const int k = dominant_axis(d);
  for (int n = 1; n < 3; n++) {
    const int i = (k + n) % 3;
    const wide moment = (wide)o[i] * d[k] - (wide)o[k] * d[i];
    out[i] = (moment + (wide)d[i] * middle[k]) / d[k] - middle[i];
  }
  out[k] = 0;
  return ((wide)middle[k] - o[k]) / d[k];
}

/* Beyond these nothing is met, and nothing overflows. */
#define FARTHEST_AT 0x1p30
#define FARTHEST_ENTRY 0x1p1000

static double cut_off(wide x, double most) { return x > most ? most : x < -most ? -most : (double)x; }

double local_ray_enter(const struct ray *ray, const double origin[3], double frame, double out_at[3])
{
  const double longest = fabs(ray->direction[dominant_axis(ray->direction)]);
  wide at[3];
  const wide unit = (wide)longest / frame, ahead = line_at(ray, origin, at) * unit, begin = ray->t_min * unit;
  const wide off = 4 * WIDE_ROUNDOFF * (wide_abs(ahead) + begin), start = begin - ahead - off;
  const wide past = start > -2 ? start : -2; /* the middle, in frames */
  for (int c = 0; c < 3; c++)
    out_at[c] = cut_off(at[c] / frame + past * (ray->direction[c] / (wide)longest), FARTHEST_AT);
  return cut_off(ahead + past, FARTHEST_ENTRY);
}

double local_ray_enter_copy(const struct ray *ray, const struct model_copy *copy, double out_at[3])
{
  wide at[3];
  const wide t = line_at(ray, copy->b, at);
  for (int j = 0; j < 3; j++) {
    wide sum = 0;
    for (int k = 0; k < 3; k++) sum += at[k] * copy->W[k][j];
    out_at[j] = (double)sum;
  }
  return (double)t;
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
