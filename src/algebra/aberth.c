/* Aberth's method: all roots at once, each pushed off by the others.
 *
 * Eq 9 of the paper, z_i <- z_i - N_i / (1 - N_i sum over j != i of 1/(z_i - z_j)) with N_i = P(z_i)/P'(z_i); the paper prints
 * P'/P'' for N_i, an erratum: with it the fixed points would be the roots of P'. Here the same step is written
 * 1 / (P'/P - sum), which needs one inversion less. Stop: eq 10, a step below the tolerance in u.
 *
 * Beyond the paper: a root whose value is below its own rounding bound takes one last step (if that is smaller than the one
 * before) and rests; resting roots cost nothing but still push the others.
 */
#include <string.h>

#include "algebra/root_problem.h"
#include "algebra/start.h"

/* Every so many sweeps the steps of the roots still moving are turned by an angle of their own. Symmetric starts (real values
 * seeking a complex pair, pairs seeking two real roots) would otherwise never part. */
enum { TURN_PERIOD = 5 };

struct aberth {
  struct evaluation p;
  double zr[POLYNOMIAL_MAX_DEGREE], zi[POLYNOMIAL_MAX_DEGREE];               /* in x */
  double next_zr[POLYNOMIAL_MAX_DEGREE], next_zi[POLYNOMIAL_MAX_DEGREE];
  double last_step[POLYNOMIAL_MAX_DEGREE]; /* squared, in u */
  int active[POLYNOMIAL_MAX_DEGREE];
  int active_count;
};

/* a / b without overflow or underflow of |b|^2; not finite where b = 0. */
LANES_INLINE void divide(lanes ar, lanes ai, lanes br, lanes bi, lanes *out_re, lanes *out_im)
{
  const lane_mask sign_off = (lane_mask)(lanes_all(-0.0));
  const lanes scale = 1.0 / ((lanes)((lane_mask)br & ~sign_off) + (lanes)((lane_mask)bi & ~sign_off));
  const lanes cr = br * scale, ci = bi * scale;
  const lanes inverse = scale / (cr * cr + ci * ci);
  *out_re = (ar * cr + ai * ci) * inverse;
  *out_im = (ai * cr - ar * ci) * inverse;
}

struct aberth_step {
  lanes re, im;
  lanes step_square; /* |step|^2 in u */
  lane_mask resting; /* |P| below its rounding bound */
};

/* The step of eq 9 for eight roots. */
LANES_INLINE void step_lanes(const struct aberth *a, lanes xr, lanes xi, struct aberth_step *out)
{
  const int n = a->p.degree;
  const lanes square = xr * xr + xi * xi;
  const lane_mask reversed = square > 1.0;
  const lanes inverse = 1.0 / square;
  const lanes zr = lanes_select(reversed, xr * inverse, xr), zi = lanes_select(reversed, -xi * inverse, xi);
  struct evaluation_lanes q;
  evaluation_at_lanes(&a->p, zr, zi, reversed, &q);
  const lanes value_square = q.re * q.re + q.im * q.im;
  out->resting = value_square <= q.error * q.error;

  /* P'/P; in the reversed chart z (n - z q'/q) */
  lanes gr, gi;
  divide(q.slope_re, q.slope_im, q.re, q.im, &gr, &gi);
  const lanes hr = n - (zr * gr - zi * gi), hi = -(zr * gi + zi * gr);
  gr = lanes_select(reversed, zr * hr - zi * hi, gr);
  gi = lanes_select(reversed, zr * hi + zi * hr, gi);

  for (int j = 0; j < n; j++) {
    const lanes dx = xr - a->zr[j], dy = xi - a->zi[j];
    const lanes distance = dx * dx + dy * dy;
    const lanes push = lanes_select(distance > 0.0, 1.0 / distance, (lanes){0});
    gr -= dx * push;
    gi += dy * push;
  }
  divide(lanes_all(-1.0), (lanes){0}, gr, gi, &out->re, &out->im);

  const lanes step_square = out->re * out->re + out->im * out->im;
  if (a->p.basis == BASIS_POWER) {
    out->step_square = step_square;
  } else { /* |du| = |dx| / (|1 + x| |1 + x + dx|) */
    const lanes ar = 1.0 + xr, br = ar + out->re, bi = xi + out->im;
    out->step_square = step_square / ((ar * ar + xi * xi) * (br * br + bi * bi));
  }
}

