/* What the paper's experiments share. */
#include "measure.h"

#include <math.h>

double measure_random(uint64_t *state)
{
  uint64_t z = (*state += 0x9e3779b97f4a7c15u);
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
  return (double)((z ^ (z >> 31)) >> 11) * 0x1p-53;
}

double measure_eq11(const struct root_problem *problem, double re, double im)
{
  const struct polynomial p = {problem->degree, problem->basis, problem->c, NULL};
  return isfinite(re) && isfinite(im) ? polynomial_eq11(&p, re, im) : INFINITY;
}
