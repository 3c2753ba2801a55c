/* The derivatives of a bicubic patch at a point of it. */
#ifndef PSCN_GEOMETRY_TANGENTS_H
#define PSCN_GEOMETRY_TANGENTS_H

/* dS/du and dS/dv at (u,v) of the patch of the control points P[i][j], u runs across the rows i; to roundings of its size,
 * wherever it is. The same bits on every processor. Any thread. */
void patch_tangents(const double P[4][4][3], double u, double v, double out_du[3], double out_dv[3]);

#endif
