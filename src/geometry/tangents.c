/* Chooses for patch_tangents what the processor has. */
#include "geometry/tangents.h"

#include "base/kernel.h"
#include "geometry/tangents_kernel.h"

void patch_tangents(const double P[4][4][3], double u, double v, double out_du[3], double out_dv[3])
{
#if defined(PSCN_HAS_AVX2)
  if (KERNEL_RUNS_AVX2) {
    patch_tangents_avx2(P, u, v, out_du, out_dv);
    return;
  }
#endif
  patch_tangents_baseline(P, u, v, out_du, out_dv);
}
