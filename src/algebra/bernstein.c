/* Real roots in [0,1]: sign variations in Bernstein form, bisection, and bracketed Newton.
 *
 * By Descartes' rule in Bernstein form, the sign variations of the coefficients over an interval bound its number of
 * roots and have its parity: 0 proves none, 1 exactly one. Other intervals are halved by de Casteljau's algorithm. A
 * coefficient within its own error bound has no sign. An interval that this leaves undecided is halved until it is
 * decided, or until nothing in it has a sign (the polynomial is not told from zero there): a tangency, a multiple root,
 * or no root at all by less than the error. Such intervals are not lost but answered as clusters, by the local
 * parabola.
 *
 * Every real root in [0,1] is within the reach of an answer. The reach of a bracketed root is what lies between points
 * where p surely has the signs of the ends; of a cluster, its stretch; of a root next to an end without a sign, what
 * `open_end_reach` says.
 */
#include <float.h>

#include "algebra/root_problem.h"

/* Halving ends at 2^-48: a smaller interval near 1 has too few doubles in it to be halved. */
enum { DEEPEST = 48 };

/* Intervals examined before the rest is answered as undecided. Decided ones need at most 2 DEEPEST per root. */
enum { MOST_INTERVALS = 2 * DEEPEST * POLYNOMIAL_MAX_DEGREE };

struct interval {
  double low, width;
  int level;
  double b[POLYNOMIAL_MAX_DEGREE + 1]; /* Bernstein coefficients over the interval (not scaled) */
  double error[POLYNOMIAL_MAX_DEGREE + 1];
};

struct search {
  const struct solver_options *options;
  struct evaluation p, sure; /* with the bounds of rounding alone; with those of the coefficients too */
  int degree;
  struct root_set *out;
  double joint;      /* the end of the interval to the left, if it has a root not told from that end; otherwise -1 */
  double joint_from; /* the farthest left that root may be */
  double cluster_low, cluster_high; /* pending undecided intervals, joined; none while low > high */
  double cluster_from, cluster_to;  /* where its roots may lie: a little outside too */
};

/* The chart in which p is evaluated: z = u/(1-u), (1-u)/u, or u itself in the power basis. */
struct chart {
  bool reversed, power;
};

static struct chart chart_at(const struct search *search, double u)
{
  const bool power = search->p.basis == BASIS_POWER;
  return (struct chart){.reversed = !power && u > 0.5, .power = power};
}

static double chart_from_u(struct chart chart, double u)
{
  return chart.power ? u : chart.reversed ? (1.0 - u) / u : u / (1.0 - u);
}

static double chart_to_u(struct chart chart, double z)
{
  return chart.power ? z : chart.reversed ? 1.0 / (1.0 + z) : z / (1.0 + z);
}

/* The Newton step p/p' in u, the sign of p in [0,1], and whether p is told from zero. */
struct probe {
  double newton;
  int sign; /* 0: not told from zero */
};

static struct probe probe_at(const struct search *search, double u)
{
  const struct chart chart = chart_at(search, u);
  const struct evaluation_real q = evaluation_at_real(&search->p, chart_from_u(chart, u), chart.reversed);
  struct probe out;
  if (chart.power) {
    out.newton = q.value / q.slope;
  } else { /* p = w^n q, p' = w^(n-2) (q' - n w q) with w = 1 - u, or w^(n-2) (n w q - q') with w = u */
    const double w = chart.reversed ? u : 1.0 - u;
    const double slope = chart.reversed ? search->degree * w * q.value - q.slope
                                        : q.slope - search->degree * w * q.value;
    out.newton = w * w * q.value / slope;
  }
  out.sign = fabs(q.value) <= q.error ? 0 : q.value > 0.0 ? 1 : -1;
  return out;
}

/* Tells the watcher of a step of the root that is sought. */
static void tell_step(const struct search *search, int step, double u)
{
  const struct solver_watch *watch = search->options->watch;
  if (watch != NULL) watch->tell(watch->context, search->out->count, step, u, 0.0);
}

static struct evaluation_real look(const struct search *search, double u)
{
  const struct chart chart = chart_at(search, u);
  return evaluation_at_real(&search->sure, chart_from_u(chart, u), chart.reversed);
}

