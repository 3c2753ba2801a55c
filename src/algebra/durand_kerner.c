/* Durand-Kerner, Weierstrass's method: the simplest iteration for all roots at once (K. Weierstrass 1891; E. Durand
 * 1960; I. Kerner 1966). It is the baseline for Aberth's method.
 *
 * z_i <- z_i - P(z_i) / (c_n product over j != i of (z_i - z_j)) is Newton's method with P' replaced by what it would
 * be if the others were the roots. It needs no derivative, and converges quadratically to simple roots (Aberth's
 * method: cubically), linearly to multiple ones. In the reversed chart P = x^n q(1/x), and each factor of the product
 * takes one x.
 */
#include <string.h>

#include "algebra/root_problem.h"

struct sweep {
  const struct solver_options *options;
  struct evaluation p;
  double reversed_above;
  int number; /* from 1 */
  struct complex_number x[POLYNOMIAL_MAX_DEGREE], next[POLYNOMIAL_MAX_DEGREE];
  double last[POLYNOMIAL_MAX_DEGREE];    /* |step|^2 in u */
  double checked[POLYNOMIAL_MAX_DEGREE]; /* the same at the last look for stuck roots */
};

/* -P / (c_n product); `resting` where |P| is below its own rounding bound. */
static struct complex_number step_of(const struct sweep *sweep, int i, bool *resting)
{
  const int n = sweep->p.degree;
  const struct complex_number x = sweep->x[i];
  const struct evaluation_complex q = evaluation_at_complex(&sweep->p, x, sweep->reversed_above);
  struct complex_number step = complex_scale(-1.0 / sweep->p.forward[n], q.value);
  if (q.reversed) step = complex_multiply(step, x);
  for (int j = 0; j < n; j++) {
    if (j == i) continue;
    step = complex_divide(step, complex_subtract(x, sweep->x[j]));
    if (q.reversed) step = complex_multiply(step, x);
  }
  *resting = complex_small_modulus(q.value) <= q.error;
  return step;
}

/* Moves root i. Returns whether it is done. */
static bool move(struct sweep *sweep, int i)
{
  const struct solver_options *options = sweep->options;
  const struct complex_number x = sweep->x[i];
  const bool rounding = options->stop == STOP_ROUNDING;
  bool resting;
  struct complex_number step = step_of(sweep, i, &resting);
  const double length = root_problem_step_in_u(sweep->p.basis, x, step);
  const double square = root_problem_square_in_u(sweep->p.basis, x);
  if (!isfinite(step.re) || !isfinite(step.im) || isnan(length)) { /* two values are equal: separate them */
    sweep->next[i] = (struct complex_number){x.re + 0.25 * x.re - 0.125 * x.im, x.im + 0.25 * x.im + 0.125 * x.re};
    sweep->last[i] = INFINITY;
    return false;
  }
  const double scale = rounding && square < 1.0 ? square : 1.0; /* the paper's tolerance is absolute */
  bool done = length < options->tolerance * options->tolerance * scale;
  if (rounding && resting && length >= sweep->last[i]) done = true, step = (struct complex_number){0.0, 0.0};
  if (turn_due(sweep->number)) {
    if (!done) step = turn_if_stuck(i, step, length, sweep->checked[i]);
    sweep->checked[i] = length;
  }
  sweep->last[i] = length;
  sweep->next[i] = complex_add(x, step);
  return done;
}

void durand_kerner_find(const struct root_problem *problem, const struct solver_options *options,
                        const struct solver_warm *warm, struct root_set *out)
{
  const int n = problem->degree;
  struct sweep sweep = {.options = options, .reversed_above = root_problem_reversed_above(options, n)};
  double re[POLYNOMIAL_MAX_DEGREE], im[POLYNOMIAL_MAX_DEGREE];
  evaluation_prepare(n, problem->basis, problem->c, NULL, &sweep.p);
  start_values(problem, options->radii, warm, n, re, im);
  out->count = n;
  for (int i = 0; i < n; i++) {
    sweep.x[i] = sweep.next[i] = (struct complex_number){re[i], im[i]};
    sweep.last[i] = sweep.checked[i] = INFINITY;
    out->root[i] = (struct root){.status = ROOT_LIMIT};
    root_problem_tell(problem, options, i, 0, sweep.x[i]);
  }
  bool moving = true;
  for (sweep.number = 1; sweep.number <= options->max_iterations && moving; sweep.number++) {
    moving = false;
    for (int i = 0; i < n; i++) {
      if (options->rest && out->root[i].status == ROOT_CONVERGED) continue;
      const bool done = move(&sweep, i);
      out->root[i].status = done ? ROOT_CONVERGED : ROOT_LIMIT;
      out->root[i].iterations++;
      moving |= !done;
      root_problem_tell(problem, options, i, sweep.number, sweep.next[i]);
      if (options->update == UPDATE_GAUSS_SEIDEL) sweep.x[i] = sweep.next[i];
    }
    memcpy(sweep.x, sweep.next, sizeof sweep.x[0] * (size_t)n);
  }
  for (int i = 0; i < n; i++) {
    const struct complex_number u = root_problem_u_from_x(problem->basis, sweep.x[i]);
    out->root[i].re = u.re, out->root[i].im = u.im;
  }
}
