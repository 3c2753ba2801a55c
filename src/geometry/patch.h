/* The bicubic tensor-product Bezier patch, one coordinate at a time.
 *
 * A net is double[4][4] of one coordinate (or of any other function of the surface): net[i][j], u runs across the rows
 * i, v along a row j, S(u,v) = sum B_i(u) B_j(v) net[i][j] (paper eq 1, in Bernstein instead of power form). All
 * functions are pure and safe on any thread. Parameters are not clamped: outside [0,1] the polynomial continues.
 */
#ifndef PSCN_GEOMETRY_PATCH_H
#define PSCN_GEOMETRY_PATCH_H

#include <stdbool.h>
#include <stddef.h>
#include <string.h>

/* The net of the same polynomial over [u0,u1] x [v0,v1], by blossoming. Exact up to a few roundings relative to the
 * largest |net| if the range lies in [0,1]; with u0 = 0, u1 = 1 a copy. out may be net. */
void patch_subnet(double net[4][4], double u0, double u1, double v0, double v1, double out[4][4]);

/* Whether a border (numbered as in geometry/edges.h) is one point: its control points are equal numbers. */
bool patch_border_is_point(const double x[3][4][4], int border);

/* The least bidegree (m in u, n in v, each at least 1) that represents all three coordinate nets within `slack`
 * (absolute, in the nets' units) of every control value. */
void patch_bidegree(double x[3][4][4], double slack, int *out_m, int *out_n);

/* Degree-reduces a net for which patch_bidegree found bidegree (m,n): the first m+1 rows and n+1 columns of out are the
 * control net of that bidegree. out may be net. */
void patch_reduce(double net[4][4], int m, int n, double out[4][4]);

/* A unit normal at (u,v): Su x Sv; or, if that vanishes or is no longer than `rounded`, what rounding the control
 * points may make of it, its limit along the way into the patch. False if the surface has none (a patch collapsed to a
 * curve or point); out is then zero. */
bool patch_normal(double x[3][4][4], double u, double v, double rounded, double out[3]);

/* The 48 numbers of net `number`; nets begin at `nets`, `stride` bytes apart. */
static inline const double *net_at(const void *nets, size_t stride, size_t number)
{
  return (const double *)(const void *)((const char *)nets + number * stride);
}

/* The weights of a cubic's four control values in its value (w) and its derivative (dw) at t. */
static inline void patch_weights(double t, double w[4], double dw[4])
{
  const double s = 1 - t, ss = s * s, tt = t * t, st = s * t;
  w[0] = ss * s, w[1] = 3 * ss * t, w[2] = 3 * st * t, w[3] = tt * t;
  dw[0] = -3 * ss, dw[1] = 3 * (ss - 2 * st), dw[2] = 3 * (2 * st - tt), dw[3] = 3 * tt;
}

/* Value and first partial derivatives at (u,v). */
struct patch_jet {
  double value, du, dv;
};

/* A row of the net: compilers keep it in one or two registers. */
typedef double patch_row __attribute__((vector_size(32)));

static inline struct patch_jet patch_evaluate(double net[4][4], double u, double v)
{
  double wu[4], du[4], wv[4], dv[4];
  patch_weights(u, wu, du);
  patch_weights(v, wv, dv);
  patch_row across = {0}, across_du = {0};
  for (int i = 0; i < 4; i++) {
    patch_row r;
    memcpy(&r, net[i], sizeof r);
    across += wu[i] * r;
    across_du += du[i] * r;
  }
  struct patch_jet jet = {0, 0, 0};
  for (int j = 0; j < 4; j++) {
    jet.value += across[j] * wv[j];
    jet.du += across_du[j] * wv[j];
    jet.dv += across[j] * dv[j];
  }
  return jet;
}

/* ---- a patch's control points as they stand in a scene: P[i][j], u runs across the rows i ---- */

/* The least and the largest of each coordinate. */
typedef void points_range_function(const double P[4][4][3], double out_lo[3], double out_hi[3]);
points_range_function points_range;

/* The nets of the coordinates in the frame (P - center) unit: x[k], and rest[k], what rounding
 * the difference took away. Exact if unit is a power of two and nothing over- or underflows. Returns whether any of the
 * rest is not 0. */
typedef bool points_frame_function(const double P[4][4][3], const double center[3], double unit, double out_x[3][4][4],
                                   double out_rest[3][4][4]);
points_frame_function points_frame;

/* dS/du and dS/dv at (u,v), to roundings of the patch's size, wherever the patch is. */
typedef void points_tangents_function(const double P[4][4][3], double u, double v, double out_du[3], double out_dv[3]);
points_tangents_function points_tangents;

/* These, compiled once per instruction set, with the same bits: an AVX register holds a coordinate of a row of points, or
 * a point. */
points_range_function points_range_baseline, points_range_avx2;
points_frame_function points_frame_baseline, points_frame_avx2;
points_tangents_function points_tangents_baseline, points_tangents_avx2;

#endif
