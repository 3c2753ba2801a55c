/* Newton's, Laguerre's and Aberth's methods, scalar as printed and on lanes. See forms.h.
 *
 * Each lane works on its own polynomial, or what deflation has left of it, and takes the next one when it is done,
 * without waiting for the others. A step is taken on all lanes at once. Work that comes once a root (whether it is
 * real, the division, the next start) is done lane by lane, by the scalar form's code. Aberth's sums use each
 * difference of two values for both, which rounds in another order than the scalar form. The other methods' values have
 * the same bits. */
#include "forms.h"

#include <math.h>
#include <string.h>

#include "algebra/root_problem.h"
#include "base/lanes.h"

const char *const paper_method_names[PAPER_METHODS] = {"newton", "laguerre", "aberth"};
const char *const form_names[FORMS] = {"scalar", "lanes"};

/* As in src/algebra/deflation.c. */
#define LONGEST_STEP 8.0
enum { TURN_STEPS = 7 };

/* Registers of polynomials that a deflating method works on in turn. Horner's scheme waits for each result, and two
 * that alternate wait half as long (three are too many for 16 registers). Aberth's roots need not wait for each
 * other. */
enum { GROUPS = 2, PLACES = GROUPS * LANES };

int form_lanes(enum paper_method method) { return method == PAPER_ABERTH ? LANES : PLACES; }

/* The operations of an iteration of one root at degree n. */
static double operations_ours(enum paper_method method, int n)
{
  return method == PAPER_NEWTON ? 15 * n + 62 : method == PAPER_LAGUERRE ? 23 * n + 125 : 25 * n + 57;
}

static double operations_paper(enum paper_method method, int n)
{
  return method == PAPER_NEWTON ? 14 * n + 8 : method == PAPER_LAGUERRE ? 21 * n + 29 : 24 * n + 17;
}

/* Counts a polynomial that is done. */
static void count_polynomial(enum paper_method method, const struct batch *batch, size_t number,
                             const struct root_set *roots, struct batch_totals *out, double where[][2])
{
  const int n = batch->degree, count = batch->first_only && method != PAPER_ABERTH ? 1 : roots->count;
  for (int i = 0; i < count; i++) {
    const int left = method == PAPER_ABERTH ? n : n - i;
    out->iterations += roots->root[i].iterations;
    out->sought += roots->root[i].iterations > 0;
    out->operations += roots->root[i].iterations * operations_ours(method, left);
    out->operations_paper += roots->root[i].iterations * operations_paper(method, left);
    if (where != NULL) where[number * (size_t)n + (size_t)i][0] = roots->root[i].re;
    if (where != NULL) where[number * (size_t)n + (size_t)i][1] = roots->root[i].im;
  }
}

static void set_problem(const struct batch *batch, size_t number, struct root_problem *out)
{
  const size_t terms = (size_t)batch->degree + 1;
  out->degree = batch->degree;
  out->basis = BASIS_POWER;
  out->unit = 0;
  memcpy(out->c, batch->c + number * terms, terms * sizeof *out->c);
}

static void remember(const struct root_set *roots, struct solver_warm *warm)
{
  warm->count = roots->count;
  for (int i = 0; i < roots->count; i++) warm->re[i] = roots->root[i].re, warm->im[i] = roots->root[i].im;
}

/* ---- scalar ---- */

/* Eq 9 for one root: the step, 1/(P'/P - sum) being written P/(P' - P sum). */
static struct complex_number aberth_step(const struct root_problem *problem, const struct complex_number z[], int i)
{
  const int n = problem->degree;
  const struct complex_number x = z[i], one = {1.0, 0.0};
  struct complex_number p = {problem->c[n], 0.0}, slope = {0.0, 0.0}, sum = {0.0, 0.0};
  for (int k = n - 1; k >= 0; k--) {
    slope = complex_add(complex_multiply(slope, x), p);
    p = complex_multiply(p, x);
    p.re += problem->c[k];
  }
  for (int j = 0; j < n; j++)
    if (j != i) sum = complex_add(sum, complex_divide(one, complex_subtract(x, z[j])));
  return complex_divide(p, complex_subtract(complex_multiply(p, sum), slope));
}

