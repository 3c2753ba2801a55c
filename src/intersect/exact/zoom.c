/* A ray through a patch under the glass. See zoom.h. */
#include "intersect/exact/zoom.h"

#include <math.h>
#include <string.h>

#include "intersect/certificate.h"

/* A value of a or b passes at most this many roundings on the way from the control points to a combination's
 * coefficient over a box: local net 2, moment and plane 6, to powers 2 x 5, to the box 2 x 9, combination 3; each on
 * terms that sum up to no more than POWER_GROWTH times the largest value a control point gives, for sum |power| <= 5
 * of a cubic with |b| <= 1, and inside the square the box's terms sum up to no more. */
#define ZOOM_ROUNDINGS 40
#define POWER_GROWTH 25

/* Roundings, in double, of what is left of a combination scaled to a sum of 1: conversion 1, to Bernstein form 2 x
 * 4. */
#define ZOOMED_ROUNDINGS 10

static wide wide_abs(wide a) { return a < 0 ? -a : a; }
static wide wide_max(wide a, wide b) { return a > b ? a : b; }

/* Bernstein coefficients with the stride to powers of s = 2t - 1. */
static void to_powers(wide *b, int stride)
{
  const wide b0 = b[0], b1 = b[stride], b2 = b[2 * stride], b3 = b[3 * stride], eighth = (wide)0.125;
  b[0] = eighth * ((b0 + b3) + 3 * (b1 + b2));
  b[stride] = 3 * eighth * ((b3 - b0) + (b2 - b1));
  b[2 * stride] = 3 * eighth * ((b0 + b3) - (b1 + b2));
  b[3 * stride] = eighth * ((b3 - b0) - 3 * (b2 - b1));
}

/* (q_i d_k - q_k d_i)/d_k for q = (origin - center)/scale, and adds to `size` what its roundings are relative to. Either
 * of the differences, or of the products of 106 bits, where those nearly cancel far from the scene's origin. */
static wide wide_moment(const struct model_patch *patch, const struct ray *ray, int i, int k, wide *size)
{
  const double *d = ray->direction, *o = ray->origin;
  const wide slope = (wide)d[i] / d[k], to_local = 1 / (wide)patch->scale; /* a power of two */
  const wide qi = ((wide)o[i] - patch->center[i]) * to_local, qk = ((wide)o[k] - patch->center[k]) * to_local;
  const wide line = ((wide)o[i] * d[k] - (wide)o[k] * d[i]) / d[k] * to_local;
  const wide ci = patch->center[i] * to_local, ck = patch->center[k] * to_local;
  const wide by_start = wide_abs(qi) + wide_abs(qk), by_line = wide_abs(line) + wide_abs(ci) + wide_abs(ck);
  *size = wide_max(*size, 2 + (by_line < by_start ? by_line : by_start));
  return by_line < by_start ? line - (ci - slope * ck) : qi - slope * qk;
}

void zoom_start(const struct model_patch *patch, double (*P)[4][3], const struct ray *ray, int k, struct zoom *out)
{
  const double *d = ray->direction;
  wide size = 0;
  const wide to_local = 1 / (wide)patch->scale; /* a power of two */
  for (int s = 0; s < 3; s++) {
    const int i = (k + 1 + s) % 3;
    const wide slope = (wide)d[i] / d[k], moment = s < 2 ? wide_moment(patch, ray, i, k, &size) : 0;
    for (int n = 0; n < 16; n++) {
      const double *p = P[n / 4][n % 4];
      const wide x = ((wide)p[i] - patch->center[i]) * to_local, y = ((wide)p[k] - patch->center[k]) * to_local;
      out->power[s][n / 4][n % 4] = s == 2 ? y : x - slope * y - moment;
    }
    for (int n = 0; n < 4; n++) to_powers(out->power[s][n], 1);
    for (int n = 0; n < 4; n++) to_powers(&out->power[s][0][n], 4);
  }
  out->origin = ((wide)ray->origin[k] - patch->center[k]) * to_local, out->to_t = (wide)patch->scale / d[k];
  out->error = WIDE_ROUNDOFF * ZOOM_ROUNDINGS * POWER_GROWTH * size;
}

