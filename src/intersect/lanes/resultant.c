/* The resultant of a candidate's plane polynomials (paper eq 4 to 6, in Bernstein form), and what its control polygon
 * says of its roots.
 *
 * Compiled once per instruction set. The error bounds hold with and without fused multiply-add.
 */
#include "intersect/lanes/candidate.h"
#include "intersect/resultant_error.h"

#define BEZOUT_REAL lanes
#define BEZOUT_NAME(name) bezout_lanes_##name
#include "algebra/bezout.h"

enum { RESULTANT_NEWTON_STEPS = 3 };

static void set_form(struct candidate *it)
{
  const struct leaf_form *form = &it->form;
  leaf_form_make(it->patch, it->leaf, &it->form);
  it->fa = form->own ? it->a : it->form_a, it->fb = form->own ? it->b : it->form_b, it->form_error = it->line->error;
  it->alpha = it->beta = lanes_all(0);
  for (int i = 0; i <= form->kept_degree; i++) {
    for (int j = 0; j <= form->eliminated_degree; j++) {
      const int n = 4 * i + j;
      if (!form->own) plane_values(it->line, it->axis, form->x, n, &it->form_a[n], &it->form_b[n]);
      it->alpha = lanes_max(it->alpha, lanes_abs(it->fa[n])), it->beta = lanes_max(it->beta, lanes_abs(it->fb[n]));
    }
  }
  if (form->own) return;
  /* Where the ray meets the leaf, the form's polynomials are off by their excess, twice that for a plane of slope 1. If
   * each is moved by a constant, which moves all its coefficients alike, they have their common root there. So the
   * excess counts as an error of coefficients. */
  it->form_error = it->line->error * form->size + 2 * form->excess;
}

/* Sets r and an upper bound on the sign variations of its coefficients: one of uncertain sign gets the sign that makes
 * more variations. Returns the lanes that may meet the leaf. */
static lane_mask resultant_varies(struct candidate *it, lane_mask active)
{
  const int m = it->form.kept_degree, n = it->form.eliminated_degree;
  if (m == 3 && n == 3) bezout_lanes_resultant(3, 3, it->fa, it->fb, it->c_store);
  else bezout_lanes_resultant(m, n, it->fa, it->fb, it->c_store);
  it->c = it->c_store + it->form.zeros[0];
  it->degree = 2 * m * n - it->form.zeros[0] - it->form.zeros[1];
  const lanes alpha = it->alpha + it->form_error, beta = it->beta + it->form_error;
  const lanes product = alpha * beta, power = n == 1   ? product
                                              : n == 2 ? product * product
                                                       : product * product * product;
  const lanes bound = RESULTANT_ERROR(n, power, alpha, beta, it->form_error);
  lanes last = {0}, variations = {0};
  const int full = 2 * m * n;
  double choose = 1;
  for (int k = 0; k < it->form.zeros[0]; k++) choose = choose * (full - k) / (k + 1);
  for (int k = 0; k <= it->degree; k++) {
    const lanes c = it->c[k];
    const lane_mask either = ~(lanes_abs(c) > choose * bound);
    variations += lanes_select(either | (c * last < 0), lanes_all(1), lanes_all(0));
    last = lanes_select(either, -last, lanes_select(c > 0, lanes_all(1), lanes_all(-1)));
    const int at = k + it->form.zeros[0];
    choose = choose * (full - at) / (at + 1);
  }
  it->variations = variations;
  return active & (it->variations != 0);
}

lane_mask stage_resultant(struct candidate *it, lane_mask open)
{
  set_form(it);
  it->variations = lanes_all(-1);
  return it->patch->method->polish ? resultant_varies(it, open) : open;
}

/* The kept parameter where the control polygon of r crosses zero first or last, improved by Newton's method on r. */
static lanes resultant_root(const struct candidate *it, bool first)
{
  const int d = it->degree;
  lanes at = lanes_all(0.5), before = it->c[0];
  lane_mask crossed = {0};
  double choose = 1;
  for (int k = 1; k <= d; k++) {
    choose = choose * (d - k + 1) / k;
    const lanes here = it->c[k] * (1 / choose);
    const lane_mask crosses = (before * here < 0) & ~crossed;
    if (first) crossed |= crosses;
    at = lanes_select(crosses, (k - 1 + before / (before - here)) / d, at);
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
      value = value * x + lanes_select(back, it->c[d - k], it->c[k]);
    }
    x -= value / slope;
  }
  const lanes found = x / (1 + x);
  return lanes_select(back, 1 - found, found);
}

/* The eliminated parameter at a root of r. */
static lanes resultant_eliminated(const struct candidate *it, lanes kept)
{
  const int m = it->form.kept_degree, n = it->form.eliminated_degree;
  const lanes s = 1 - kept;
  lanes w[4], p[4] = {{0}}, q[4] = {{0}};
  if (m == 1) w[0] = s, w[1] = kept;
  else if (m == 2) w[0] = s * s, w[1] = 2 * (s * kept), w[2] = kept * kept;
  else w[0] = s * s * s, w[1] = 3 * (s * s * kept), w[2] = 3 * (s * kept * kept), w[3] = kept * kept * kept;
  for (int i = 0; i <= m; i++)
    for (int j = 0; j <= n; j++) p[j] += w[i] * it->fa[4 * i + j], q[j] += w[i] * it->fb[4 * i + j];
  lanes num[2], den[2], better;
  bezout_lanes_null_vector(n, p, q, num, den, &better);
  const lane_mask first = better > 0;
  return lanes_select(first, num[0], num[1]) / lanes_select(first, den[0], den[1]);
}

void starts_set(const struct candidate *it, int k, lanes kept, struct root_starts *out)
{
  const lanes at = start_within(kept), other = start_within(resultant_eliminated(it, at));
  out->u[k] = it->form.v_kept ? other : at, out->v[k] = it->form.v_kept ? at : other;
}

void polygon_starts(const struct candidate *it, lane_mask open, struct root_starts *out)
{
  for (int k = 0; k < 2; k++) {
    out->has[k] = k ? open & (it->variations >= 2) : open;
    if (!lanes_any(out->has[k])) return;
    starts_set(it, k, resultant_root(it, k == 1), out);
    out->count = k + 1;
  }
}
