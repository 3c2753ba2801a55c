/* The resultant of a candidate's plane polynomials (paper eq 4 to 6, in Bernstein form), its roots by the scene's
 * method, on all lanes of a packet at once or one by one, and what is proven of them.
 *
 * Compiled once per instruction set. The error bounds hold with and without fused multiply-add.
 */
#include <limits.h>
#include <math.h>

#include "algebra/roots_lanes.h"
#include "intersect/lanes/candidate.h"
#include "intersect/method.h"
#include "intersect/resultant_error.h"

#define BEZOUT_REAL lanes
#define BEZOUT_NAME(name) bezout_lanes_##name
#include "algebra/bezout.h"

/* ---- the resultant ---- */

struct leaf_resultant {
  struct leaf_form form;
  lanes a[16], b[16]; /* nets of the planes' polynomials of that form, a[4 * i + j] */
  lanes error;        /* of their coefficients */
  lanes alpha, beta;  /* the largest of either */
  /* with polish: */
  int degree; /* without exact roots at the ends */
  lanes c_store[2 * 3 * 3 + 1];
  const lanes *c;   /* c[0..degree] */
  lanes variations; /* upper bound on the sign variations of c */
};

static void set_form(const struct candidate *it, struct leaf_resultant *r)
{
  const struct leaf_form *form = &r->form;
  leaf_form_make(it->patch, it->leaf, &r->form);
  r->error = it->line->error;
  r->alpha = r->beta = lanes_all(0);
  for (int i = 0; i <= form->kept_degree; i++) {
    for (int j = 0; j <= form->eliminated_degree; j++) {
      const int n = 4 * i + j;
      plane_values(it->line, it->axis, form->own ? it->leaf->x : form->x, n, &r->a[n], &r->b[n]);
      r->alpha = lanes_max(r->alpha, lanes_abs(r->a[n])), r->beta = lanes_max(r->beta, lanes_abs(r->b[n]));
    }
  }
  if (form->own) return;
  /* Where the ray meets the leaf, the form's polynomials are off by their excess, twice that for a plane of slope 1. If
   * each is moved by a constant, which moves all its coefficients alike, they have their common root there. So the
   * excess counts as an error of coefficients. */
  r->error = it->line->error * form->size + 2 * form->excess;
}

/* Sets the coefficients and an upper bound on their sign variations: one of uncertain sign gets the sign that makes
 * more variations. Returns the lanes that may meet the leaf. */
static lane_mask resultant_varies(struct leaf_resultant *r, lane_mask active)
{
  const int m = r->form.kept_degree, n = r->form.eliminated_degree;
  if (m == 3 && n == 3) bezout_lanes_resultant(3, 3, r->a, r->b, r->c_store);
  else bezout_lanes_resultant(m, n, r->a, r->b, r->c_store);
  r->c = r->c_store + r->form.zeros[0];
  r->degree = 2 * m * n - r->form.zeros[0] - r->form.zeros[1];
  const lanes alpha = r->alpha + r->error, beta = r->beta + r->error;
  const lanes product = alpha * beta, power = n == 1   ? product
                                              : n == 2 ? product * product
                                                       : product * product * product;
  const lanes bound = RESULTANT_ERROR(n, power, alpha, beta, r->error);
  lanes last = {0}, variations = {0};
  const int full = 2 * m * n;
  double choose = 1;
  for (int k = 0; k < r->form.zeros[0]; k++) choose = choose * (full - k) / (k + 1);
  for (int k = 0; k <= r->degree; k++) {
    const lanes c = r->c[k];
    const lane_mask either = ~(lanes_abs(c) > choose * bound);
    variations += lanes_select(either | (c * last < 0), lanes_all(1), lanes_all(0));
    last = lanes_select(either, -last, lanes_select(c > 0, lanes_all(1), lanes_all(-1)));
    const int at = k + r->form.zeros[0];
    choose = choose * (full - at) / (at + 1);
  }
  r->variations = variations;
  return active & (r->variations != 0);
}

/* ---- start values ---- */

/* Start values in leaf parameters: the k-th of every lane that has so many. */
struct root_starts {
  int count;
  lanes u[TRIED_ROOTS], v[TRIED_ROOTS];
  lane_mask has[TRIED_ROOTS];
};

enum { RESULTANT_NEWTON_STEPS = 3 };