static void aberth_scalar(const struct root_problem *problem, const struct batch *batch, const struct solver_warm *warm,
                          struct root_set *out)
{
  const int n = problem->degree;
  struct complex_number z[FORMS_DEGREE], next[FORMS_DEGREE];
  double re[FORMS_DEGREE], im[FORMS_DEGREE], checked[FORMS_DEGREE];
  start_values(problem, RADII_CIRCLE, warm, n, re, im);
  for (int i = 0; i < n; i++) {
    z[i] = (struct complex_number){re[i], im[i]};
    checked[i] = INFINITY, out->root[i].iterations = 0;
  }
  bool moving = true;
  for (int number = 1; number <= batch->max_iterations && moving; number++) {
    moving = false;
    for (int i = 0; i < n; i++) {
      struct complex_number step = aberth_step(problem, z, i);
      const double square = complex_norm(step);
      const bool done = square < batch->tolerance * batch->tolerance;
      if (number % TURN_PERIOD == 0) {
        if (!done) step = turn_if_stuck(i, step, square, checked[i]);
        checked[i] = square;
      }
      next[i] = complex_add(z[i], step);
      out->root[i].iterations++;
      moving |= !done;
    }
    memcpy(z, next, sizeof z[0] * (size_t)n);
  }
  out->count = n;
  for (int i = 0; i < n; i++) out->root[i].re = z[i].re, out->root[i].im = z[i].im;
}

static void run_scalar(enum paper_method method, const struct batch *batch, struct batch_totals *out, double where[][2])
{
  struct solver_options options;
  solver_options_default(solver_find(paper_method_names[method], strlen(paper_method_names[method])), &options);
  solver_options_form(&options, false);
  options.tolerance = batch->tolerance, options.max_iterations = batch->max_iterations;
  const struct deflation_method *deflating = method == PAPER_NEWTON ? &newton_method : &laguerre_method;
  struct solver_warm warm = {0};
  for (size_t p = 0; p < batch->count; p++) {
    struct root_problem problem;
    struct root_set roots;
    set_problem(batch, p, &problem);
    const struct solver_warm *from = batch->previous ? &warm : NULL;
    if (method == PAPER_ABERTH) aberth_scalar(&problem, batch, from, &roots);
    else deflation_find(&problem, &options, from, deflating, batch->first_only ? 1 : problem.degree, &roots);
    if (batch->previous) remember(&roots, &warm);
    count_polynomial(method, batch, p, &roots, out, where);
  }
}

/* ---- on lanes ---- */

/* A lane's polynomial. The lanes' stretches are equally long. */
struct place {
  size_t at, end;           /* at == end: nothing is left to do */
  struct root_problem rest; /* what deflation has left of it */
  struct root_set roots;
  struct solver_warm warm;
};

static void places_begin(const struct batch *batch, size_t places, struct place place[])
{
  for (size_t l = 0; l < places; l++) {
    place[l].at = batch->count * l / places, place[l].end = batch->count * (l + 1) / places;
    place[l].warm.count = 0;
  }
}

/* The lanes of a deflating method. Coefficients above a lane's degree are 0. */
struct seekers {
  lanes c[FORMS_DEGREE + 1];
  lanes degree, zr, zi;
  lanes iterations, longest, checked, mean;
  lane_mask busy;
};

/* Makes the lane seek its next root, in what is left of its polynomial or in the next one. */
static void seek_next(struct seekers *s, const struct batch *batch, struct place *place, int lane, bool fresh)
{
  double re[FORMS_DEGREE], im[FORMS_DEGREE];
  if (fresh) {
    s->busy[lane] = place->at < place->end ? -1 : 0;
    if (place->at == place->end) return;
    set_problem(batch, place->at, &place->rest);
    place->roots.count = 0;
  }
  const bool warm = batch->previous && place->warm.count == batch->degree;
  const int order = batch->degree - place->rest.degree;
  if (warm) re[0] = place->warm.re[order], im[0] = place->warm.im[order];
  else start_values(&place->rest, RADII_CIRCLE, NULL, 1, re, im);
  for (int k = 0; k <= batch->degree; k++) s->c[k][lane] = k <= place->rest.degree ? place->rest.c[k] : 0;
  s->degree[lane] = place->rest.degree;
  s->zr[lane] = re[0], s->zi[lane] = im[0];
  s->iterations[lane] = 0, s->longest[lane] = LONGEST_STEP, s->checked[lane] = INFINITY;
  s->mean[lane] = start_mean_modulus(&place->rest);
}

/* |P|^2 at a value, and its rounding bound squared. */
static double square_at(const struct root_problem *p, struct complex_number z, double *out_bound)
{
  const double modulus = complex_modulus(z);
  struct complex_number q = {p->c[p->degree], 0.0};
  double error = (4 * p->degree + 2) * UNIT_ROUNDOFF * fabs(q.re);
  for (int k = p->degree - 1; k >= 0; k--) {
    q = complex_multiply(q, z);
    q.re += p->c[k];
    error = error * modulus + (4 * k + 2) * UNIT_ROUNDOFF * fabs(p->c[k]);
  }
  *out_bound = error * error;
  return complex_norm(q);
}

