/* Chooses the processor's best kernel. */
#include "geometry/control_points.h"

#include "base/kernel.h"

void points_range(const double P[4][4][3], double out_lo[3], double out_hi[3])
{
  KERNEL_BEST(points_range)(P, out_lo, out_hi);
}

bool points_frame(const double P[4][4][3], const double center[3], double unit, double out_x[3][4][4],
                  double out_rest[3][4][4])
{
  return KERNEL_BEST(points_frame)(P, center, unit, out_x, out_rest);
}

void points_tangents(const double P[4][4][3], double u, double v, double out_du[3], double out_dv[3])
{
  KERNEL_BEST(points_tangents)(P, u, v, out_du, out_dv);
}
