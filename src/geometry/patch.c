/* The bicubic Bezier patch: subdivision, evaluation, degree, normal.
 *
 * Farin, Curves and Surfaces for CAGD: de Casteljau's algorithm, blossoms, degree reduction. A cubic over [t0,t1]
 * has the control values b(t0,t0,t0), b(t0,t0,t1), b(t0,t1,t1), b(t1,t1,t1) of its blossom b.
 */
#include "geometry/patch.h"

#include <math.h>
#include <string.h>

#include "base/real.h"
#include "geometry/edges.h"
#include "geometry/vector.h"

/* (1-t) a + t b for four numbers; exact at t = 0 and t = 1, and where a = b. */
static void mix(const double a[4], const double b[4], double t, double out[4])
{
  if (t == 1) memcpy(out, b, 4 * sizeof *out);
  else
    for (int k = 0; k < 4; k++) out[k] = a[k] + t * (b[k] - a[k]);
}

/* Four cubics side by side, c[i] their i-th control values, over [t0,t1]. */
static void cubics_range(double c[4][4], double t0, double t1)
{
  double low[3][4], high[3][4], lower[2][4], between[2][4], higher[2][4];
  if (t0 == 0 && t1 == 1) return;
  for (int k = 0; k < 3; k++) mix(c[k], c[k + 1], t0, low[k]), mix(c[k], c[k + 1], t1, high[k]);
  for (int k = 0; k < 2; k++) {
    mix(low[k], low[k + 1], t0, lower[k]), mix(low[k], low[k + 1], t1, between[k]);
    mix(high[k], high[k + 1], t1, higher[k]);
  }
  mix(lower[0], lower[1], t0, c[0]), mix(lower[0], lower[1], t1, c[1]);
  mix(between[0], between[1], t1, c[2]), mix(higher[0], higher[1], t1, c[3]);
}

void patch_subnet(double net[4][4], double u0, double u1, double v0, double v1, double out[4][4])
{
  double turned[4][4];
  for (int n = 0; n < 16; n++) turned[n / 4][n % 4] = net[n % 4][n / 4];
  cubics_range(turned, v0, v1);
  for (int n = 0; n < 16; n++) out[n / 4][n % 4] = turned[n % 4][n / 4];
  cubics_range(out, u0, u1);
}

/* Reduces a cubic whose true degree is `degree` to that degree's Bezier form. */
static void cubic_reduce(const double c[4], int degree, double out[4])
{
  const double first = c[0], last = c[3];
  if (degree == 2) {
    /* Both one-sided answers are exact for a true quadratic; their mean spreads the rounding evenly. */
    out[1] = 0.25 * (3 * (c[1] + c[2]) - c[0] - c[3]);
    out[0] = first, out[2] = last;
  } else if (degree == 1) {
    out[0] = first, out[1] = last;
  } else {
    out[0] = first, out[1] = c[1], out[2] = c[2], out[3] = last;
  }
}

/* How far the cubic is from the elevation of its reduction to `degree`. */
static double cubic_excess(const double c[4], int degree)
{
  double r[4];
  cubic_reduce(c, degree, r);
  if (degree == 2) return real_max(fabs(c[1] - (r[0] + 2 * r[1]) / 3), fabs(c[2] - (2 * r[1] + r[2]) / 3));
  return real_max(fabs(c[1] - (2 * r[0] + r[1]) / 3), fabs(c[2] - (r[0] + 2 * r[1]) / 3));
}

bool patch_border_is_point(const double x[3][4][4], int border)
{
  for (int c = 0; c < 3; c++)
    for (int n = 1; n < 4; n++)
      if ((&x[c][0][0])[edge_at(border, n)] != (&x[c][0][0])[edge_at(border, 0)]) return false;
  return true;
}

void patch_bidegree(double x[3][4][4], double slack, int *out_m, int *out_n)
{
  bool u[3] = {true, true, true}, v[3] = {true, true, true}; /* whether that degree is enough */
  for (int n = 0; n < 12 && (u[1] || u[2] || v[1] || v[2]); n++) {
    double(*net)[4] = x[n / 4];
    const int i = n % 4;
    const double column[4] = {net[0][i], net[1][i], net[2][i], net[3][i]};
    for (int degree = 1; degree <= 2; degree++) {
      u[degree] = u[degree] && cubic_excess(column, degree) <= slack;
      v[degree] = v[degree] && cubic_excess(net[i], degree) <= slack;
    }
  }
  *out_m = u[1] ? 1 : u[2] ? 2 : 3;
  *out_n = v[1] ? 1 : v[2] ? 2 : 3;
}

