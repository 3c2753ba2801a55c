/* The scene's own method. See method.h. */
#include <math.h>

#include "algebra/sylvester.h"
#include "base/real.h"
#include "intersect/method.h"

#define BEZOUT_REAL double
#define BEZOUT_NAME(name) bezout_##name
#include "algebra/bezout.h"

/* With polish, a complex root this near to the real axis, or a real one this far outside the leaf, may still start a
 * run of Newton's method that ends in the leaf: rounding moves double roots off the axis by the square root of their
 * error. */
#define START_MARGIN LEAF_MARGIN

/* The leaf's plane polynomials in scaled Bernstein or in power form, in which products are convolutions. */
struct form {
  int m, n;
  double A[16], B[16];
};

/* Converts Bernstein coefficients b[0..n], `stride` apart, to power coefficients. */
static void to_power(int n, double *b, int stride)
{
  const double b0 = b[0], b1 = b[stride], b2 = n > 1 ? b[2 * stride] : 0, b3 = n > 2 ? b[3 * stride] : 0;
  b[stride] = n * (b1 - b0);
  if (n == 2) b[2 * stride] = b2 - 2 * b1 + b0;
  if (n == 3) b[2 * stride] = 3 * (b2 - 2 * b1 + b0), b[3 * stride] = b3 - 3 * (b2 - b1) - b0;
}

static void form_net(int m, int n, enum basis basis, const double net[16], double out[16])
{
  for (int i = 0; i <= m; i++)
    for (int j = 0; j <= n; j++)
      out[4 * i + j] = basis == BASIS_POWER ? net[4 * i + j]
                                            : bezout_binomial(m, i) * bezout_binomial(n, j) * net[4 * i + j];
  if (basis != BASIS_POWER) return;
  for (int i = 0; i <= m; i++) to_power(n, out + 4 * i, 1);
  for (int j = 0; j <= n; j++) to_power(m, out + j, 4);
}

/* The coefficients in v at u: plain Bernstein or power, by the form's basis. */
static void at_kept(const struct form *form, enum basis basis, double u, const double A[16], double out[4])
{
  for (int j = 0; j <= form->n; j++) {
    double value = 0;
    if (basis == BASIS_POWER) {
      for (int i = form->m; i >= 0; i--) value = value * u + A[4 * i + j];
    } else {
      double power = 1, s = 1 - u;
      for (int i = 0; i <= form->m; i++) value = value * s + power * A[4 * i + j], power *= u;
      value /= bezout_binomial(form->n, j);
    }
    out[j] = value;
  }
}

/* v by Euclid's algorithm: remainders of two power polynomials of degree n, down to a linear one. */
static double euclid(int n, const double p_in[4], const double q_in[4])
{
  double p[4] = {0}, q[4] = {0};
  for (int k = 0; k <= n; k++) p[k] = p_in[k], q[k] = q_in[k];
  int dp = n, dq = n;
  while (dq > 0 && q[dq] == 0) dq--;
  while (dq > 1) {
    for (; dp >= dq; dp--) {
      const double factor = p[dp] / q[dq];
      for (int k = 0; k < dq; k++) p[dp - dq + k] -= factor * q[k];
    }
    for (int k = 0; k <= dq; k++) {
      const double swap = k <= dp ? p[k] : 0;
      p[k] = q[k], q[k] = swap;
    }
    const int last = dp;
    dp = dq, dq = last;
    while (dq > 0 && q[dq] == 0) dq--;
  }
  return dq == 1 ? -q[0] / q[1] : p[1] != 0 && dp == 1 ? -p[0] / p[1] : NAN;
}

/* Value and slope at v of a polynomial of degree n <= 3 with plain Bernstein coefficients c, by de Casteljau. */
static void value_and_slope(int n, const double c[4], double v, double *value, double *slope)
{
  double b[4] = {0};
  for (int k = 0; k <= n; k++) b[k] = c[k];
  for (int level = n; level > 1; level--)
    for (int k = 0; k < level; k++) b[k] += v * (b[k + 1] - b[k]);
  *slope = n * (b[1] - b[0]);
  *value = b[0] + v * (b[1] - b[0]);
}

