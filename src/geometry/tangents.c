/* Chooses for patch_tangents what the processor has. */
#include "geometry/tangents.h"

#include "base/kernel.h"

void patch_tangents(const double P[4][4][3], double u, double v, double out_du[3], double out_dv[3])
{
  KERNEL_BEST(patch_tangents)(P, u, v, out_du, out_dv);
}