void patch_reduce(double net[4][4], int m, int n, double out[4][4])
{
  double rows[4][4] = {{0}};
  for (int i = 0; i < 4; i++) cubic_reduce(net[i], n, rows[i]);
  for (int j = 0; j < 4; j++) {
    const double column[4] = {rows[0][j], rows[1][j], rows[2][j], rows[3][j]};
    double cut[4] = {0};
    cubic_reduce(column, m, cut);
    for (int i = 0; i < 4; i++) out[i][j] = cut[i];
  }
}

/* The Bernstein polynomials of degree n = 1, 2 or 3 at t. */
static void bernstein(int n, double t, double w[4])
{
  const double s = 1 - t;
  if (n == 1) w[0] = s, w[1] = t;
  if (n == 2) w[0] = s * s, w[1] = 2 * s * t, w[2] = t * t;
  if (n == 3) w[0] = s * s * s, w[1] = 3 * s * s * t, w[2] = 3 * s * t * t, w[3] = t * t * t;
}

/* The partial derivative of order (p,q), p + q <= 2, as a vector. It is made from differences of control points, which
 * are exactly zero along a collapsed edge, so that what vanishes with the distance to the edge keeps its relative
 * accuracy. */
static void derivative(double x[3][4][4], double u, double v, int p, int q, double out[3])
{
  static const double factor[3] = {1, 3, 6};
  double wu[4], wv[4];
  bernstein(3 - p, u, wu);
  bernstein(3 - q, v, wv);
  for (int k = 0; k < 3; k++) {
    double d[4][4];
    memcpy(d, x[k], sizeof d);
    for (int n = 0; n < p; n++)
      for (int i = 0; i < 3 - n; i++)
        for (int j = 0; j < 4; j++) d[i][j] = d[i + 1][j] - d[i][j];
    for (int n = 0; n < q; n++)
      for (int i = 0; i < 4 - p; i++)
        for (int j = 0; j < 3 - n; j++) d[i][j] = d[i][j + 1] - d[i][j];
    out[k] = 0;
    for (int i = 0; i < 4 - p; i++)
      for (int j = 0; j < 4 - q; j++) out[k] += factor[p] * factor[q] * wu[i] * wv[j] * d[i][j];
  }
}

/* out = a x b + c x d; returns its length. */
static double cross_sum(const double a[3], const double b[3], const double c[3], const double d[3], double out[3])
{
  double x[3], y[3];
  vector_cross(a, b, x);
  vector_cross(c, d, y);
  vector_add_scaled(x, 1, y, out);
  return vector_length(out);
}

bool patch_normal(double x[3][4][4], double u, double v, double rounded, double out[3])
{
  /* A derivative is right to some tens of units in the last place of the net's extent; a product of two derivatives
   * that is less than this part of the squared extent is noise. */
  static const double noise = 0x1p-44;
  double extent = 0;
  for (int k = 0; k < 3; k++)
    for (int i = 0; i < 16; i++) extent = real_max(extent, fabs(x[k][i / 4][i % 4] - x[k][0][0]));
  const double least = real_max(noise * extent * extent, rounded), zero[3] = {0, 0, 0};
  double su[3], sv[3], suu[3], suv[3], svv[3], nu[3], nv[3];
  derivative(x, u, v, 1, 0, su);
  derivative(x, u, v, 0, 1, sv);
  double length = cross_sum(su, sv, zero, zero, out);
  if (!(length > least)) {
    /* Su x Sv vanishes here, as at a collapsed edge: its limit on the way into the patch is its derivative in that
     * direction. */
    derivative(x, u, v, 2, 0, suu);
    derivative(x, u, v, 1, 1, suv);
    derivative(x, u, v, 0, 2, svv);
    cross_sum(suu, sv, su, suv, nu);
    cross_sum(suv, sv, su, svv, nv);
    if (u > 0.5) vector_scale(-1, nu, nu);
    if (v > 0.5) vector_scale(-1, nv, nv);
    vector_add_scaled(nu, 1, nv, out);
    length = vector_length(out);
    if (!(length > least)) {
      /* That derivative vanishes, too, if Su and Sv do, as in a corner with two collapsed edges: the second-order
       * limit. */
      double nuv[3];
      cross_sum(suu, suv, suv, svv, out);
      vector_cross(suu, svv, nuv);
      vector_add_scaled(out, (u > 0.5) == (v > 0.5) ? 1 : -1, nuv, out);
      length = vector_length(out);
    }
  }
  if (!(length > least)) {
    out[0] = out[1] = out[2] = 0;
    return false;
  }
  vector_scale(1 / length, out, out);
  return true;
}