/* One sweep over the roots that still move. All steps are taken from the values before the sweep. */
ALGEBRA_CLONES static void sweep(struct aberth *a, double tolerance_square, int number, struct root_estimates *out)
{
  const bool turning = number % TURN_PERIOD == 0;
  int still_active = 0;
  const int active_count = a->active_count;
  int moved[POLYNOMIAL_MAX_DEGREE];
  memcpy(moved, a->active, sizeof moved[0] * (size_t)active_count);
  for (int first = 0; first < active_count; first += LANES) {
    const int used = active_count - first < LANES ? active_count - first : LANES;
    lanes xr, xi;
    for (int l = 0; l < LANES; l++) {
      const int i = moved[l < used ? first + l : first];
      xr[l] = a->zr[i];
      xi[l] = a->zi[i];
    }
    struct aberth_step step;
    step_lanes(a, xr, xi, &step);
    for (int l = 0; l < used; l++) {
      const int i = moved[first + l];
      double dx = step.re[l], dy = step.im[l];
      const double square = step.step_square[l];
      const bool usable = isfinite(dx) && isfinite(dy) && !isnan(square);
      bool done;
      if (step.resting[l] != 0) {
        done = true;
        if (!usable || square > a->last_step[i]) {
          dx = dy = 0.0;
        }
      } else {
        if (!usable) { /* the pushes cancel P'/P: go somewhere else nearby */
          dx = 0.25 * xr[l] - 0.125 * xi[l];
          dy = 0.25 * xi[l] + 0.125 * xr[l];
        }
        done = usable && square < tolerance_square;
        if (turning && !done) {
          const double angle = 0.3 + 0.37 * i, c = cos(angle), s = sin(angle), turned = c * dx - s * dy;
          dy = s * dx + c * dy;
          dx = turned;
        }
        a->last_step[i] = usable ? square : INFINITY;
      }
      a->next_zr[i] = xr[l] + dx;
      a->next_zi[i] = xi[l] + dy;
      out->iterations[i]++;
      out->converged[i] = done;
      if (!done) {
        a->active[still_active++] = i;
      }
    }
  }
  for (int m = 0; m < active_count; m++) {
    a->zr[moved[m]] = a->next_zr[moved[m]];
    a->zi[moved[m]] = a->next_zi[moved[m]];
  }
  a->active_count = still_active;
}

void aberth_find(const struct root_problem *problem, const struct solver_options *options, const struct solver_warm *warm,
                 struct root_estimates *out)
{
  const int n = problem->degree;
  struct aberth a;
  /* The bound of the stop is that of rounding alone: coefficient errors say nothing about where to stop. */
  evaluation_prepare(n, problem->basis, problem->c, NULL, &a.p);
  start_values(problem, warm, a.zr, a.zi);
  a.active_count = n;
  out->count = n;
  for (int i = 0; i < n; i++) {
    a.active[i] = i;
    a.last_step[i] = INFINITY;
    out->iterations[i] = 0;
    out->converged[i] = out->cluster[i] = false;
  }
  for (int number = 1; number <= options->max_iterations && a.active_count > 0; number++) {
    sweep(&a, options->tolerance * options->tolerance, number, out);
  }
  for (int i = 0; i < n; i++) {
    out->re[i] = a.zr[i];
    out->im[i] = a.zi[i];
    root_problem_u_from_x(problem->basis, &out->re[i], &out->im[i]);
  }
}