/* The kept parameter where the control polygon of r crosses zero last, improved by Newton's method on r. */
static lanes resultant_root(const struct leaf_resultant *r)
{
  const int d = r->degree;
  lanes at = lanes_all(0.5), before = r->c[0];
  double choose = 1;
  for (int k = 1; k <= d; k++) {
    choose = choose * (d - k + 1) / k;
    const lanes here = r->c[k] * (1 / choose);
    at = lanes_select(before * here < 0, (k - 1 + before / (before - here)) / d, at);
    before = here;
  }
  /* r(u) = (1-u)^d sum c_k x^k with x = u/(1-u). In the half of the range near 1, the coefficients are read
   * backwards. */
  const lane_mask back = at > 0.5;
  const lanes near = lanes_select(back, 1 - at, at);
  lanes x = near / (1 - near);
  for (int step = 0; step < RESULTANT_NEWTON_STEPS; step++) {
    lanes value = {0}, slope = {0};
    for (int k = d; k >= 0; k--) {
      slope = slope * x + value;
      value = value * x + lanes_select(back, r->c[d - k], r->c[k]);
    }
    x -= value / slope;
  }
  const lanes found = x / (1 + x);
  return lanes_select(back, 1 - found, found);
}

/* The eliminated parameter at a root of r. */
static lanes resultant_eliminated(const struct leaf_resultant *r, lanes kept)
{
  const int m = r->form.kept_degree, n = r->form.eliminated_degree;
  const lanes s = 1 - kept;
  lanes w[4], p[4] = {{0}}, q[4] = {{0}};
  if (m == 1) w[0] = s, w[1] = kept;
  else if (m == 2) w[0] = s * s, w[1] = 2 * (s * kept), w[2] = kept * kept;
  else w[0] = s * s * s, w[1] = 3 * (s * s * kept), w[2] = 3 * (s * kept * kept), w[3] = kept * kept * kept;
  for (int i = 0; i <= m; i++)
    for (int j = 0; j <= n; j++) p[j] += w[i] * r->a[4 * i + j], q[j] += w[i] * r->b[4 * i + j];
  lanes num[2], den[2], better;
  bezout_lanes_null_vector(n, p, q, num, den, &better);
  const lane_mask first = better > 0;
  return lanes_select(first, num[0], num[1]) / lanes_select(first, den[0], den[1]);
}

/* t clamped to [0,1], or the middle if it is not a number. */
LANES_INLINE lanes start_within(lanes t) { return lanes_clamp(lanes_select(t == t, t, lanes_all(0.5)), 0, 1); }

/* Sets the k-th start values from a value of the kept parameter, near a root of r. */
static void starts_set(const struct leaf_resultant *r, int k, lanes kept, struct root_starts *out)
{
  const lanes at = start_within(kept), other = start_within(resultant_eliminated(r, at));
  out->u[k] = r->form.v_kept ? other : at, out->v[k] = r->form.v_kept ? at : other;
}

/* ---- roots on one ray after the other ---- */

/* If the roots are the answer and nothing else decides the leaf, this part of a step's products is charged: the paper's
 * form takes thousands of steps for a leaf. */
#define BARE_COST 0x1p-4

/* Finds the roots on one lane, with as many steps as the budget has left. A step of one root has some products for each
 * coefficient of r. */
static void lane_solve(const struct packet *p, const struct candidate *it, const struct leaf_resultant *r,
                       unsigned lane, struct method_roots *out)
{
  const struct method *method = it->patch->method;
  struct method_planes planes = {.form = &r->form};
  const int64_t left = p->postponed->left[lane];
  out->count = 0;
  if (left < 0 || tracer_stopped(p->tracer)) return;
  for (int i = 0; i <= r->form.kept_degree; i++)
    for (int j = 0; j <= r->form.eliminated_degree; j++)
      planes.a[4 * i + j] = r->a[4 * i + j][lane], planes.b[4 * i + j] = r->b[4 * i + j][lane];
  const double degree = 2 * r->form.kept_degree * r->form.eliminated_degree,
               step = degree * (method->polish ? 1.0 : BARE_COST) / PRODUCTS_A_UNIT; /* its cost */
  const double most = (double)left / (step * degree);                                /* of each root */
  struct explainer *explainer = p->tracer->explainer;
  if (explainer) explainer->story.by_solver = true;
  method_find(method, &planes, most < INT_MAX ? (int)most : INT_MAX,
              tracer_warm(p->tracer, p->model, method, it->number), out, explainer ? &explainer->story.found : NULL);
  p->tracer->counts.roots_found += (unsigned)out->found;
  lane_mask cost = {0};
  cost[lane] = (int64_t)(step * out->steps);
  packet_charge(p, cost);
}