/* Where two roots nearly share u, or the leaf is nearly of a lower degree, the null vector is nearly ambiguous, and v is
 * off by far more than u. From there, or from the middle if it is not even near the leaf, the Gauss-Newton method on
 * both plane polynomials, at this u, still finds v: a step is taken if it brings them nearer to 0. */
enum { NULL_VECTOR_STEPS = 4 };

static double null_vector(int n, const double p[4], const double q[4])
{
  double num[2], den[2], first_better, f, df, g, dg, least = INFINITY;
  bezout_null_vector(n, p, q, num, den, &first_better);
  double v = first_better > 0 ? num[0] / den[0] : num[1] / den[1], next = v >= -1 && v <= 2 ? v : 0.5;
  for (int step = 0; step <= NULL_VECTOR_STEPS; step++) {
    value_and_slope(n, p, next, &f, &df);
    value_and_slope(n, q, next, &g, &dg);
    if (!(f * f + g * g < least)) break;
    v = next, least = f * f + g * g;
    next = v - (f * df + g * dg) / (df * df + dg * dg);
  }
  return v;
}

static double eliminated_at(const struct form *form, const struct method *method, double u)
{
  double p[4], q[4];
  at_kept(form, method->basis, u, form->A, p);
  at_kept(form, method->basis, u, form->B, q);
  if (method->back_substitution == BACK_SUBSTITUTION_EUCLID) {
    if (method->basis != BASIS_POWER) to_power(form->n, p, 1), to_power(form->n, q, 1);
    return euclid(form->n, p, q);
  }
  if (method->basis == BASIS_POWER) {
    /* The null vector of the power form is (1, v, v^2); Bernstein values give it with s + t = 1 instead. */
    double P[4], Q[4];
    for (int j = 0; j <= form->n; j++) {
      P[j] = Q[j] = 0;
      double weight = 1; /* C(j,k)/C(n,k) */
      for (int k = 0; k <= j; k++) {
        P[j] += weight * p[k], Q[j] += weight * q[k];
        if (k < j) weight *= (double)(j - k) / (form->n - k);
      }
    }
    return null_vector(form->n, P, Q);
  }
  return null_vector(form->n, p, q);
}

/* With `polish off` nothing checks an answer again, and Euclid's v may solve neither plane polynomial. So eq 3 must
 * hold within this part of their largest coefficients: the ray then passes the point within this part of the patch's
 * size. The last step was shorter than eps (eq 10), and the remaining error is a part of it: a quarter leaves fewer
 * phantoms than a fifth of the holes with every solver (docs/paper.md). Less than 2^-10 of a patch is not seen: it is a
 * pixel where the patch fills the picture. */
#define LEAST_RESIDUAL 0x1p-10
#define RESIDUAL_OF_STEP 0.25

static bool solves_planes(const struct form *form, const struct method *method, const double size[2], double u,
                          double v)
{
  const double limit = method->residual > 0 ? method->residual
                                            : real_max(RESIDUAL_OF_STEP * method->roots.tolerance, LEAST_RESIDUAL);
  for (int k = 0; k < 2; k++) {
    double p[4], value = 0, slope;
    at_kept(form, method->basis, u, k == 0 ? form->A : form->B, p);
    if (method->basis == BASIS_BERNSTEIN) value_and_slope(form->n, p, v, &value, &slope);
    else
      for (int j = form->n; j >= 0; j--) value = value * v + p[j];
    if (!(fabs(value) <= limit * size[k])) return false;
  }
  return true;
}

static double largest(const double net[16], int m, int n)
{
  double size = 0;
  for (int i = 0; i <= m; i++)
    for (int j = 0; j <= n; j++) size = real_max(size, fabs(net[4 * i + j]));
  return size;
}

/* r of the leaf's form, without its exact roots at the ends. Its coefficients are taken as they are: bounds on their
 * errors known beforehand (resultant_error.h) can exceed them all where the ray runs along the axis of a height field,
 * and then nothing would count as a root. */
