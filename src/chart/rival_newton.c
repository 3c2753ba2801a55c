/* Newton's method in two dimensions from the middle of every part whose box the ray meets (O. Abert, M. Geimer, S.
 * Muller, "Direct and Fast Ray Tracing of NURBS Surfaces", 2006). What it does not find is lost. */
#include "chart/rivals.h"

#define LAST_STEP 1e-8 /* of a parameter: the remaining error is of the order of its square */
#define ASTRAY 4.0     /* from the middle: farther iterates are given up */

enum { STEPS = 6 };

int rival_newton(double a[4][4], double b[4][4], struct rival_root out[RIVAL_ROOTS])
{
  struct rival_root at = {0.5, 0.5};
  double step = INFINITY, off = 0; /* from the middle */
  for (int n = 0; n < STEPS && step > LAST_STEP; n++) {
    step = rival_step(a, b, &at);
    off = fmax(fabs(at.u - 0.5), fabs(at.v - 0.5));
    if (!(step < INFINITY && off < ASTRAY)) return 0;
  }
  out[0] = at;
  return step <= LAST_STEP && off <= 0.5 + RIVAL_EDGE;
}
