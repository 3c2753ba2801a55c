/* A ray through a patch in fixed point: over the patch, and over boxes of it. See zoom.h. */
#include "intersect/exact/zoom.h"

#include <math.h>
#include <string.h>

#include "base/double_double.h"
#include "geometry/edges.h"
#include "intersect/local_ray.h"

/* The most roundings that a value of a or b undergoes from the control points to the coefficient of a combination over
 * a box: local net 3, slope 2, moment and plane 4, to powers 2 x 4, to the box 2 x 12, combination 3. Each is at most 2
 * units of a number below 1, or of one that is multiplied by at most MOST_MOMENT + 2. All terms of a value sum up to at
 * most POWER_GROWTH times the largest that a control point gives: a cubic with |b| <= 1 has sum |power| <= 7.2, as far
 * as LEAF_MARGIN outside the square. */
#define ZOOM_ROUNDINGS 44
#define POWER_GROWTH 52

/* The largest moment, times the plane's unit. */
#define MOST_MOMENT 1

/* Roundings, in double, of what is left of a combination scaled to a sum of 1, and of its value: conversion and scale
 * 3, to Bernstein form 2 x 4, weights of a value 2 x 5 and its sums 2 x 4. */
#define ZOOMED_ROUNDINGS 30

/* Converts Bernstein coefficients with that stride to powers of s = 2t - 1. */
static void to_powers(fixed *b, int stride)
{
  const fixed b0 = b[0], b1 = b[stride], b2 = b[2 * stride], b3 = b[3 * stride];
  b[0] = ((b0 + b3) + 3 * (b1 + b2)) / 8;
  b[stride] = 3 * ((b3 - b0) + (b2 - b1)) / 8;
  b[2 * stride] = 3 * ((b0 + b3) - (b1 + b2)) / 8;
  b[3 * stride] = ((b3 - b0) - 3 * (b2 - b1)) / 8;
}

/* Roundings of a moment, relative to the size that wide_moment sets. */
#define MOMENT_ROUNDINGS 10

/* (q_i d_k - q_k d_i)/d_k for q = (origin - center)/scale. Sets *size to what its roundings are relative to. It is
 * formed of the differences q, or, far from the scene's origin, of products of 106 bits where those nearly cancel. */
static wide wide_moment(const struct model_patch *patch, const struct ray *ray, int i, int k, wide slope, wide *size)
{
  const double *d = ray->direction, *o = ray->origin;
  const wide to_local = 1 / (wide)patch->scale; /* a power of two, so it may come in anywhere */
  const wide qi = (wide)o[i] - patch->center[i], qk = slope * ((wide)o[k] - patch->center[k]);
  const wide line = ((wide)o[i] * d[k] - (wide)o[k] * d[i]) / d[k];
  const wide ci = patch->center[i], ck = slope * patch->center[k];
  const wide by_start = wide_abs(qi) + wide_abs(qk), by_line = wide_abs(line) + wide_abs(ci) + wide_abs(ck);
  const bool nearly = by_line < by_start;
  *size = (nearly ? by_line : by_start) * to_local;
  return (nearly ? line - (ci - ck) : qi - qk) * to_local;
}

/* The coordinate in the patch's frame, times a power of two. */
static fixed local(const struct model_patch *patch, double p, int c, double unit)
{
  const struct double_double x = dd_two_sum(p, -patch->center[c]);
  return fixed_from(x.hi / patch->scale * unit) + fixed_from(x.lo / patch->scale * unit);
}

/* Units go no farther in either direction: the last places of the least doubles, multiplied by this, are still less
 * than FIXED_UNIT. A ray with a larger moment misses every patch, as does one with MOST_MOMENT. */
#define LARGEST_UNIT 0x1p900

/* The largest power of two by which a size of at most `largest` becomes no more than 1. */
static double unit_for(double largest)
{
  int exponent;
  frexp(largest, &exponent);
  return !(largest > 1 / LARGEST_UNIT) ? LARGEST_UNIT
         : !(largest < LARGEST_UNIT)   ? 1 / LARGEST_UNIT
                                       : ldexp(1, -exponent);
}

/* The plane of x_i and x_k loses as many digits as the ray is longer along i than along k, each relative to how far the
 * patch reaches that way: two such planes along a needle are one. If it is longer by this much, which still leaves all
 * the digits of a double, another k is taken. */
#define THIN 0x1p40

