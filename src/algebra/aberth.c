/* Aberth's method: all roots at once, each pushed off by the others.
 *
 * Eq 9 of the paper is z_i <- z_i - N_i / (1 - N_i sum over j != i of 1/(z_i - z_j)) with N_i = P(z_i)/P'(z_i). The
 * paper prints P'/P'' for N_i, an erratum: with it the fixed points would be the roots of P'. Here the same step is
 * written 1 / (P'/P - sum), which needs one inversion less. The stop is eq 10, a step below the tolerance in u.
 *
 * Beyond the paper: `stop rounding` ends a root whose value is below its own rounding bound once its steps no longer
 * shrink. `rest on` leaves roots that are done alone, though they still push the others. `update gauss_seidel` takes
 * the newest values of the others.
 *
 * Several roots of one polynomial lie side by side in a register. Compiled once per instruction set; all versions give
 * the same bits.
 */
#include <string.h>

#include "algebra/root_problem.h"
#include "base/kernel.h"
#include "base/lanes.h"

/* All values of one solve, in x. */
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

/* Roots that are moved together, whatever a register holds: with `update gauss_seidel` they see each other's old
 * values. */
enum { TOGETHER = 4 };

/* Noise steps that a root may take before it is done: the others still move, and the next step may be a good one. */
enum { PATIENCE = 2 };
/* A noise step is not taken if its square is this many times that of the last good step. Noise may be a few times too
 * long by chance; 8 times is the noise of a vanishing slope. A choice of speed. */
#define WILD 64.0

/* complex_small_modulus of re + i im. */
LANES_INLINE lanes modulus_of(lanes re, lanes im)
{
  const lane_mask small = lanes_max(lanes_abs(re), lanes_abs(im)) < COMPLEX_SMALL;
  const lanes lift = lanes_select(small, lanes_all(COMPLEX_LIFT), lanes_all(1.0));
  const lanes drop = lanes_select(small, lanes_all(1.0 / COMPLEX_LIFT), lanes_all(1.0));
  re *= lift;
  im *= lift;
  return lanes_sqrt(re * re + im * im) * drop;
}

/* q and q' of the chart polynomial at a few chart points z, and a bound on the error of q. Lanes of `reversed` take
 * 1/x. */
struct evaluation_lanes {
  lanes re, im, slope_re, slope_im, error;
};

/* `bounded` is a constant at every call. Without it the error is 0. */
LANES_INLINE void evaluation_at_lanes(const struct evaluation *p, lanes zr, lanes zi, lane_mask reversed, bool bounded,
                                      struct evaluation_lanes *out)
{
  const int n = p->degree;
  const lanes modulus = bounded ? modulus_of(zr, zi) : (lanes){0};
  lanes re = lanes_select(reversed, lanes_all(p->reverse[n]), lanes_all(p->forward[n]));
  lanes error = lanes_select(reversed, lanes_all(p->reverse_bound[n]), lanes_all(p->forward_bound[n]));
  lanes im = {0}, slope_re = {0}, slope_im = {0};
  for (int k = n - 1; k >= 0; k--) {
    const lanes c = lanes_select(reversed, lanes_all(p->reverse[k]), lanes_all(p->forward[k]));
    const lanes next_slope_re = slope_re * zr - slope_im * zi + re;
    slope_im = slope_re * zi + slope_im * zr + im;
    slope_re = next_slope_re;
    const lanes next_re = re * zr - im * zi + c;
    im = re * zi + im * zr;
    re = next_re;
    if (bounded) {
      const lanes b = lanes_select(reversed, lanes_all(p->reverse_bound[k]), lanes_all(p->forward_bound[k]));
      error = error * modulus + b;
    }
  }
  out->re = re;
  out->im = im;
  out->slope_re = slope_re;
  out->slope_im = slope_im;
  out->error = bounded ? error + UNDERFLOW_ERROR : (lanes){0};
}

/* a / b without overflow or underflow of |b|^2; not finite where b = 0. */
LANES_INLINE void divide(lanes ar, lanes ai, lanes br, lanes bi, lanes *out_re, lanes *out_im)
{
  const lanes scale = 1.0 / (lanes_abs(br) + lanes_abs(bi));
  const lanes cr = br * scale, ci = bi * scale;
  const lanes inverse = scale / (cr * cr + ci * ci);
  *out_re = (ar * cr + ai * ci) * inverse;
  *out_im = (ai * cr - ar * ci) * inverse;
}

struct aberth_step {
  lanes re, im;
  lanes step_square; /* |step|^2 in u */
  lanes square;      /* |u|^2 */
  lane_mask resting; /* P is 0, or (if asked for) |P| below its rounding bound */
};

/* The step of eq 9 for a few roots. `bounded` is a constant at every call. */
LANES_INLINE void step_lanes(const struct aberth *a, lanes xr, lanes xi, bool bounded, struct aberth_step *out)
{
  const int n = a->p.degree;
  const lanes square = xr * xr + xi * xi;
  const lane_mask reversed = square > lanes_all(a->reversed_above);
  const lanes inverse = 1.0 / square;
  const lanes zr = lanes_select(reversed, xr * inverse, xr), zi = lanes_select(reversed, -xi * inverse, xi);
  struct evaluation_lanes q;
  evaluation_at_lanes(&a->p, zr, zi, reversed, bounded, &q);
  out->resting = lanes_abs(q.re) + lanes_abs(q.im) <= q.error;

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
    out->square = square;
  } else { /* |du| = |dx| / (|1 + x| |1 + x + dx|) */
    const lanes ar = 1.0 + xr, br = ar + out->re, bi = xi + out->im;
    out->step_square = step_square / ((ar * ar + xi * xi) * (br * br + bi * bi));
    out->square = square / (ar * ar + xi * xi);
  }
}