/* Takes out the root that the lane has found. */
static void take_root(struct seekers *s, enum paper_method method, const struct batch *batch, struct place *place,
                      int lane, struct batch_totals *out, double where[][2])
{
  struct root_problem *rest = &place->rest;
  struct complex_number z = {s->zr[lane], s->zi[lane]};
  double bound, unused;
  const double off = square_at(rest, z, &unused), on = square_at(rest, (struct complex_number){z.re, 0.0}, &bound);
  const int iterations = (int)s->iterations[lane];
  if (on <= bound || on <= off) {
    deflation_divide_linear(DEFLATION_FORWARD, rest->degree, rest->c, z.re);
    rest->degree -= 1;
    root_set_add(&place->roots, (struct root){z.re, 0.0, 0.0, iterations, ROOT_CONVERGED});
  } else {
    deflation_divide_quadratic(DEFLATION_FORWARD, rest->degree, rest->c, 2.0 * z.re, complex_norm(z));
    rest->degree -= 2;
    root_set_add(&place->roots, (struct root){z.re, z.im, 0.0, iterations, ROOT_CONVERGED});
    root_set_add(&place->roots, (struct root){z.re, -z.im, 0.0, 0, ROOT_CONVERGED});
  }
  if (rest->degree == 1) {
    root_set_add(&place->roots, (struct root){-rest->c[0] / rest->c[1], 0.0, 0.0, 0, ROOT_CONVERGED});
    rest->degree = 0;
  }
  const bool whole = rest->degree == 0 || batch->first_only;
  if (whole) {
    count_polynomial(method, batch, place->at++, &place->roots, out, where);
    if (batch->previous) remember(&place->roots, &place->warm);
  }
  seek_next(s, batch, place, lane, whole);
}

/* The square root with real part >= 0. */
LANES_INLINE void lanes_complex_sqrt(lanes re, lanes im, lanes *out_re, lanes *out_im)
{
  const lanes modulus = lanes_sqrt(re * re + im * im), larger = lanes_sqrt(0.5 * (modulus + lanes_abs(re)));
  const lanes smaller = lanes_select(larger > 0, 0.5 * lanes_abs(im) / larger, lanes_all(0));
  const lanes upper = lanes_select(re >= 0, smaller, larger);
  *out_re = lanes_select(re >= 0, larger, smaller);
  *out_im = lanes_select(im < 0, -upper, upper);
}

/* P, P' and P''/2 at the values. */
struct jets {
  lanes pr, pi, dr, di, hr, hi;
};

LANES_INLINE void deflating_jets(const struct seekers s[GROUPS], int top, bool curved, struct jets out[GROUPS])
{
  for (int g = 0; g < GROUPS; g++) out[g] = (struct jets){.pr = s[g].c[top]};
  for (int k = top - 1; k >= 0; k--) {
#pragma GCC unroll 2
    for (int g = 0; g < GROUPS; g++) {
      struct jets *j = &out[g];
      const lanes zr = s[g].zr, zi = s[g].zi;
      if (curved) {
        const lanes t = j->hr * zr - j->hi * zi + j->dr;
        j->hi = j->hr * zi + j->hi * zr + j->di, j->hr = t;
      }
      const lanes t = j->dr * zr - j->di * zi + j->pr;
      j->di = j->dr * zi + j->di * zr + j->pi, j->dr = t;
      const lanes q = j->pr * zr - j->pi * zi + s[g].c[k];
      j->pi = j->pr * zi + j->pi * zr, j->pr = q;
    }
  }
}

/* The steps of eq 7 and eq 8. */
LANES_INLINE void deflating_steps(const struct jets *j, lanes n, bool curved, lanes *out_re, lanes *out_im)
{
  const lanes pr = j->pr, pi = j->pi, dr = j->dr, di = j->di, hr = j->hr, hi = j->hi;
  if (!curved) {
    const lanes inverse = -1 / (dr * dr + di * di);
    *out_re = (pr * dr + pi * di) * inverse, *out_im = (pi * dr - pr * di) * inverse;
    return;
  }
  /* H/(n-1) = (n-1) P'^2 - 2 n P P''/2 */
  const lanes ar = (n - 1) * (dr * dr - di * di) - 2 * n * (pr * hr - pi * hi);
  const lanes ai = (n - 1) * (2 * dr * di) - 2 * n * (pr * hi + pi * hr);
  lanes rr, ri;
  lanes_complex_sqrt((n - 1) * ar, (n - 1) * ai, &rr, &ri);
  const lane_mask against = dr * rr + di * ri < 0; /* the sign that makes the divisor larger */
  const lanes br = dr + lanes_select(against, -rr, rr), bi = di + lanes_select(against, -ri, ri);
  const lanes inverse = -n / (br * br + bi * bi);
  *out_re = (pr * br + pi * bi) * inverse, *out_im = (pi * br - pr * bi) * inverse;
}