/* k for a ray and a patch that reaches this far from its center. */
static int axis_across(const struct ray *ray, const double reach[3], double scale)
{
  const double *d = ray->direction;
  const int longest = dominant_axis(d);
  int k = longest;
  for (int c = 0; c < 3; c++) {
    const double way = fabs(d[c]);
    const bool finite = way * LARGEST_UNIT > scale; /* t over x_c */
    if (c != longest && finite && way * reach[k] > fabs(d[k]) * reach[c] * (k == longest ? THIN : 1)) k = c;
  }
  return k;
}

void zoom_start(const struct model_patch *patch, double (*P)[4][3], const struct ray *ray, struct zoom *out)
{
  const double *d = ray->direction, rounding = 2 * FIXED_UNIT * ZOOM_ROUNDINGS * POWER_GROWTH * (MOST_MOMENT + 2);
  double *unit = out->unit, reach[3] = {0, 0, 0};
  for (int n = 0; n < 48; n++)
    reach[n % 3] = fmax(reach[n % 3], fabs(P[n / 12][n / 3 % 4][n % 3] - patch->center[n % 3]) / patch->scale);
  const int k = out->axis = axis_across(ray, reach, patch->scale);
  memcpy(out->pole, patch->pole, sizeof out->pole);
  unit[2] = unit_for(reach[k]);
  out->error = 0, out->depth_error = rounding / unit[2];
  for (int n = 0; n < 16; n++) out->power[2][n / 4][n % 4] = local(patch, P[n / 4][n % 4][k], k, unit[2]);
  for (int s = 0; s < 2; s++) {
    const int i = (k + 1 + s) % 3;
    const wide slope = (wide)d[i] / d[k];
    wide size, m = wide_moment(patch, ray, i, k, slope, &size);
    const wide slope_of_unit = slope / unit[2];
    unit[s] = unit_for(fmax(reach[i], fmax(fabs((double)slope_of_unit), fabs((double)m)))), m *= unit[s];
    const fixed unit_slope = fixed_from_wide(slope_of_unit * unit[s]);
    m = m > MOST_MOMENT ? MOST_MOMENT : m < -MOST_MOMENT ? -MOST_MOMENT : m;
    const fixed moment = fixed_from_wide(m);
    for (int n = 0; n < 16; n++)
      out->power[s][n / 4][n % 4] = local(patch, P[n / 4][n % 4][i], i, unit[s]) -
                                    fixed_product(unit_slope, out->power[2][n / 4][n % 4]) - moment;
    const wide from_wide = WIDE_ROUNDOFF * (unit[s] * MOMENT_ROUNDINGS * size + POWER_GROWTH);
    out->error = fmax(out->error, rounding + (double)from_wide);
  }
  for (int n = 0; n < 12; n++) to_powers(out->power[n / 4][n % 4], 1);
  for (int n = 0; n < 12; n++) to_powers(&out->power[n / 4][0][n % 4], 4);
  out->origin = ((wide)ray->origin[k] - patch->center[k]) / (wide)patch->scale;
  out->to_t = (wide)patch->scale / d[k];
}

/* Converts powers of s, coefficients c, to powers of r, for s = middle + half r. */
static void move(fixed *c, int stride, fixed middle, const fixed half[3])
{
  for (int n = 0; n < 3; n++)
    for (int k = 2; k >= n; k--) c[k * stride] += fixed_product(middle, c[(k + 1) * stride]);
  for (int k = 1; k < 4; k++) c[k * stride] = fixed_product(c[k * stride], half[k - 1]);
}

/* Converts powers of r in [-1,1] to Bernstein coefficients there. */
static void to_bernstein(double *c, int stride)
{
  const double c0 = c[0], c1 = c[stride], c2 = c[2 * stride], c3 = c[3 * stride], third = 1.0 / 3;
  c[0] = (c0 + c2) - (c1 + c3), c[3 * stride] = (c0 + c2) + (c1 + c3);
  c[stride] = (c0 - third * c2) - (third * c1 - c3), c[2 * stride] = (c0 - third * c2) + (third * c1 - c3);
}

static void net_of(fixed power[4][4], double factor, double out[4][4])
{
  for (int n = 0; n < 16; n++) out[n / 4][n % 4] = fixed_double(power[n / 4][n % 4]) * factor;
  for (int n = 0; n < 4; n++) to_bernstein(out[n], 1);
  for (int n = 0; n < 4; n++) to_bernstein(&out[0][n], 4);
}

