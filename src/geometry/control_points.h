/* Ranges, frames and tangents from a patch's control points as they stand in a scene: P[i][j], u runs across the rows
 * i.
 *
 * The same bits on every processor. Safe on any thread.
 */
#ifndef PSCN_GEOMETRY_CONTROL_POINTS_H
#define PSCN_GEOMETRY_CONTROL_POINTS_H

#include <stdbool.h>

/* The least and the largest of each coordinate. */
typedef void points_range_function(const double P[4][4][3], double out_lo[3], double out_hi[3]);
points_range_function points_range;

/* The nets of the coordinates, as in geometry/patch.h, in the frame (P - center) unit: x[k], and rest[k], what rounding
 * the difference took away. Exact if unit is a power of two and nothing over- or underflows. Returns whether any of the
 * rest is not 0. */
typedef bool points_frame_function(const double P[4][4][3], const double center[3], double unit, double out_x[3][4][4],
                                   double out_rest[3][4][4]);
points_frame_function points_frame;

/* dS/du and dS/dv at (u,v), to roundings of the patch's size, wherever the patch is. */
typedef void points_tangents_function(const double P[4][4][3], double u, double v, double out_du[3], double out_dv[3]);
points_tangents_function points_tangents;

/* These, compiled once per instruction set: an AVX register holds a coordinate of a row of points, or a point. */
points_range_function points_range_baseline, points_range_avx2;
points_frame_function points_frame_baseline, points_frame_avx2;
points_tangents_function points_tangents_baseline, points_tangents_avx2;

#endif
