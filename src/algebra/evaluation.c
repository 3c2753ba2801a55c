/* Prepares a polynomial for evaluation: both orders of its coefficients, and the weights of its error bound. */
#include "algebra/evaluation.h"

#include <stddef.h>

/* Room in a caller's bound for the rounding of the sums that use it: 2^-40 relative, over 4000 roundings. */
#define CALLER_BOUND_ROOM (1.0 + 0x1p-40)

void evaluation_prepare(int degree, enum basis basis, const double c[], const double error[], struct evaluation *out)
{
  out->degree = degree;
  out->basis = basis;
  for (int k = 0; k <= degree; k++) {
    const double given = error == NULL ? 0.0 : error[k] * CALLER_BOUND_ROOM;
    const double size = fabs(c[k]) * UNIT_ROUNDOFF;
    const int back = degree - k;
    out->forward[k] = c[k];
    out->reverse[back] = c[k];
    out->forward_bound[k] = (4 * k + 2) * size + given;
    out->reverse_bound[back] = (4 * back + 2) * size + given;
  }
}