/* Moves all lanes, with deflation.c's safeguards against long steps and stuck lanes. Returns those that have
 * converged. */
LANES_INLINE lane_mask deflating_move(struct seekers *s, const struct batch *batch, lanes re, lanes im)
{
  const lanes reach = s->longest * (lanes_sqrt(s->zr * s->zr + s->zi * s->zi) + s->mean);
  const lanes square = re * re + im * im;
  const lane_mask usable = square < INFINITY, far = usable & (square > reach * reach);
  const lanes shrink = lanes_select(far, reach / lanes_sqrt(square), lanes_all(1));
  re = lanes_select(usable, re * shrink, 0.25 * reach), im = lanes_select(usable, im * shrink, 0.125 * reach);
  const lanes length = re * re + im * im;
  const lane_mask converged = usable & (length < batch->tolerance * batch->tolerance);
  s->iterations += 1;
  lane_mask turning = {0};
  for (int l = 0; l < LANES; l++) turning[l] = (int)s->iterations[l] % TURN_STEPS == 0 ? -1 : 0;
  turning &= ~converged;
  if (lanes_any(turning)) {
    const lane_mask stuck = turning & (length >= STUCK * STUCK * s->checked);
    const lanes c = lanes_all(0.5403023058681398), d = lanes_all(0.8414709848078965); /* exp(i) */
    const lanes turned = re * c - im * d;
    im = lanes_select(stuck, re * d + im * c, im), re = lanes_select(stuck, turned, re);
    s->longest = lanes_select(stuck, lanes_min(0.5 * s->longest, lanes_all(0.5)), s->longest);
    s->checked = lanes_select(turning, length, s->checked);
  }
  s->zr += re, s->zi += im;
  return converged | (s->iterations >= batch->max_iterations);
}

/* Runs until all lanes are done. `curved` is a constant in each call. */
LANES_INLINE void run_deflating(enum paper_method method, bool curved, const struct batch *batch,
                                struct batch_totals *out, double where[][2])
{
  struct place place[PLACES];
  struct seekers s[GROUPS] = {{.busy = {0}}};
  places_begin(batch, PLACES, place);
  for (int l = 0; l < PLACES; l++) seek_next(&s[l / LANES], batch, &place[l], l % LANES, true);
  for (bool busy = true; busy;) {
    int top = 2;
    busy = false;
    for (int l = 0; l < PLACES; l++) {
      const int degree = (int)s[l / LANES].degree[l % LANES];
      top = top > degree ? top : degree;
    }
    struct jets jets[GROUPS];
    deflating_jets(s, top, curved, jets);
    for (int g = 0; g < GROUPS; g++) {
      lanes re, im;
      deflating_steps(&jets[g], s[g].degree, curved, &re, &im);
      const lane_mask done = deflating_move(&s[g], batch, re, im) & s[g].busy;
      for (unsigned bits = lanes_bits(done); bits != 0; bits &= bits - 1) {
        const int lane = __builtin_ctz(bits);
        take_root(&s[g], method, batch, &place[g * LANES + lane], lane, out, where);
      }
      busy |= lanes_any(s[g].busy);
    }
  }
}

/* The lanes of Aberth's method. */
struct swarm {
  lanes c[FORMS_DEGREE + 1], zr[FORMS_DEGREE], zi[FORMS_DEGREE], checked[FORMS_DEGREE];
  int sweeps[LANES];
  lane_mask busy;
};

static void swarm_next(struct swarm *s, const struct batch *batch, struct place *place, int lane)
{
  const int n = batch->degree;
  double re[FORMS_DEGREE], im[FORMS_DEGREE];
  s->busy[lane] = place->at < place->end ? -1 : 0;
  if (place->at == place->end) return;
  set_problem(batch, place->at, &place->rest);
  start_values(&place->rest, RADII_CIRCLE, batch->previous ? &place->warm : NULL, n, re, im);
  for (int k = 0; k <= n; k++) s->c[k][lane] = place->rest.c[k];
  for (int i = 0; i < n; i++) s->zr[i][lane] = re[i], s->zi[i][lane] = im[i], s->checked[i][lane] = INFINITY;
  s->sweeps[lane] = 0;
}

