/* Newton-Raphson: z <- z - P(z)/P'(z), eq 7 of the paper, with deflation. */
#include "algebra/deflation.h"

static struct complex_number newton_step(const struct local_view *view)
{
  return complex_divide((struct complex_number){-1.0, 0.0}, view->slope);
}

const struct deflation_method newton_method = {newton_step, false};

void newton_find(const struct root_problem *problem, const struct solver_options *options,
                 const struct solver_warm *warm, struct root_estimates *out)
{
  deflation_find(problem, options, warm, &newton_method, problem->degree, out);
}