/* Start values from the roots of r by a method that does not run on lanes. */
static void method_starts(const struct packet *p, const struct candidate *it, const struct leaf_resultant *r,
                          lane_mask open, struct root_starts *out)
{
  for (unsigned bits = lanes_bits(open); bits; bits &= bits - 1) {
    const unsigned lane = (unsigned)__builtin_ctz(bits);
    struct method_roots roots;
    lane_solve(p, it, r, lane, &roots);
    const int count = roots.count < TRIED_ROOTS ? roots.count : TRIED_ROOTS;
    for (int k = 0; k < count; k++) out->u[k][lane] = roots.u[k], out->v[k][lane] = roots.v[k], out->has[k][lane] = -1;
    out->count = out->count > count ? out->count : count;
  }
}

/* ---- roots on all lanes at once ---- */

/* Sets start values on the lanes of `active`: the roots that were kept, moved off the real axis, or cold ones. */
static void all_roots_start(struct roots_lanes *a, const struct solver_warm *warm, lane_mask active)
{
  if (!warm || warm->count != a->degree) {
    roots_lanes_start(a, active);
    return;
  }
  for (int k = 0; k < a->degree; k++) {
    const double lift = fabs(warm->im[k]) < ROOTS_LIFT ? (k % 2 ? ROOTS_LIFT : -ROOTS_LIFT) : 0;
    a->zr[k] = lanes_all(2 * warm->re[k] - 1), a->zi[k] = lanes_all(2 * warm->im[k] + lift);
  }
}

/* Keeps the roots of one lane for the next rays. */
static void all_roots_keep(const struct roots_lanes *a, lane_mask done, struct solver_warm *warm)
{
  const unsigned bits = lanes_bits(done);
  if (!warm) return;
  warm->count = bits ? a->degree : 0;
  if (!bits) return;
  const unsigned lane = 31 - (unsigned)__builtin_clz(bits);
  for (int k = 0; k < a->degree; k++) warm->re[k] = 0.5 + 0.5 * a->zr[k][lane], warm->im[k] = 0.5 * a->zi[k][lane];
}

/* Collects the roots near [0,1], lane by lane. */
static void all_roots_near(const struct leaf_resultant *r, const struct roots_lanes *a, lane_mask done,
                           struct root_starts *out)
{
  int counts[LANES] = {0};
  lanes kept[TRIED_ROOTS];
  for (int k = 0; k < TRIED_ROOTS; k++) kept[k] = lanes_all(0.5);
  for (int i = 0; i < a->degree; i++) {
    const lane_mask near = (lanes_abs(a->zi[i]) <= ROOTS_MARGIN) & (lanes_abs(a->zr[i]) <= 1 + ROOTS_MARGIN);
    for (unsigned bits = lanes_bits(done & near & ~a->moving[i]); bits; bits &= bits - 1) {
      const unsigned lane = (unsigned)__builtin_ctz(bits);
      if (counts[lane] == TRIED_ROOTS) continue;
      const int k = counts[lane]++;
      kept[k][lane] = 0.5 + 0.5 * a->zr[i][lane], out->has[k][lane] = -1;
      out->count = out->count > counts[lane] ? out->count : counts[lane];
    }
  }
  for (int k = 0; k < out->count; k++) starts_set(r, k, kept[k], out);
}

/* Finds the roots of the polynomial that is set. Returns the lanes of `active` where the method succeeds: see
 * roots_lanes_run. */
static lane_mask all_roots_solve(struct packet *p, const struct candidate *it, lane_mask active, lanes enough,
                                 struct roots_lanes *out)
{
  const struct solver_options *options = &it->patch->method->roots;
  if (!lanes_any(active)) return active;
  out->method = it->patch->lanes;
  struct solver_warm *warm = tracer_warm(p->tracer, p->model, it->patch->method, it->number);
  all_roots_start(out, warm, active);
  const double settled = options->tolerance > ROOTS_SETTLED ? options->tolerance : ROOTS_SETTLED;
  const lane_mask done = roots_lanes_run(out, active, enough, settled, options->max_iterations);
  packet_charge(p, __builtin_convertvector(out->sweeps * (1.0 / PRODUCTS_A_UNIT), lane_mask));
  all_roots_keep(out, done, warm);
  for (int k = 0; k < out->degree; k++) p->tracer->counts.roots_found += lanes_count(done & ~out->moving[k]);
  return done;
}