/* Takes the step of one root. `square` is |step|^2 in u, and eq 10 holds where it is below `limit`. Returns whether the
 * root is done. */
static bool take_step(struct aberth *a, const struct solver_options *options, bool turning, int i, double dx, double dy,
                      double square, double limit, bool resting)
{
  const double xr = a->zr[i], xi = a->zi[i];
  const bool usable = isfinite(dx) && isfinite(dy) && !isnan(square);
  bool done;
  if (resting && options->stop == STOP_ROUNDING) {
    const bool noise = !usable || square >= a->last_step[i];
    a->noisy[i] += noise;
    done = square <= STEEP_FALL * a->last_step[i] || a->noisy[i] > PATIENCE;
    a->last_step[i] = noise ? a->last_step[i] : square;
    if (!usable || square > WILD * a->last_step[i]) dx = dy = 0.0;
  } else if (resting && !usable) {
    done = true; /* P is 0 */
    dx = dy = 0.0;
  } else {
    if (!usable) { /* the pushes cancel P'/P: go somewhere else nearby */
      dx = 0.25 * xr - 0.125 * xi;
      dy = 0.25 * xi + 0.125 * xr;
    }
    done = usable && square < limit;
    if (turning && !done) {
      const struct complex_number step = turn_if_stuck(i, (struct complex_number){dx, dy}, square, a->checked[i]);
      dx = step.re;
      dy = step.im;
    }
    a->last_step[i] = usable ? square : INFINITY;
    if (turning) a->checked[i] = a->last_step[i];
  }
  a->next_zr[i] = xr + dx;
  a->next_zi[i] = xi + dy;
  return done;
}

/* One sweep over the active roots, as options->stop, update and rest say. `number` counts from 1. */
static void sweep(struct aberth *a, const struct solver_options *options, int number, struct root_set *out)
{
  const bool turning = turn_due(number);
  /* The paper's tolerance is absolute. */
  const bool relative = options->stop == STOP_ROUNDING;
  const double tolerance = options->tolerance * options->tolerance;
  int moving = 0, still_active = 0;
  const int active_count = a->active_count, *active = a->active;
  for (int first = 0; first < active_count; first += TOGETHER) {
    const int used = active_count - first < TOGETHER ? active_count - first : TOGETHER;
    struct aberth_step step[TOGETHER / LANES];
    for (int k = 0; k < used; k += LANES) {
      lanes xr, xi;
      for (int l = 0; l < LANES; l++) {
        const int i = active[k + l < used ? first + k + l : first];
        xr[l] = a->zr[i];
        xi[l] = a->zi[i];
      }
      if (options->stop == STOP_ROUNDING) step_lanes(a, xr, xi, true, &step[k / LANES]);
      else step_lanes(a, xr, xi, false, &step[k / LANES]);
    }
    for (int k = 0; k < used; k++) {
      const int i = active[first + k], l = k % LANES;
      const struct aberth_step *of = &step[k / LANES];
      const double limit = relative && of->square[l] < 1.0 ? tolerance * of->square[l] : tolerance;
      const bool done = take_step(a, options, turning, i, of->re[l], of->im[l], of->step_square[l], limit,
                                  of->resting[l] != 0);
      out->root[i].iterations++;
      out->root[i].status = done ? ROOT_CONVERGED : ROOT_LIMIT;
      moving += !done;
      if (!done || !options->rest) a->active[still_active++] = i;
      if (options->update == UPDATE_GAUSS_SEIDEL) {
        a->zr[i] = a->next_zr[i];
        a->zi[i] = a->next_zi[i];
      }
    }
  }
  memcpy(a->zr, a->next_zr, sizeof a->zr[0] * (size_t)a->p.degree);
  memcpy(a->zi, a->next_zi, sizeof a->zi[0] * (size_t)a->p.degree);
  a->active_count = moving > 0 ? still_active : 0;
}

/* Tells the watcher the values that the sweep has moved; number 0 is the start. */
static void tell_sweep(const struct aberth *a, const struct root_problem *problem, const struct solver_options *options,
                       int number, const struct root_set *out)
{
  for (int i = 0; options->watch != NULL && i < problem->degree; i++)
    if (out->root[i].iterations == number)
      root_problem_tell(problem, options, i, number, (struct complex_number){a->zr[i], a->zi[i]});
}

void KERNEL(aberth_find)(const struct root_problem *problem, const struct solver_options *options,
                         const struct solver_warm *warm, struct root_set *out)
{
  const int n = problem->degree;
  struct aberth a;
  /* The stop uses the rounding bound alone: coefficient errors say nothing about where to stop. */
  evaluation_prepare(n, problem->basis, problem->c, NULL, &a.p);
  a.reversed_above = root_problem_reversed_above(options, n);
  start_values(problem, options->radii, warm, n, a.zr, a.zi);
  out->count = a.active_count = n;
  for (int i = 0; i < n; i++) {
    a.active[i] = i;
    a.next_zr[i] = a.zr[i], a.next_zi[i] = a.zi[i];
    a.last_step[i] = a.checked[i] = INFINITY;
    a.noisy[i] = 0;
    out->root[i] = (struct root){.status = ROOT_LIMIT};
  }
  tell_sweep(&a, problem, options, 0, out);
  for (int number = 1; number <= options->max_iterations && a.active_count > 0; number++) {
    sweep(&a, options, number, out);
    tell_sweep(&a, problem, options, number, out);
  }
  for (int i = 0; i < n; i++) {
    const struct complex_number u = root_problem_u_from_x(problem->basis, (struct complex_number){a.zr[i], a.zi[i]});
    out->root[i].re = u.re, out->root[i].im = u.im;
  }
}
