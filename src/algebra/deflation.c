/* One root at a time: Newton's and Laguerre's methods, and the loop that they share (sections 3.1, 3.2 of the paper).
 *
 * A root is sought in the polynomial from which the roots before it have been divided out. The search begins at the
 * first start value of that (or at the i-th root of the previous polynomial, with `start previous`). Forward division
 * (from the highest power, the paper's) is stable for roots found in order of increasing modulus, backward division for
 * the opposite order. The composite takes each where it is stable, and joins them at the largest terms |c[k] a^k|
 * (Peters and Wilkinson, "Practical problems arising in the solution of polynomial equations", 1971).
 *
 * A value is taken for a real root if dropping its imaginary part does not raise |p| above its previous value or above
 * its rounding bound. The paper does not say how it decides.
 */
#include <string.h>

#include "algebra/root_problem.h"

/* No step is longer than this many times |x| + the mean modulus of the roots. Where p' nearly vanishes, the way back
 * would take hundreds of steps. */
#define LONGEST_STEP 8.0

/* A step that is no shorter than TURN_STUCK times the one TURN_STEPS before is turned by one radian. From there on,
 * steps are at most half as long as before, the first time 1/2 of |x| + the mean modulus. Otherwise a real start on a
 * polynomial without real roots would never leave the axis, and Laguerre's method may jump to and fro between the
 * middle of roots on a circle and far outside. Newton's method, coming from afar, shortens each step by 1/n: at degree
 * 64 the seventh is still 0.9 of the first. */
enum { TURN_STEPS = 7 };
#define TURN_STUCK 0.9

/* A term of this fraction of the largest one counts as nearly the largest: two that tie, or three of a double root. */
#define NEARLY 0.25

/* Steps of `refine` on the whole polynomial. */
enum { REFINE_STEPS = 2 };

/* Newton-Raphson: z <- z - P(z)/P'(z), eq 7 of the paper. */
static struct complex_number newton_step(const struct local_view *view)
{
  return complex_divide((struct complex_number){-1.0, 0.0}, view->slope);
}

/* Laguerre: z <- z - n P / (P' +- sqrt(H)), H = (n-1) [(n-1) P'^2 - n P P''], eq 8 of the paper. Divided by P, with G =
 * P'/P and K = G^2 - P''/P, the step is -n / (G +- sqrt((n-1) (n K - G^2))). The sign is the one that makes the
 * denominator larger in modulus. */
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

const struct deflation_method newton_method = {newton_step, false}, laguerre_method = {laguerre_step, true};

/* Where the halves of a quotient meet: in the middle of the terms |c[k]| modulus^k that are nearly the largest. A half
 * is still exact to rounding on either side of such a term, but not beyond the last one. */
static int joint(int n, const double c[], double modulus)
{
  double term[POLYNOMIAL_MAX_DEGREE + 1], largest = 0.0, power = 1.0;
  int first = -1, last = 0;
  for (int k = 0; k <= n; k++, power *= modulus) {
    term[k] = fabs(c[k] * power);
    largest = fmax(largest, term[k]);
  }
  for (int k = 0; k <= n; k++) {
    if (!(term[k] >= NEARLY * largest)) continue;
    first = first < 0 ? k : first;
    last = k;
  }
  return first < 0 ? 0 : (first + last) / 2;
}

void deflation_divide_linear(enum deflation how, int n, double c[], double a)
{
  double forward[POLYNOMIAL_MAX_DEGREE + 1], backward[POLYNOMIAL_MAX_DEGREE + 1];
  const int join = how == DEFLATION_COMPOSITE && a != 0.0 ? joint(n, c, a) : 0; /* the forward half begins here */
  forward[n - 1] = c[n];
  for (int k = n - 1; k > join; k--) forward[k - 1] = c[k] + a * forward[k];
  for (int k = 0; k < join; k++) backward[k] = ((k > 0 ? backward[k - 1] : 0.0) - c[k]) / a;
  memcpy(c, backward, sizeof c[0] * (size_t)join);
  memcpy(c + join, forward + join, sizeof c[0] * (size_t)(n - join));
}

void deflation_divide_quadratic(enum deflation how, int n, double c[], double sum, double product)
{
  double forward[POLYNOMIAL_MAX_DEGREE + 2], backward[POLYNOMIAL_MAX_DEGREE + 1];
  int join = how == DEFLATION_COMPOSITE && product > 0.0 ? joint(n, c, sqrt(product)) : 0;
  if (join > n - 1) join = n - 1;
  forward[n] = forward[n - 1] = 0.0; /* above the quotient */
  for (int k = n - 2; k >= join; k--) forward[k] = c[k + 2] + sum * forward[k + 1] - product * forward[k + 2];
  for (int k = 0; k < join; k++)
    backward[k] = (c[k] + sum * (k > 0 ? backward[k - 1] : 0.0) - (k > 1 ? backward[k - 2] : 0.0)) / product;
  memcpy(c, backward, sizeof c[0] * (size_t)join);
  memcpy(c + join, forward + join, sizeof c[0] * (size_t)(n - 1 - join));
}