lanes method_quadratic_root(struct packet *p, const struct candidate *it, const lanes r[3], lane_mask *open)
{
  struct roots_lanes a;
  const lane_mask able = roots_lanes_set_quadratic(&a, r[0], 0.5 * r[1], 0.25 * r[2]); /* s = y/2 */
  *open = all_roots_solve(p, it, *open & able, lanes_all(1), &a);
  if (!lanes_any(*open)) return lanes_all(0);
  const lanes size[2] = {lanes_abs(a.zr[0]) + lanes_abs(a.zi[0]), lanes_abs(a.zr[1]) + lanes_abs(a.zi[1])};
  const lane_mask second = ~a.moving[1] & (size[1] < size[0]);
  return 0.5 * lanes_select(second, a.zr[1], a.zr[0]);
}

/* Finds roots by a method for lanes. */
static void all_roots_find(struct packet *p, const struct candidate *it, const struct leaf_resultant *r,
                           lane_mask active, struct root_starts *out)
{
  struct roots_lanes a;
  if (r->degree < 1) return;
  const lane_mask able = roots_lanes_set(&a, r->degree, r->c);
  all_roots_near(r, &a, all_roots_solve(p, it, active & able, r->variations, &a), out);
}

/* ---- what is proven of them ---- */

/* Refines the roots by Newton's method, and proves them. Returns the lanes where one of them is alone in the leaf. */
static lane_mask all_roots_prove(const struct packet *p, struct candidate *it, const struct root_starts *starts)
{
  struct leaf_roots *known = &it->known;
  lane_mask alone = {0};
  known->count = starts->count;
  for (int k = 0; k < starts->count; k++) {
    const struct newton_root *r = &known->root[k].at;
    const lane_mask open = starts->has[k] & ~alone;
    known->proven[k] = (lane_mask){0};
    if (!lanes_any(open)) continue;
    const lanes start[2] = {starts->u[k] - 0.5, starts->v[k] - 0.5};
    newton_solve(p, it->leaf, it->axis, start, open, &known->root[k]);
    known->proven[k] = r->exists;
    for (int j = 0; j < k; j++) known->proven[k] &= ~(known->proven[j] & roots_meet(&known->root[j].at, r));
    alone |= r->alone;
  }
  return alone;
}

/* With polish: finds the roots on the lanes of `active`, and closes those where they are proven to be all. */
static lane_mask proven_roots(struct packet *p, struct candidate *it, const struct leaf_resultant *r, lane_mask active)
{
  struct root_starts starts = {0};
  const bool one = it->patch->lanes == SOLVER_LANES_SIGNS;
  if (one) {
    p->tracer->counts.roots_found += lanes_count(active);
    starts_set(r, 0, resultant_root(r), &starts);
    starts.has[0] = active, starts.count = 1;
  } else if (it->patch->lanes != SOLVER_LANES_NONE) {
    all_roots_find(p, it, r, active, &starts);
  } else {
    method_starts(p, it, r, active, &starts);
  }
  const lane_mask alone = all_roots_prove(p, it, &starts);
  offer_known(p, it, p->any ? active : alone);
  const lane_mask open = active & ~alone & p->live;
  /* Where the default method has no root, the ray nearly touches the leaf, and pieces would do one time in ten. */
  const lane_mask tried = one ? open & it->known.proven[0] : open;
  if (!lanes_any(tried)) return open;
  const lane_mask covered = cover_proves(p, it, COVER_HALVINGS, tried);
  offer_known(p, it, covered);
  return open & ~covered;
}

/* Without polish the roots are the answer, proven or not. */
static void offer_bare_roots(struct packet *p, const struct candidate *it, const struct leaf_resultant *r,
                             lane_mask open)
{
  for (unsigned bits = lanes_bits(open); bits; bits &= bits - 1) {
    const unsigned lane = (unsigned)__builtin_ctz(bits);
    struct method_roots roots;
    lane_solve(p, it, r, lane, &roots);
    for (int n = 0; n < roots.count; n++)
      if (roots.u[n] >= 0 && roots.u[n] <= 1 && roots.v[n] >= 0 && roots.v[n] <= 1)
        offer_unproven(p, it, roots.u[n], roots.v[n], lane);
  }
}

lane_mask stage_resultant(struct packet *p, struct candidate *it, lane_mask open)
{
  const bool polish = it->patch->method->polish;
  uint64_t *entered = p->tracer->counts.stages;
  struct leaf_resultant r;
  packet_charge(p, open & COST_RESULTANT);
  entered[STAGE_RESULTANT] += lanes_count(open);
  set_form(it, &r);
  if (polish) open = resultant_varies(&r, open);
  if (!lanes_any(open)) return open;
  entered[STAGE_ROOTS] += lanes_count(open);
  if (polish) return proven_roots(p, it, &r, open);
  offer_bare_roots(p, it, &r, open);
  return (lane_mask){0};
}