static struct polynomial resultant(const struct method *method, const uint8_t zeros[2], const struct form *form,
                                   double c[bezout_MAX_DEGREE + 1])
{
  if (method->resultant == RESULTANT_SYLVESTER) sylvester_determinant(form->m, form->n, form->A, form->B, c);
  else bezout_determinant(form->m, form->n, form->A, form->B, c);
  struct polynomial r = {2 * form->m * form->n, method->basis, c, NULL};
  if (method->basis == BASIS_BERNSTEIN) r.c = c + zeros[0], r.degree -= zeros[0] + zeros[1];
  return r;
}

/* Whether r vanishes at u in [0,1] within n roundings of its terms, as eq 11 of the paper asks of a root.
 * (polynomial_eq11 checks it in quadruple precision, which takes as long as finding the roots.) */
static bool vanishes(const struct polynomial *r, double u)
{
  const double other = r->basis == BASIS_BERNSTEIN ? 1 - u : 1;
  double value = 0, size = 0, power = 1;
  for (int k = r->degree; k >= 0; k--) {
    const double term = r->c[k] * power;
    value = value * u + term, size = size * u + fabs(term);
    power *= other;
  }
  return fabs(value) <= 2 * r->degree * UNIT_ROUNDOFF * size;
}

/* Paper 2.2: the real roots, within eps. If eps is less than a rounding, a method's roundings leave its roots off the
 * axis: methods that deflate put most of their roots on the axis (deflation.c), those that move all roots at once none.
 * A ray that passes a silhouette at some 1e-6 of the patch may get a hit there. */
static bool is_real(const struct method *method, const struct polynomial *r, const struct root *root)
{
  if (method->polish) return fabs(root->im) <= START_MARGIN;
  return fabs(root->im) <= method->roots.tolerance || (root->re >= 0 && root->re <= 1 && vanishes(r, root->re));
}

/* What becomes of a root of r, and the other parameter, which follows from it. */
static enum root_fate substitute(const struct method *method, const struct form *form, const double size[2],
                                 const struct polynomial *r, const struct root *root, double *out_other)
{
  const double margin = method->polish ? START_MARGIN : 0;
  if (!is_real(method, r, root)) return ROOT_COMPLEX;
  if (!(root->re >= -margin && root->re <= 1 + margin)) return ROOT_OUTSIDE;
  const double v = *out_other = eliminated_at(form, method, root->re);
  if (!(v >= -1 && v <= 2)) return ROOT_ELSEWHERE;
  return method->polish || solves_planes(form, method, size, root->re, v) ? ROOT_OFFERED : ROOT_NO_SOLUTION;
}

void method_find(const struct method *method, const struct method_planes *planes, int most_steps,
                 struct solver_warm *warm, struct method_roots *out, struct explained_roots *story)
{
  const struct leaf_form *of = planes->form;
  struct form form = {of->kept_degree, of->eliminated_degree, {0}, {0}};
  form_net(form.m, form.n, method->basis, planes->a, form.A);
  form_net(form.m, form.n, method->basis, planes->b, form.B);
  const double size[2] = {largest(planes->a, form.m, form.n), largest(planes->b, form.m, form.n)};
  double c[bezout_MAX_DEGREE + 1];
  const struct polynomial r = resultant(method, of->zeros, &form, c);
  struct root_set roots = {.count = 0};
  out->count = out->found = out->steps = 0;
  if (r.degree > 0) {
    struct solver_options options = method->roots;
    if (most_steps < options.max_iterations) options.max_iterations = most_steps > 1 ? most_steps : 1;
    solver_roots(&r, &options, warm, &roots);
  }
  out->found = roots.count;
  if (story) {
    story->basis = r.basis, story->degree = r.degree, story->roots = roots;
    for (int k = 0; k <= r.degree; k++) story->c[k] = r.c[k];
  }
  for (int k = 0; k < roots.count; k++) {
    double other = NAN;
    out->steps += roots.root[k].iterations;
    const enum root_fate fate = substitute(method, &form, size, &r, &roots.root[k], &other);
    if (story) story->fate[k] = fate, story->other[k] = other;
    if (fate != ROOT_OFFERED) continue;
    out->u[out->count] = of->v_kept ? other : roots.root[k].re;
    out->v[out->count++] = of->v_kept ? roots.root[k].re : other;
  }
}
