/* Start values for methods that need n of them. Internal to src/algebra. */
#ifndef PSCN_ALGEBRA_START_H
#define PSCN_ALGEBRA_START_H

#include "algebra/root_problem.h"

/* Writes problem->degree distinct finite values in x: those of `warm`, if it holds that many (equal ones are moved
 * apart), otherwise new ones by `radii`. The first `wanted` of these are enough. warm may be NULL. */
void start_values(const struct root_problem *problem, enum radii radii, const struct solver_warm *warm, int wanted,
                  double out_re[], double out_im[]);

/* The geometric mean of the moduli of the roots, in x. */
double start_mean_modulus(const struct root_problem *problem);

#endif
