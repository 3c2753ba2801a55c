/* patch_tangents (tangents.h), compiled once per instruction set: with AVX the three coordinates of a point are one register. */
#ifndef PSCN_GEOMETRY_TANGENTS_KERNEL_H
#define PSCN_GEOMETRY_TANGENTS_KERNEL_H

void patch_tangents_baseline(const double P[4][4][3], double u, double v, double out_du[3], double out_dv[3]);
void patch_tangents_avx2(const double P[4][4][3], double u, double v, double out_du[3], double out_dv[3]);

#endif