/* The distance from u, towards `end`, at which p surely has the sign that it has at `end`. Tried in steps that double,
 * from `first`. A chart point has some roundings. */
static double sure_sign(const struct search *search, double u, double end, double first, int sign)
{
  const double most = fabs(end - u);
  for (double step = first; step < most; step *= 2.0) {
    const double at = end > u ? u + step : u - step;
    const struct evaluation_real q = look(search, at);
    if (sign * q.value > q.error) return fmin(most, fabs(at - u) * BOUND_ROOM + 4 * DBL_EPSILON * at);
  }
  return most;
}

/* How far from u the one root between low and high may be, where p has the signs `low_sign` and its opposite. */
static double bracket_reach(const struct search *search, double low, double high, int low_sign, double u)
{
  const double first = 2.0 * DBL_EPSILON * u + DBL_TRUE_MIN;
  const struct probe probe = probe_at(search, u);
  const struct evaluation_real q = look(search, u);
  const double noise = fabs(probe.newton * (2.5 * q.error / q.value));           /* of a step, with room */
  const double step = fmin(fmax(first, fabs(probe.newton) + noise), high - low); /* a NaN becomes `first` */
  return fmax(sure_sign(search, u, low, step, low_sign), sure_sign(search, u, high, step, -low_sign));
}

/* The one root between low and high, where p has the signs `low_sign` and its opposite. A Newton step is taken where it
 * stays in the bracket and is at most half the step before the last; otherwise the bracket is halved. */
static void bracketed_newton(struct search *search, const struct interval *part, int low_sign, double start)
{
  double low = part->low, high = low + part->width, u = start, last_step = high - low, step_before = high - low;
  int spent = 0;
  bool converged = false;
  tell_step(search, 0, u);
  for (; spent < search->options->max_iterations && !converged; tell_step(search, spent, u)) {
    spent++;
    const struct probe probe = probe_at(search, u);
    double next = u - probe.newton;
    if (probe.sign == 0) { /* below the rounding bound: go on while the steps shrink, see STEEP_FALL */
      const double step = fabs(probe.newton);
      const bool noise = !(next > low && next < high) || step >= last_step;
      converged = noise || step * step < STEEP_FALL * last_step * last_step || step < search->options->tolerance;
      u = noise ? u : next;
      last_step = step;
      continue;
    }
    if (probe.sign == low_sign) low = u;
    else high = u;
    if (!(next > low && next < high) || fabs(next - u) > 0.5 * step_before) next = low + 0.5 * (high - low);
    step_before = last_step;
    last_step = fabs(next - u);
    converged = last_step < search->options->tolerance || next == low || next == high;
    u = next;
  }
  const double reach = bracket_reach(search, part->low, part->low + part->width, low_sign, u);
  root_set_add(search->out, (struct root){u, 0.0, reach, spent, converged ? ROOT_CONVERGED : ROOT_LIMIT});
}

/* Where the control polygon of the interval crosses zero, which it does once. */
static double polygon_crossing(const struct interval *part, int n)
{
  int k = 1;
  while (k < n && (part->b[k] > 0.0) == (part->b[0] > 0.0)) k++;
  const double rise = part->b[k] - part->b[k - 1];
  const double inside = rise != 0.0 ? -part->b[k - 1] / rise : 0.5;
  return part->low + part->width * (k - 1 + inside) / n;
}

/* How far from an end without a sign the interval may have a root. The coefficients `near` to `far`, counted from that
 * end, have one sign, and none has the other one except at the ends. Let e be the most by which the end's coefficient
 * has it. Then p is (1-t)^n times -e + sum C(n,k) b[k] (t/(1-t))^k there, and any term of the sum that reaches 2 e ends
 * the reach: one half of it outweighs e, and the other end may need the other half. */
static double open_end_reach(const struct interval *part, int n, bool at_high, int near, int far)
{
  const int end = at_high ? n : 0, inwards = at_high ? -1 : 1;
  const double most = fabs(part->b[end]) + part->error[end];
  double ratio = INFINITY;
  for (int k = near; k <= far; k++) {
    const double least = fabs(part->b[end + inwards * k]) - part->error[end + inwards * k];
    if (least > 0.0) ratio = fmin(ratio, pow(2.0 * most / (polynomial_binomial(n, k) * least), 1.0 / k));
  }
  return ratio < INFINITY ? part->width * (ratio / (1.0 + ratio)) * BOUND_ROOM : part->width;
}