/* The sums over j != i of 1/(z_i - z_j); each difference serves both. */
LANES_INLINE void swarm_sums(const struct swarm *s, int n, lanes re[FORMS_DEGREE], lanes im[FORMS_DEGREE])
{
  for (int i = 0; i < n; i++) re[i] = im[i] = lanes_all(0);
  for (int i = 0; i < n; i++) {
    lanes sum_re = re[i], sum_im = im[i];
    for (int j = i + 1; j < n; j++) {
      const lanes dx = s->zr[i] - s->zr[j], dy = s->zi[i] - s->zi[j], inverse = 1 / (dx * dx + dy * dy);
      const lanes qr = dx * inverse, qi = dy * inverse;
      sum_re += qr, sum_im -= qi, re[j] -= qr, im[j] += qi;
    }
    re[i] = sum_re, im[i] = sum_im;
  }
}

/* Makes a sweep. Returns the lanes where a root still moves. */
static lane_mask swarm_sweep(struct swarm *s, const struct batch *batch, lane_mask turning)
{
  const int n = batch->degree;
  lanes sum_re[FORMS_DEGREE], sum_im[FORMS_DEGREE];
  lane_mask moving = {0};
  swarm_sums(s, n, sum_re, sum_im);
  for (int i = 0; i < n; i++) {
    const lanes zr = s->zr[i], zi = s->zi[i];
    lanes pr = s->c[n], pi = {0}, dr = {0}, di = {0};
    for (int k = n - 1; k >= 0; k--) {
      const lanes t = dr * zr - di * zi + pr;
      di = dr * zi + di * zr + pi, dr = t;
      const lanes q = pr * zr - pi * zi + s->c[k];
      pi = pr * zi + pi * zr, pr = q;
    }
    const lanes br = pr * sum_re[i] - pi * sum_im[i] - dr, bi = pr * sum_im[i] + pi * sum_re[i] - di;
    const lanes inverse = 1 / (br * br + bi * bi);
    lanes re = (pr * br + pi * bi) * inverse, im = (pi * br - pr * bi) * inverse;
    const lanes square = re * re + im * im;
    const lane_mask still = ~(square < batch->tolerance * batch->tolerance);
    if (lanes_any(turning)) {
      const lane_mask stuck = turning & still & (square >= STUCK * STUCK * s->checked[i]);
      const lanes c = lanes_all(cos(0.3 + 0.37 * i)), d = lanes_all(sin(0.3 + 0.37 * i)), turned = re * c - im * d;
      im = lanes_select(stuck, re * d + im * c, im), re = lanes_select(stuck, turned, re);
      s->checked[i] = lanes_select(turning, square, s->checked[i]);
    }
    s->zr[i] = zr + re, s->zi[i] = zi + im;
    moving |= still;
  }
  return moving;
}

static void run_aberth(const struct batch *batch, struct batch_totals *out, double where[][2])
{
  const int n = batch->degree;
  struct place place[LANES];
  struct swarm s = {.busy = {0}};
  places_begin(batch, LANES, place);
  for (int l = 0; l < LANES; l++) swarm_next(&s, batch, &place[l], l);
  while (lanes_any(s.busy)) {
    lane_mask turning = {0}, last = {0};
    for (int l = 0; l < LANES; l++) {
      s.sweeps[l]++;
      turning[l] = s.sweeps[l] % TURN_PERIOD == 0 ? -1 : 0;
      last[l] = s.sweeps[l] >= batch->max_iterations ? -1 : 0;
    }
    const lane_mask done = s.busy & (~swarm_sweep(&s, batch, turning) | last);
    for (unsigned bits = lanes_bits(done); bits != 0; bits &= bits - 1) {
      const int lane = __builtin_ctz(bits);
      struct root_set *roots = &place[lane].roots;
      roots->count = n;
      for (int i = 0; i < n; i++) {
        roots->root[i].re = s.zr[i][lane], roots->root[i].im = s.zi[i][lane];
        roots->root[i].iterations = s.sweeps[lane];
      }
      count_polynomial(PAPER_ABERTH, batch, place[lane].at++, roots, out, where);
      if (batch->previous) remember(roots, &place[lane].warm);
      swarm_next(&s, batch, &place[lane], lane);
    }
  }
}

void form_run(enum form form, enum paper_method method, const struct batch *batch, struct batch_totals *out,
              double where[][2])
{
  *out = (struct batch_totals){0, 0, 0, 0};
  if (form == FORM_SCALAR) run_scalar(method, batch, out, where);
  else if (method == PAPER_ABERTH) run_aberth(batch, out, where);
  else if (method == PAPER_NEWTON) run_deflating(method, false, batch, out, where);
  else run_deflating(method, true, batch, out, where);
}