/* The sum of the coefficients' sizes. */
static double size_sum(fixed power[4][4])
{
  double sum = 0;
  for (int n = 0; n < 16; n++) sum += fabs(fixed_double(power[n / 4][n % 4]));
  return sum;
}

/* The ray's polynomials over the box, in powers of its own parameters in [-1,1]. */
static void box_powers(const struct zoom *zoom, const wide low[2], const wide size[2], fixed c[3][4][4])
{
  fixed middle[2], half[2][3];
  for (int k = 0; k < 2; k++) {
    middle[k] = fixed_from_wide(2 * low[k] + size[k] - 1), half[k][0] = fixed_from_wide(size[k]);
    half[k][1] = fixed_product(half[k][0], half[k][0]), half[k][2] = fixed_product(half[k][1], half[k][0]);
  }
  memcpy(c, zoom->power, sizeof zoom->power);
  for (int n = 0; n < 12; n++) move(&c[n / 4][0][n % 4], 4, middle[0], half[0]);
  for (int n = 0; n < 12; n++) move(c[n / 4][n % 4], 1, middle[1], half[1]);
}

/* Sets the net of x_k, less that of the middle. */
static void set_depth(const struct zoom *zoom, fixed power[4][4], struct zoomed *out)
{
  out->start = fixed_wide(power[0][0]) / zoom->unit[2] - zoom->origin;
  power[0][0] = 0;
  net_of(power, 1 / zoom->unit[2], out->net[2]);
}

/* Divides the polynomial in powers of r, which is 0 at r = -1, or 1 if `high`, by r + 1, or r - 1. Its coefficients'
 * errors sum up to at most three times as much; the coefficients themselves, to no more than those of any box. */
static void divide_powers(fixed *c, int stride, bool high)
{
  const fixed c1 = c[stride], c2 = c[2 * stride], c3 = c[3 * stride], second = high ? c2 + c3 : c2 - c3;
  c[0] = high ? c1 + second : c1 - second, c[stride] = second, c[2 * stride] = c3, c[3 * stride] = 0;
}

int zoom_box(const struct zoom *zoom, const wide low[2], const wide size[2], const int zeros[4], struct zoomed *out)
{
  fixed c[3][4][4];
  double error = 2 * zoom->error;
  box_powers(zoom, low, size, c);
  for (int border = 0; border < 4; border++) {
    for (int n = 0; n < zeros[border]; n++, error *= 3)
      for (int k = 0; k < 8; k++)
        divide_powers(border < 2 ? &c[k / 4][0][k % 4] : c[k / 4][k % 4], border < 2 ? 4 : 1, border & 1);
  }
  /* The combination whose first derivatives in the middle are as near to 0 as possible: the larger row of the adjugate
   * Jacobian; and the one across it. Rounded rows are as good, because both combinations are formed with the rounded
   * ones. */
  const double au = fixed_double(c[0][1][0]), av = fixed_double(c[0][0][1]);
  const double bu = fixed_double(c[1][1][0]), bv = fixed_double(c[1][0][1]);
  const bool by_v = fabs(bv) + fabs(av) > fabs(bu) + fabs(au);
  double p = by_v ? bv : bu, q = by_v ? -av : -au;
  const double largest = fmax(fabs(p), fabs(q));
  p = largest > 0 ? p / largest : 1, q = largest > 0 ? q / largest : 0;
  const fixed rows[2][2] = {{fixed_from(p), fixed_from(q)}, {-fixed_from(q), fixed_from(p)}};
  int known = 0;
  for (int s = 0; s < 2; s++) {
    fixed combination[4][4];
    zoom_combine(c[0], c[1], rows[s][0], rows[s][1], combination);
    const double sum = size_sum(combination);
    if (!(sum > error)) continue;
    net_of(combination, 1 / sum, out->net[known]);
    out->error[known++] = error / sum + ZOOMED_ROUNDINGS * UNIT_ROUNDOFF;
  }
  if (known == 1) memcpy(out->net[1], out->net[0], sizeof out->net[0]), out->error[1] = out->error[0];
  set_depth(zoom, c[2], out);
  return known;
}

