/* The derivatives of a bicubic patch at a point of it. */
#ifndef PSCN_GEOMETRY_TANGENTS_H
#define PSCN_GEOMETRY_TANGENTS_H

/* dS/du and dS/dv at (u,v) of the patch of the control points P[i][j], u runs across the rows i; to roundings of its size,
 * wherever it is. The same bits on every processor. Any thread. */
typedef void tangents_function(const double P[4][4][3], double u, double v, double out_du[3], double out_dv[3]);
tangents_function patch_tangents;

/* That, compiled once per instruction set: with AVX the three coordinates of a point are one register. */
tangents_function patch_tangents_baseline, patch_tangents_avx2;

#endif