/* Extends the reach of root `index` to u. */
static void reach_out(struct search *search, int index, double u)
{
  struct root *root = &search->out->root[index];
  root->radius = fmax(root->radius, fabs(u - root->re) * BOUND_ROOM);
}

/* Adds a root at u within its error, or no farther from u than `reach`, which is negative to the left. u is an end of
 * an interval, where p is monotone. */
static void add_end_root(struct search *search, double u, double width, double reach)
{
  int spent = 0;
  double at = u;
  bool moving = true;
  tell_step(search, 0, u);
  while (moving && spent < search->options->max_iterations) {
    spent++;
    const struct probe probe = probe_at(search, at);
    const double next = fmin(fmax(at - probe.newton, 0.0), 1.0);
    moving = probe.sign != 0 && fabs(next - at) >= search->options->tolerance;
    if (!(fabs(next - u) <= width)) break; /* not finite, or gone: the end itself is the candidate */
    at = next;
    tell_step(search, spent, at);
  }
  root_set_add(search->out, (struct root){at, 0.0, 0.0, spent, moving ? ROOT_LIMIT : ROOT_CONVERGED});
  reach_out(search, search->out->count - 1, u);
  reach_out(search, search->out->count - 1, u + reach);
}

/* Answers the pending undecided stretch: the two roots of the local parabola of p, its vertex, or the middle. */
static void flush_cluster(struct search *search)
{
  if (search->cluster_low > search->cluster_high) return;
  const double low = search->cluster_low, high = search->cluster_high, middle = low + 0.5 * (high - low);
  search->cluster_low = 1.0;
  search->cluster_high = 0.0;
  const struct chart chart = chart_at(search, middle);
  const double *c = chart.reversed ? search->p.reverse : search->p.forward;
  const double z0 = chart_from_u(chart, middle);
  double value = c[search->degree], slope = 0.0, half_curvature = 0.0;
  for (int k = search->degree - 1; k >= 0; k--) {
    half_curvature = half_curvature * z0 + slope;
    slope = slope * z0 + value;
    value = value * z0 + c[k];
  }
  const double vertex = -0.5 * slope / half_curvature;
  const double spread = sqrt(fmax(vertex * vertex - value / half_curvature, 0.0));
  const double left = chart_to_u(chart, z0 + vertex - spread), right = chart_to_u(chart, z0 + vertex + spread);
  const bool inside = left >= low && left <= high && right >= low && right <= high;
  const double at[2] = {inside ? left : middle, right};
  for (int k = 0; k < (inside && right != left ? 2 : 1); k++) {
    root_set_add(search->out, (struct root){at[k], 0.0, 0.0, 1, ROOT_CLUSTER});
    reach_out(search, search->out->count - 1, search->cluster_from);
    reach_out(search, search->out->count - 1, search->cluster_to);
  }
}

static bool cluster_ends_at(const struct search *search, double u)
{
  return search->cluster_high == u && search->cluster_low <= search->cluster_high;
}

static void add_undecided(struct search *search, const struct interval *part)
{
  if (cluster_ends_at(search, part->low)) {
    search->cluster_high = search->cluster_to = part->low + part->width;
    return;
  }
  const bool joined = search->joint == part->low;
  if (joined) {
    search->out->count--; /* the root at the joint, the last one added, belongs to this stretch */
    search->joint = -1.0;
  }
  flush_cluster(search);
  search->cluster_low = part->low;
  search->cluster_from = joined ? search->joint_from : part->low;
  search->cluster_high = search->cluster_to = part->low + part->width;
}

