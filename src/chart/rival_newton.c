/* Newton's method in two dimensions from the middle of every part whose box the ray meets (O. Abert, M. Geimer, S.
 * Muller, "Direct and Fast Ray Tracing of NURBS Surfaces", 2006). What it does not find is lost. */
#include <math.h>

#include "chart/rivals.h"
#include "geometry/patch.h"

#define LAST_STEP 1e-8 /* of a parameter: the remaining error is of the order of its square */
#define ASTRAY 4.0     /* from the middle: farther iterates are given up */

enum { STEPS = 6 };

int rival_newton(double a[4][4], double b[4][4], struct rival_root out[RIVAL_ROOTS])
{
  double u = 0.5, v = 0.5, step = INFINITY;
  for (int n = 0; n < STEPS && step > LAST_STEP; n++) {
    const struct patch_jet f = patch_evaluate(a, u, v), g = patch_evaluate(b, u, v);
    const double inverse = 1 / (f.du * g.dv - f.dv * g.du);
    const double du = (f.value * g.dv - g.value * f.dv) * inverse, dv = (g.value * f.du - f.value * g.du) * inverse;
    u -= du, v -= dv, step = fmax(fabs(du), fabs(dv));
    if (!(fabs(u - 0.5) < ASTRAY && fabs(v - 0.5) < ASTRAY)) return 0;
  }
  if (!(step <= LAST_STEP && fabs(u - 0.5) <= 0.5 + RIVAL_EDGE && fabs(v - 0.5) <= 0.5 + RIVAL_EDGE)) return 0;
  out[0] = (struct rival_root){u, v};
  return 1;
}
