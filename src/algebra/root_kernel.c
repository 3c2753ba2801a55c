/* Aberth's step (eq 9; aberth.c) for the roots of one polynomial.
 *
 * Compiled once per instruction set.
 */
#include "algebra/root_kernel.h"

#include <string.h>

#include "algebra/turn.h"
#include "base/kernel.h"
#include "base/lanes.h"

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

void KERNEL(root_kernel)(struct aberth *a, const struct solver_options *options, int number, struct root_estimates *out)
{
  const bool turning = turn_due(number);
  /* The paper's tolerance is absolute. */
  const bool relative = options->stop == STOP_ROUNDING;
  const double tolerance = options->tolerance * options->tolerance;
  int moving = 0, still_active = 0;
  const int active_count = a->active_count;
  int active[POLYNOMIAL_MAX_DEGREE];
  memcpy(active, a->active, sizeof active[0] * (size_t)active_count);
  for (int first = 0; first < active_count; first += LANES) {
    const int used = active_count - first < LANES ? active_count - first : LANES;
    lanes xr, xi;
    for (int l = 0; l < LANES; l++) {
      const int i = active[l < used ? first + l : first];
      xr[l] = a->zr[i];
      xi[l] = a->zi[i];
    }
    struct aberth_step step;
    if (options->stop == STOP_ROUNDING) step_lanes(a, xr, xi, true, &step);
    else step_lanes(a, xr, xi, false, &step);
    for (int l = 0; l < used; l++) {
      const int i = active[first + l];
      const double limit = relative && step.square[l] < 1.0 ? tolerance * step.square[l] : tolerance;
      const bool done = take_step(a, options, turning, i, step.re[l], step.im[l], step.step_square[l], limit,
                                  step.resting[l] != 0);
      out->iterations[i]++;
      out->converged[i] = done;
      moving += !done;
      if (!done || !options->rest) a->active[still_active++] = i;
      if (options->update == UPDATE_GAUSS_SEIDEL) {
        a->zr[i] = a->next_zr[i];
        a->zi[i] = a->next_zi[i];
      }
    }
  }
  for (int k = 0; k < active_count; k++) {
    a->zr[active[k]] = a->next_zr[active[k]];
    a->zi[active[k]] = a->next_zi[active[k]];
  }
  a->active_count = moving > 0 ? still_active : 0;
}
