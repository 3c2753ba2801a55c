/* Laguerre: z <- z - n P / (P' +- sqrt(H)), H = (n-1) [(n-1) P'^2 - n P P''], eq 8 of the paper, with deflation.
 *
 * Divided by P, with G = P'/P and K = G^2 - P''/P, the step is -n / (G +- sqrt((n-1) (n K - G^2))). The sign is the one
 * that makes the denominator larger in modulus.
 */
#include "algebra/deflation.h"

static struct complex_number laguerre_step(const struct local_view *view)
{
  const double n = view->degree;
  const struct complex_number square = complex_multiply(view->slope, view->slope);
  const struct complex_number under = complex_subtract(complex_scale(n, view->curvature), square);
  const struct complex_number root = complex_sqrt(complex_scale(n - 1.0, under));
  const struct complex_number plus = complex_add(view->slope, root), minus = complex_subtract(view->slope, root);
  const struct complex_number larger = complex_norm(plus) >= complex_norm(minus) ? plus : minus;
  return complex_divide((struct complex_number){-n, 0.0}, larger);
}

const struct deflation_method laguerre_method = {laguerre_step, true};

void laguerre_find(const struct root_problem *problem, const struct solver_options *options,
                   const struct solver_warm *warm, struct root_estimates *out)
{
  deflation_find(problem, options, warm, &laguerre_method, problem->degree, out);
}