/* The values of one polynomial at one point. */
struct local_values {
  struct local_view view;
  double size, error; /* |q| in the chart, and its rounding bound */
};

/* The values that a method's step needs, or only |q| if `method` is NULL. Without `bounded` the error means nothing.
 * The chart is as in evaluation.h: z = x or 1/x. With g = q'/q and h = q''/q, in the reversed chart p'/p = z (n - z g)
 * and (p'/p)^2 - p''/p = z^2 (n - 2 z g - z^2 (h - g^2)). */
static struct local_values look(const struct deflation_method *method, bool bounded, int n, const double c[],
                                struct complex_number x, double reversed_above)
{
  const bool sloped = method != NULL, curved = sloped && method->curved;
  const bool reversed = complex_norm(x) > reversed_above;
  const struct complex_number one = {1.0, 0.0};
  const struct complex_number z = reversed ? complex_divide(one, x) : x;
  const double modulus = bounded ? complex_modulus(z) : 0.0;
  struct complex_number q = {c[reversed ? 0 : n], 0.0}, slope = {0.0, 0.0}, half_second = {0.0, 0.0};
  double error = (4 * n + 2) * UNIT_ROUNDOFF * fabs(q.re);
  for (int k = n - 1; k >= 0; k--) {
    const double coefficient = c[reversed ? n - k : k];
    if (curved) half_second = complex_add(complex_multiply(half_second, z), slope);
    if (sloped) slope = complex_add(complex_multiply(slope, z), q);
    q = complex_multiply(q, z);
    q.re += coefficient;
    if (bounded) error = error * modulus + (4 * k + 2) * UNIT_ROUNDOFF * fabs(coefficient);
  }
  struct local_values out = {
    .view = {n, {0.0, 0.0}, {0.0, 0.0}}, .size = complex_small_modulus(q), .error = error + UNDERFLOW_ERROR};
  if (!sloped) return out;
  const struct complex_number g = complex_divide(slope, q), zg = complex_multiply(z, g);
  out.view.slope = reversed ? complex_multiply(z, (struct complex_number){n - zg.re, -zg.im}) : g;
  if (curved) {
    const struct complex_number h = complex_divide(complex_scale(2.0, half_second), q);
    const struct complex_number bend = complex_subtract(complex_multiply(g, g), h), zz = complex_multiply(z, z);
    const struct complex_number b = {n - 2.0 * zg.re, -2.0 * zg.im};
    out.view.curvature = reversed ? complex_multiply(zz, complex_add(b, complex_multiply(zz, bend))) : bend;
  }
  return out;
}

struct sought {
  struct complex_number x;
  int iterations;
  bool converged;
};

/* Runs the paper's iteration from `start`, for root number `number`. */
static struct sought seek(const struct root_problem *problem, const struct solver_options *options,
                          const struct deflation_method *method, struct complex_number start, int number)
{
  const int n = problem->degree;
  const double *c = problem->c, mean_modulus = start_mean_modulus(problem);
  struct sought out = {start, 0, false};
  const double tolerance = options->tolerance * options->tolerance, above = root_problem_reversed_above(options, n);
  const bool relative = options->stop == STOP_ROUNDING; /* the paper's tolerance is absolute */
  double last = INFINITY, checked = INFINITY, longest = LONGEST_STEP;
  root_problem_tell(problem, options, number, 0, start);
  while (!out.converged && out.iterations < options->max_iterations) {
    out.iterations++;
    const struct local_values here = look(method, relative, n, c, out.x, above);
    if (here.size == 0.0) {
      out.converged = true;
      break;
    }
    struct complex_number move = method->step(&here.view);
    const bool usable = isfinite(move.re) && isfinite(move.im);
    const double reach = longest * (complex_modulus(out.x) + mean_modulus);
    if (!usable) move = (struct complex_number){0.25 * reach, 0.125 * reach};
    const double length = complex_modulus(move);
    if (length > reach) move = complex_scale(reach / length, move);
    const double in_u = root_problem_step_in_u(problem->basis, out.x, move);
    if (options->stop == STOP_ROUNDING && here.size <= here.error) {
      const bool noise = !usable || in_u >= last;
      out.converged = noise || in_u < STEEP_FALL * last;
      if (noise) break;
    }
    const double square = relative ? root_problem_square_in_u(problem->basis, out.x) : 1.0;
    out.converged = out.converged || (usable && in_u < (square < 1.0 ? tolerance * square : tolerance));
    if (!out.converged && out.iterations % TURN_STEPS == 0) {
      const double now = complex_norm(move);
      if (now >= TURN_STUCK * TURN_STUCK * checked) {
        move = complex_multiply(move, (struct complex_number){COMPLEX_RADIAN_RE, COMPLEX_RADIAN_IM});
        longest = longest > 1.0 ? 0.5 : 0.5 * longest;
      }
      checked = now;
    }
    out.x = complex_add(out.x, move);
    root_problem_tell(problem, options, number, out.iterations, out.x);
    last = in_u;
  }
  return out;
}