/* The same in fixed point, for a whole net. */
static void fixed_net(fixed c[4][4])
{
  const fixed third = fixed_from_wide((wide)1 / 3);
  for (int n = 0; n < 8; n++) {
    fixed *b = n < 4 ? c[n] : &c[0][n - 4];
    const int stride = n < 4 ? 1 : 4;
    const fixed c0 = b[0], c1 = b[stride], c2 = b[2 * stride], c3 = b[3 * stride];
    const fixed p = c0 - fixed_product(third, c2), q = fixed_product(third, c1) - c3;
    b[0] = (c0 + c2) - (c1 + c3), b[3 * stride] = (c0 + c2) + (c1 + c3);
    b[stride] = p - q, b[2 * stride] = p + q;
  }
}

/* Divides the net, which is 0 along the border, by the distance to the border. The result is a net of the same degree:
 * with coefficients b_k away from the border, the quotient has 3 b_k/k, k = 1..3, which are then raised in degree. */
static void divide_by_distance(fixed net[4][4], int border)
{
  const fixed third = fixed_from_wide((wide)1 / 3);
  const int step = edge_inward(border);
  for (int n = 0; n < 4; n++) {
    fixed *b = &net[0][0] + edge_at(border, n);
    const fixed b1 = b[step], b2 = b[2 * step], b3 = b[3 * step];
    b[0] = 3 * b1, b[step] = b1 + b2, b[2 * step] = b2 + fixed_product(third, b3), b[3 * step] = b3;
  }
}

/* A pole is passed if the ray's distance from it is this many times what rounding leaves unknown of it. The quotient
 * below is then right to 2^-22 of the other combination's slope at any root. How well its own slope is known is
 * pole.c's concern (CERTIFICATE_SLOPES). */
#define POLE_PRECISION (ZOOM_POLE_REACH / 4)

/* Scales the net to a largest coefficient of 1. Returns false if its error is larger. */
static bool scaled_net(fixed net[4][4], double error, double met, int k, struct zoomed *out)
{
  fixed largest = 0;
  for (int n = 0; n < 16; n++) largest = fixed_max(largest, fixed_size(net[n / 4][n % 4]));
  const double size = fixed_double(largest), scale = 1 / size;
  if (!(size > error)) return false;
  for (int n = 0; n < 16; n++) out->net[k][n / 4][n % 4] = fixed_double(net[n / 4][n % 4]) * scale;
  out->error[k] = error / size + ZOOMED_ROUNDINGS * UNIT_ROUNDOFF;
  out->met[k] = met / size;
  return true;
}

bool zoom_pole_box(const struct zoom *zoom, const wide low[2], const wide size[2], int border, struct zoomed *out,
                   enum zoom_pole *out_pole)
{
  fixed c[3][4][4], net[2][4][4];
  box_powers(zoom, low, size, c);
  fixed_net(c[0]), fixed_net(c[1]);
  const int at = edge_at(border, 0);
  const fixed a0 = c[0][at / 4][at % 4], b0 = c[1][at / 4][at % 4], far = fixed_max(fixed_size(a0), fixed_size(b0));
  const double error = 4 * zoom->error, distance = fixed_double(far);
  *out_pole = distance > POLE_PRECISION * error ? POLE_PASSED : POLE_MET;
  const bool passed = *out_pole == POLE_PASSED;
  const fixed p = fixed_from_wide(passed ? (wide)a0 / (wide)far : 1),
              q = passed ? fixed_from_wide((wide)b0 / (wide)far) : 0;
  for (int n = 0; n < 16; n++) {
    const fixed a = c[0][n / 4][n % 4], b = c[1][n / 4][n % 4];
    net[0][n / 4][n % 4] = fixed_product(q, a) - fixed_product(p, b);
    net[1][n / 4][n % 4] = fixed_product(p, a) + fixed_product(q, b);
  }
  /* The quotient's coefficients are off by three times as much. Besides, the combination is not quite 0 along the
   * border. No root is nearer than where the other combination may be 0. Over that least distance, this error makes
   * the same part of the other's slope as it is of the pole's distance. */
  const fixed along = fixed_product(p, a0) + fixed_product(q, b0);
  double slope = 0;
  for (int n = 0; n < 16; n++) slope = fmax(slope, fabs(fixed_double(net[1][n / 4][n % 4] - along)));
  divide_by_distance(net[0], border);
  if (!passed) divide_by_distance(net[1], border);
  const double away = passed ? error * 4 * slope / distance : 0;
  const double met = distance + error;
  if (!scaled_net(net[0], 6 * error + away, met, 0, out) || !scaled_net(net[1], 6 * error, met, 1, out)) return false;
  set_depth(zoom, c[2], out);
  return true;
}