/* The polynomial of s with powers c, as powers of r for s = middle + half r. */
static void move(wide *c, int stride, wide middle, wide half)
{
  for (int n = 0; n < 3; n++)
    for (int k = 2; k >= n; k--) c[k * stride] += middle * c[(k + 1) * stride];
  wide power = half;
  for (int k = 1; k < 4; k++) c[k * stride] *= power, power *= half;
}

/* Powers of r in [-1,1] to Bernstein coefficients there. */
static void to_bernstein(double *c, int stride)
{
  const double c0 = c[0], c1 = c[stride], c2 = c[2 * stride], c3 = c[3 * stride], third = 1.0 / 3;
  c[0] = (c0 + c2) - (c1 + c3), c[3 * stride] = (c0 + c2) + (c1 + c3);
  c[stride] = (c0 - third * c2) - (third * c1 - c3), c[2 * stride] = (c0 - third * c2) + (third * c1 - c3);
}

static void net_of(wide power[4][4], wide factor, double out[4][4])
{
  for (int n = 0; n < 16; n++) out[n / 4][n % 4] = (double)(power[n / 4][n % 4] * factor);
  for (int n = 0; n < 4; n++) to_bernstein(out[n], 1);
  for (int n = 0; n < 4; n++) to_bernstein(&out[0][n], 4);
}

/* The combination p a + q b as powers; returns the sum of their sizes. */
static wide combine(wide a[4][4], wide b[4][4], double p, double q, wide out[4][4])
{
  wide sum = 0;
  for (int i = 0; i < 4; i++)
    for (int j = 0; j < 4; j++) out[i][j] = p * a[i][j] + q * b[i][j], sum += wide_abs(out[i][j]);
  return sum;
}

/* The ray's polynomials over the box, as powers of its own parameters in [-1,1]. */
static void box_powers(const struct zoom *zoom, const wide low[2], const wide size[2], wide c[3][4][4])
{
  memcpy(c, zoom->power, sizeof zoom->power);
  for (int s = 0; s < 3; s++) {
    for (int n = 0; n < 4; n++) move(&c[s][0][n], 4, 2 * low[0] + size[0] - 1, size[0]);
    for (int n = 0; n < 4; n++) move(c[s][n], 1, 2 * low[1] + size[1] - 1, size[1]);
  }
}

/* The net of x_k, less the middle's. */
static void set_depth(const struct zoom *zoom, wide power[4][4], struct zoomed *out)
{
  out->start = power[0][0] - zoom->origin;
  power[0][0] = 0;
  net_of(power, 1, out->net[2]);
}

bool zoom_box(const struct zoom *zoom, const wide low[2], const wide size[2], struct zoomed *out)
{
  wide c[3][4][4];
  box_powers(zoom, low, size, c);
  /* The combination whose first derivatives vanish, as nearly as they can, in the middle: the row of the adjugate
   * Jacobian that is the larger; and the one across it. Rounded rows are as good: both combinations are formed with
   * what they are. */
  const double au = (double)c[0][1][0], av = (double)c[0][0][1], bu = (double)c[1][1][0], bv = (double)c[1][0][1];
  const bool by_v = fabs(bv) + fabs(av) > fabs(bu) + fabs(au);
  double p = by_v ? bv : bu, q = by_v ? -av : -au;
  const double largest = fmax(fabs(p), fabs(q));
  if (!(largest > 0)) return false;
  p /= largest, q /= largest;
  const double rows[2][2] = {{p, q}, {-q, p}};
  for (int s = 0; s < 2; s++) {
    wide combination[4][4];
    const wide sum = combine(c[0], c[1], rows[s][0], rows[s][1], combination), error = 2 * zoom->error;
    if (!(sum > error)) return false;
    net_of(combination, 1 / sum, out->net[s]);
    out->error[s] = (double)(error / sum) + ZOOMED_ROUNDINGS * UNIT_ROUNDOFF;
  }
  set_depth(zoom, c[2], out);
  return true;
}

