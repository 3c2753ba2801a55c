/* What the paper's experiments share. */
#include "measure.h"

#include <math.h>

#include "base/sort.h"

double measure_random(uint64_t *state)
{
  uint64_t z = (*state += 0x9e3779b97f4a7c15u);
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
  return (double)((z ^ (z >> 31)) >> 11) * 0x1p-53;
}

void measure_random_polynomial(uint64_t *state, int degree, double c[])
{
  for (int k = 0; k <= degree; k++) c[k] = 2.0 * measure_random(state) - 1.0;
}

double measure_median(size_t count, double x[])
{
  sort_numbers(x, count);
  return x[count / 2];
}

double measure_eq11(const struct root_problem *problem, double re, double im)
{
  const struct polynomial p = {problem->degree, problem->basis, problem->c, NULL};
  return isfinite(re) && isfinite(im) ? polynomial_eq11(&p, re, im) : INFINITY;
}
