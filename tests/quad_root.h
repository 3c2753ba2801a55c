/* For tests: the root of two bicubic polynomials by Newton's method in quadruple precision. */
#ifndef PSCN_TESTS_QUAD_ROOT_H
#define PSCN_TESTS_QUAD_ROOT_H

#include <stdbool.h>

#include "reference/quad.h"

/* Iterates from (u,v); returns whether it converged. */
static inline bool quad_root(const struct quad_net net[2], quad *u, quad *v)
{
  for (int n = 0; n < 40; n++) {
    const struct quad_jet a = quad_net_jet(&net[0], *u, *v), b = quad_net_jet(&net[1], *u, *v);
    const quad determinant = a.du * b.dv - a.dv * b.du;
    if (determinant == 0) return false;
    const quad du = (a.value * b.dv - b.value * a.dv) / determinant,
               dv = (b.value * a.du - a.value * b.du) / determinant;
    *u -= du, *v -= dv;
    if (!(quad_abs(*u) < 3 && quad_abs(*v) < 3)) return false;
    if (quad_abs(du) + quad_abs(dv) < 1e-28) return true;
  }
  return false;
}

#endif