/* Powers of r in [-1,1] to Bernstein coefficients there, all of a net. */
static void wide_net(wide c[4][4])
{
  for (int n = 0; n < 8; n++) {
    wide *b = n < 4 ? c[n] : &c[0][n - 4];
    const int stride = n < 4 ? 1 : 4;
    const wide c0 = b[0], c1 = b[stride], c2 = b[2 * stride], c3 = b[3 * stride];
    b[0] = (c0 + c2) - (c1 + c3), b[3 * stride] = (c0 + c2) + (c1 + c3);
    b[stride] = (c0 - c2 / 3) - (c1 / 3 - c3), b[2 * stride] = (c0 - c2 / 3) + (c1 / 3 - c3);
  }
}

/* The net, which is 0 along the border, divided by the distance to it, as a net of its own degree again: with b_k for
 * the coefficients away from the border, those of the quotient are 3 b_k/k, k = 1..3. */
static void divide_by_distance(wide net[4][4], int border)
{
  for (int n = 0; n < 4; n++) {
    wide *b = border < 2 ? &net[0][n] : net[n], q[3];
    const int stride = border < 2 ? 4 : 1;
    for (int k = 1; k < 4; k++) q[k - 1] = 3 * b[(border & 1 ? 3 - k : k) * stride] / k;
    for (int k = 0; k < 4; k++)
      b[(border & 1 ? 3 - k : k) * stride] = ((k > 0 ? k * q[k - 1] : 0) + (k < 3 ? (3 - k) * q[k] : 0)) / 3;
  }
}

/* A pole is passed where the ray's distance from it is this many times what rounding leaves unknown of it: then the
 * quotient below is right to 2^-22 of its size, and its slope to 2^-8, at roots no nearer to the border than
 * ZOOM_POLE_NEAREST. */
#define POLE_PRECISION (ZOOM_POLE_REACH / 4)

/* Scales the net to a largest coefficient of 1; false where its error is larger. */
static bool scaled_net(wide net[4][4], wide error, wide met, int k, struct zoomed *out)
{
  wide size = 0;
  for (int n = 0; n < 16; n++) size = wide_max(size, wide_abs(net[n / 4][n % 4]));
  if (!(size > error)) return false;
  for (int n = 0; n < 16; n++) out->net[k][n / 4][n % 4] = (double)(net[n / 4][n % 4] / size);
  out->error[k] = (double)(error / size) + ZOOMED_ROUNDINGS * UNIT_ROUNDOFF;
  out->met[k] = (double)(met / size) / ZOOM_POLE_MET;
  return true;
}

bool zoom_pole_box(const struct zoom *zoom, const wide low[2], const wide size[2], int border, struct zoomed *out,
                   enum zoom_pole *out_pole)
{
  wide c[3][4][4], net[2][4][4];
  box_powers(zoom, low, size, c);
  wide_net(c[0]), wide_net(c[1]);
  const int at = border == 1 ? 12 : border == 3 ? 3 : 0;
  const wide a0 = c[0][at / 4][at % 4], b0 = c[1][at / 4][at % 4], distance = wide_max(wide_abs(a0), wide_abs(b0));
  const wide error = 4 * zoom->error;
  *out_pole = distance > POLE_PRECISION * error ? POLE_PASSED : POLE_MET;
  const wide p = *out_pole == POLE_PASSED ? a0 / distance : 1, q = *out_pole == POLE_PASSED ? b0 / distance : 0;
  for (int n = 0; n < 16; n++) {
    const wide a = c[0][n / 4][n % 4], b = c[1][n / 4][n % 4];
    net[0][n / 4][n % 4] = q * a - p * b, net[1][n / 4][n % 4] = p * a + q * b;
  }
  divide_by_distance(net[0], border);
  if (*out_pole == POLE_MET) divide_by_distance(net[1], border);
  /* The quotient's coefficients are off by three times as much; and by what the combination is not 0 along the border,
   * over the least distance at which a root can be, where the other combination is not 0 yet: that is by the same part
   * of its size. */
  wide slope = 0;
  for (int n = 0; n < 16; n++) slope = wide_max(slope, wide_abs(net[1][n / 4][n % 4] - (p * a0 + q * b0)));
  const wide away = *out_pole == POLE_PASSED ? error * 4 * slope / distance : 0;
  if (!scaled_net(net[0], 6 * error + away, distance, 0, out) || !scaled_net(net[1], 6 * error, distance, 1, out))
    return false;
  set_depth(zoom, c[2], out);
  return true;
}