/* Does what the signs over an interval say. Returns whether it has to be halved. */
static bool examine(struct search *search, const struct interval *part)
{
  const int n = search->degree;
  const int variations = polynomial_sign_variations(n, part->b, part->error);
  const bool low_open = fabs(part->b[0]) <= part->error[0], high_open = fabs(part->b[n]) <= part->error[n];
  if (variations == 0 && !low_open && !high_open) return false;
  bool any_sign = false;
  for (int k = 0; k <= n; k++) any_sign = any_sign || fabs(part->b[k]) > part->error[k];
  if (!any_sign || part->level >= DEEPEST) {
    add_undecided(search, part);
    return false;
  }
  const double high = part->low + part->width;
  if (!low_open && !high_open) {
    if (variations == 1) bracketed_newton(search, part, part->b[0] > 0.0 ? 1 : -1, polygon_crossing(part, n));
    return variations > 1;
  }
  /* Ends without a sign, and one sign between them: at most one root at either. The interval beyond the end sees it
   * too. */
  const int first = low_open ? 1 : 0, last = high_open ? n - 1 : n;
  if (last <= first && n > 1) return true;
  const int inner = polynomial_sign_variations(last - first, part->b + first, part->error + first);
  if (inner != 0 || fabs(part->b[first]) <= part->error[first] || fabs(part->b[last]) <= part->error[last]) return true;
  if (low_open) {
    const double reach = open_end_reach(part, n, false, first, last);
    if (cluster_ends_at(search, part->low)) search->cluster_to = part->low + reach;
    else if (search->joint == part->low) reach_out(search, search->out->count - 1, part->low + reach);
    else add_end_root(search, part->low, part->width, reach);
  }
  if (high_open) {
    const double reach = open_end_reach(part, n, true, n - last, n - first);
    add_end_root(search, high, part->width, -reach);
    search->joint = high;
    search->joint_from = high - reach;
  }
  return false;
}

/* De Casteljau at the middle; the right half stays in `part`. The errors go the same way; each mean of two adds a
 * rounding, or what underflows. */
static void halve(struct interval *part, int n, struct interval *out_left)
{
  double *b = part->b, *error = part->error;
  out_left->width = part->width = 0.5 * part->width;
  out_left->level = part->level = part->level + 1;
  out_left->low = part->low;
  part->low += part->width;
  for (int k = 0; k <= n; k++) {
    out_left->b[k] = b[0];
    out_left->error[k] = error[0];
    for (int i = 0; i < n - k; i++) {
      b[i] = 0.5 * (b[i] + b[i + 1]);
      error[i] = (0.5 * (error[i] + error[i + 1]) + fabs(b[i]) * UNIT_ROUNDOFF) * (1.0 + 4 * UNIT_ROUNDOFF) +
                 DBL_TRUE_MIN;
    }
  }
}

static void first_interval(const struct root_problem *problem, struct interval *out)
{
  const struct polynomial p = {problem->degree, problem->basis, problem->c, problem->error};
  polynomial_to_bernstein(&p, out->b, out->error);
  for (int k = 0; k <= problem->degree; k++) {
    const double binomial = polynomial_binomial(problem->degree, k);
    out->b[k] /= binomial;
    out->error[k] = (out->error[k] / binomial) * (1.0 + 8 * UNIT_ROUNDOFF);
    out->error[k] += binomial == 1.0 ? 0.0 : 2 * UNIT_ROUNDOFF * fabs(out->b[k]);
  }
  out->low = 0.0;
  out->width = 1.0;
  out->level = 0;
}

void bernstein_find(const struct root_problem *problem, const struct solver_options *options,
                    const struct solver_warm *warm, struct root_set *out)
{
  (void)warm; /* nothing to start from is needed: the signs lead to every root */
  out->count = 0;
  if (problem->basis == BASIS_BERNSTEIN && polynomial_sign_variations(problem->degree, problem->c, problem->error) == 0)
    return; /* end coefficients are not zero here, and all have one sign */
  struct search search = {
    .options = options, .degree = problem->degree, .out = out, .joint = -1.0, .cluster_low = 1.0, .cluster_high = 0.0};
  evaluation_prepare(problem->degree, problem->basis, problem->c, NULL, &search.p);
  evaluation_prepare(problem->degree, problem->basis, problem->c, problem->error, &search.sure);

  /* Depth first from the left: stack[top] is the leftmost interval not yet examined. */
  struct interval stack[DEEPEST + 2];
  int top = 0;
  first_interval(problem, &stack[0]);
  for (int seen = 0; top >= 0; seen++) {
    struct interval *part = &stack[top];
    const bool open = seen < MOST_INTERVALS && examine(&search, part);
    if (seen >= MOST_INTERVALS) add_undecided(&search, part);
    if (open) halve(part, problem->degree, &stack[top + 1]); /* the left half comes first */
    top += open ? 1 : -1;
  }
  flush_cluster(&search);
}