static bool taken_for_real(int n, const double c[], struct complex_number x)
{
  const struct local_values at = look(NULL, true, n, c, x, 1.0),
                            on_axis = look(NULL, true, n, c, (struct complex_number){x.re, 0.0}, 1.0);
  /* The two values may be in different charts; |p| = |q| max(1, |x|)^n. */
  const double ratio = fmax(1.0, complex_norm((struct complex_number){x.re, 0.0})) / fmax(1.0, complex_norm(x));
  return on_axis.size <= on_axis.error || on_axis.size * pow(ratio, 0.5 * n) <= at.size;
}

/* Takes steps on the polynomial before deflation, each only if it lowers |p|. */
static struct complex_number refined(const struct root_problem *problem, const struct deflation_method *method,
                                     struct complex_number x)
{
  const int n = problem->degree;
  struct local_values here = look(method, false, n, problem->c, x, 1.0);
  for (int i = 0; i < REFINE_STEPS && here.size > 0.0; i++) {
    const struct complex_number next = complex_add(x, method->step(&here.view));
    if (!isfinite(next.re) || !isfinite(next.im)) break;
    const struct local_values there = look(method, false, n, problem->c, next, 1.0);
    const double ratio = fmax(1.0, complex_norm(next)) / fmax(1.0, complex_norm(x));
    if (!(there.size * pow(ratio, 0.5 * n) < here.size)) break;
    x = next;
    here = there;
  }
  return x;
}

void deflation_find(const struct root_problem *problem, const struct solver_options *options,
                    const struct solver_warm *warm, const struct deflation_method *method, int wanted,
                    struct root_set *out)
{
  double re[POLYNOMIAL_MAX_DEGREE], im[POLYNOMIAL_MAX_DEGREE];
  struct root_problem rest = *problem;
  double *c = rest.c;
  out->count = 0;
  start_values(problem, options->radii, warm, 1, re, im);
  const bool cold = warm == NULL || warm->count != problem->degree;
  int n = problem->degree;
  while (n > problem->degree - wanted) {
    /* A cold start is the first start value of the remaining polynomial; its circle holds all remaining roots. */
    const int order = cold ? 0 : problem->degree - n;
    rest.degree = n;
    if (cold && n < problem->degree) start_values(&rest, options->radii, NULL, 1, re, im);
    const struct complex_number start = {re[order], im[order]};
    struct sought found;
    if (n == 1) found = (struct sought){{-c[0] / c[1], 0.0}, 0, true};
    else found = seek(&rest, options, method, start, out->count);
    const bool real = n == 1 || taken_for_real(n, c, found.x);
    if (real) {
      found.x.im = 0.0;
      deflation_divide_linear(options->deflation, n, c, found.x.re);
    } else {
      deflation_divide_quadratic(options->deflation, n, c, 2.0 * found.x.re, complex_norm(found.x));
    }
    n -= real ? 1 : 2;
    const struct complex_number x = options->refine ? refined(problem, method, found.x) : found.x;
    const struct complex_number u = root_problem_u_from_x(problem->basis, x);
    const enum root_status status = found.converged ? ROOT_CONVERGED : ROOT_LIMIT;
    root_set_add(out, (struct root){u.re, u.im, 0.0, found.iterations, status});
    if (!real) root_set_add(out, (struct root){u.re, -u.im, 0.0, 0, status});
  }
}

void newton_find(const struct root_problem *problem, const struct solver_options *options,
                 const struct solver_warm *warm, struct root_set *out)
{
  deflation_find(problem, options, warm, &newton_method, problem->degree, out);
}

void laguerre_find(const struct root_problem *problem, const struct solver_options *options,
                   const struct solver_warm *warm, struct root_set *out)
{
  deflation_find(problem, options, warm, &laguerre_method, problem->degree, out);
}