/* Value and derivatives of a polynomial of (x, y) by its powers. */
static void evaluate(wide c[4][4], wide x, wide y, wide *value, wide *dx, wide *dy)
{
  *value = *dx = *dy = 0;
  for (int i = 3; i >= 0; i--) {
    wide row = 0, row_dy = 0;
    for (int j = 3; j >= 0; j--) row_dy = row_dy * y + row, row = row * y + c[i][j];
    *dx = *dx * x + *value, *value = *value * x + row, *dy = *dy * x + row_dy;
  }
}

/* The weights of a cubic's control values, and of their differences in the derivative. */
static void wide_weights(wide t, wide w[4], wide dw[3])
{
  const wide s = 1 - t;
  w[0] = s * s * s, w[1] = 3 * s * s * t, w[2] = 3 * s * t * t, w[3] = t * t * t;
  dw[0] = 3 * s * s, dw[1] = 6 * s * t, dw[2] = 3 * t * t;
}

bool wide_normal(double (*P)[4][3], wide u, wide v, double out[3])
{
  wide wu[4], du[3], wv[4], dv[3], su[3] = {0}, sv[3] = {0}, n[3], size = 0;
  wide_weights(u, wu, du);
  wide_weights(v, wv, dv);
  for (int c = 0; c < 3; c++) {
    for (int i = 0; i < 3; i++) {
      for (int j = 0; j < 4; j++) {
        su[c] += du[i] * wv[j] * ((wide)P[i + 1][j][c] - P[i][j][c]);
        sv[c] += wu[j] * dv[i] * ((wide)P[j][i + 1][c] - P[j][i][c]);
      }
    }
  }
  for (int c = 0; c < 3; c++) {
    n[c] = su[(c + 1) % 3] * sv[(c + 2) % 3] - su[(c + 2) % 3] * sv[(c + 1) % 3];
    size = wide_max(size, wide_abs(n[c]));
  }
  if (!(size > 0)) return false;
  for (int c = 0; c < 3; c++) out[c] = (double)(n[c] / size);
  const double length = sqrt(out[0] * out[0] + out[1] * out[1] + out[2] * out[2]);
  for (int c = 0; c < 3; c++) out[c] /= length;
  return true;
}

wide zoom_t(struct zoom *zoom, wide u, wide v)
{
  wide depth, unused[2];
  evaluate(zoom->power[2], 2 * u - 1, 2 * v - 1, &depth, &unused[0], &unused[1]);
  return (depth - zoom->origin) * zoom->to_t;
}

/* Bounds on the second derivatives of the polynomial with these powers, as `s` of struct bend, where x and y reach
 * LEAF_MARGIN beyond the patch. */
static double second_bound(wide c[4][4])
{
  const double r = 1 + 2 * LEAF_MARGIN, power[4] = {1, r, r * r, r * r * r};
  double sum = 0;
  for (int i = 0; i < 4; i++) {
    for (int j = 0; j < 4; j++) {
      const double size = fabs((double)c[i][j]);
      if (i > 1) sum += i * (i - 1) * power[i - 2] * power[j] * size;
      if (i > 0 && j > 0) sum += 2 * i * j * power[i - 1] * power[j - 1] * size;
      if (j > 1) sum += j * (j - 1) * power[i] * power[j - 2] * size;
    }
  }
  return sum;
}

/* Newton's process ends when a step is no shorter than half the one before, that is in rounding. It starts within the
 * root's radius, where it converges quadratically but for the first few steps next to a pole. */
