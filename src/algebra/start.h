/* Start values for methods that need n of them. Internal to src/algebra. */
#ifndef PSCN_ALGEBRA_START_H
#define PSCN_ALGEBRA_START_H

#include "algebra/root_problem.h"

/* Writes problem->degree distinct finite values in x: those of `warm` where it holds as many (equal ones moved apart),
 * otherwise from Aberth's circle. warm may be NULL. */
void start_values(const struct root_problem *problem, const struct solver_warm *warm, double out_re[], double out_im[]);

#endif
