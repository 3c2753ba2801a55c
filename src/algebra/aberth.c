/* Aberth's method: all roots at once, each pushed off by the others.
 *
 * Eq 9 of the paper is z_i <- z_i - N_i / (1 - N_i sum over j != i of 1/(z_i - z_j)) with N_i = P(z_i)/P'(z_i). The
 * paper prints P'/P'' for N_i, an erratum: with it the fixed points would be the roots of P'. Here the same step is
 * written 1 / (P'/P - sum), which needs one inversion less. The stop is eq 10, a step below the tolerance in u.
 *
 * Beyond the paper: `stop rounding` ends a root whose value is below its own rounding bound once its steps no longer
 * shrink. `rest on` leaves roots that are done alone, though they still push the others. `update gauss_seidel` takes
 * the newest values of the others.
 */
#include "algebra/root_kernel.h"
#include "algebra/start.h"
#include "base/kernel.h"

/* Tells the watcher the values that the sweep has moved; number 0 is the start. */
static void tell_sweep(const struct aberth *a, const struct root_problem *problem, const struct solver_options *options,
                       int number, const struct root_estimates *out)
{
  for (int i = 0; i < problem->degree; i++)
    if (out->iterations[i] == number) root_problem_tell(options, problem->basis, i, number, a->zr[i], a->zi[i]);
}

void aberth_find(const struct root_problem *problem, const struct solver_options *options,
                 const struct solver_warm *warm, struct root_estimates *out)
{
  const int n = problem->degree;
  root_kernel *const sweep = KERNEL_BEST(root_kernel);
  struct aberth a;
  /* The stop uses the rounding bound alone: coefficient errors say nothing about where to stop. */
  evaluation_prepare(n, problem->basis, problem->c, NULL, &a.p);
  a.reversed_above = root_problem_reversed_above(options, n);
  start_values(problem, options->radii, warm, n, a.zr, a.zi);
  a.active_count = n;
  out->count = n;
  for (int i = 0; i < n; i++) {
    a.active[i] = i;
    a.last_step[i] = a.checked[i] = INFINITY;
    out->iterations[i] = a.noisy[i] = 0;
    out->converged[i] = out->cluster[i] = false;
    out->reach[i] = 0.0;
  }
  if (options->watch != NULL) tell_sweep(&a, problem, options, 0, out);
  for (int number = 1; number <= options->max_iterations && a.active_count > 0; number++) {
    sweep(&a, options, number, out);
    if (options->watch != NULL) tell_sweep(&a, problem, options, number, out);
  }
  for (int i = 0; i < n; i++) {
    out->re[i] = a.zr[i];
    out->im[i] = a.zi[i];
    root_problem_u_from_x(problem->basis, &out->re[i], &out->im[i]);
  }
}