enum { SHARPEN_STEPS = 24 };

/* The process from (x,y): where it ends, its last step, and the rows of the inverse Jacobian there. */
static bool newton(struct zoom *zoom, wide *x, wide *y, double *out_step, double m[2][2])
{
  double before = INFINITY;
  for (int n = 0; n < SHARPEN_STEPS; n++) {
    wide a, ax, ay, b, bx, by;
    evaluate(zoom->power[0], *x, *y, &a, &ax, &ay);
    evaluate(zoom->power[1], *x, *y, &b, &bx, &by);
    const wide determinant = ax * by - ay * bx;
    if (determinant == 0) return false;
    const wide step_x = (by * a - ay * b) / determinant, step_y = (ax * b - bx * a) / determinant;
    *x -= step_x, *y -= step_y;
    if (!(wide_abs(*x) <= 1 + 2 * LEAF_MARGIN && wide_abs(*y) <= 1 + 2 * LEAF_MARGIN)) return false;
    *out_step = (double)wide_max(wide_abs(step_x), wide_abs(step_y));
    m[0][0] = (double)(by / determinant), m[0][1] = (double)(-ay / determinant);
    m[1][0] = (double)(-bx / determinant), m[1][1] = (double)(ax / determinant);
    if (*out_step == 0 || (n > 4 && *out_step > before / 2)) return true;
    before = *out_step;
  }
  return true;
}

bool zoom_sharpen(struct zoom *zoom, struct exact_root *root)
{
  wide x = 2 * root->u - 1, y = 2 * root->v - 1;
  double step, m[2][2], radius[2];
  if (!newton(zoom, &x, &y, &step, m)) return false;
  const double second[2] = {second_bound(zoom->power[0]), second_bound(zoom->power[1])};
  const double error = (double)zoom->error;
  double size = 0, bend = 0;
  for (int k = 0; k < 2; k++) {
    size = fmax(size, fabs(m[k][0]) + fabs(m[k][1]));
    bend = fmax(bend, fabs(m[k][0]) * second[0] + fabs(m[k][1]) * second[1]);
  }
  const wide u = (1 + x) / 2, v = (1 + y) / 2;
  if (!certificate_holds(bend, step, size * error)) {
    if (wide_abs(u - root->u) <= root->radius_u && wide_abs(v - root->v) <= root->radius_v)
      root->u = u, root->v = v, root->t = zoom_t(zoom, u, v);
    return false;
  }
  for (int k = 0; k < 2; k++)
    radius[k] = certificate_radius(fabs(m[k][0]) * second[0] + fabs(m[k][1]) * second[1], step,
                                   (fabs(m[k][0]) + fabs(m[k][1])) * error) /
                2;
  /* Both enclosures hold one root each: it is the same where one holds the other. */
  if (!((double)wide_abs(u - root->u) + radius[0] <= root->radius_u &&
        (double)wide_abs(v - root->v) + radius[1] <= root->radius_v))
    return false;
  wide depth, dx, dy;
  evaluate(zoom->power[2], x, y, &depth, &dx, &dy);
  const double rx = 2 * radius[0], ry = 2 * radius[1], reach = rx + ry;
  const double off = fabs((double)dx) * rx + fabs((double)dy) * ry + error +
                     second_bound(zoom->power[2]) * reach * reach;
  root->u = u, root->v = v, root->t = (depth - zoom->origin) * zoom->to_t;
  root->radius_u = radius[0], root->radius_v = radius[1];
  /* The certificate's map contracts as far as bend |w - z| and rounding make less than 1, where bend holds. */
  const double here = (double)wide_max(wide_abs(x), wide_abs(y));
  root->alone = fmax(fmin(0.5 / bend, 1 + 2 * LEAF_MARGIN - here) / 2 - step, 0);
  root->t_error = fabs((double)zoom->to_t) * off + 8 * (double)(WIDE_ROUNDOFF * wide_abs(root->t));
  root->sharp = true;
  return true;
}
