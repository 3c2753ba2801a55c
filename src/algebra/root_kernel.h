/* Aberth's method for one polynomial, several roots side by side. Internal to src/algebra.
 *
 * root_kernel.c is compiled once per instruction set (KERNEL_BEST). All versions round alike (no contraction of
 * multiply and add), so an answer does not depend on the machine.
 */
#ifndef PSCN_ALGEBRA_ROOT_KERNEL_H
#define PSCN_ALGEBRA_ROOT_KERNEL_H

#include "algebra/root_problem.h"

/* All values of one solve by Aberth's method, in x. */
struct aberth {
  struct evaluation p;
  double reversed_above; /* |x|^2 */
  double zr[POLYNOMIAL_MAX_DEGREE], zi[POLYNOMIAL_MAX_DEGREE];
  double next_zr[POLYNOMIAL_MAX_DEGREE], next_zi[POLYNOMIAL_MAX_DEGREE];
  double last_step[POLYNOMIAL_MAX_DEGREE]; /* |step|^2 in u */
  double checked[POLYNOMIAL_MAX_DEGREE];   /* |step|^2 in u at the last look for stuck roots */
  int noisy[POLYNOMIAL_MAX_DEGREE];        /* steps that were noise */
  int active[POLYNOMIAL_MAX_DEGREE];       /* the roots still moving */
  int active_count;
};

/* One sweep over the active roots, as options->stop, update and rest say. `number` counts from 1. */
typedef void root_kernel(struct aberth *a, const struct solver_options *options, int number,
                         struct root_estimates *out);

root_kernel root_kernel_baseline, root_kernel_avx2;

#endif
