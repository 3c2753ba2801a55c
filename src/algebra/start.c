/* Start values: Aberth's circle, Newton's polygon, and the roots of the previous polynomial.
 *
 * Aberth's circle (section 3.4 of the paper): the centre is the centroid of the roots, -c[n-1] / (n c[n]). The radius
 * is Cauchy's bound, to RADIUS_ACCURACY: the positive root of |b[n]| r^n = sum over k < n of |b[k]| r^k, with b the
 * coefficients about the centre. So the circle holds every root, or nearly. The values are spread evenly on it, turned
 * by a quarter of their spacing, so that they are not in conjugate pairs, which the iteration could not part.
 *
 * Newton's polygon (D. Bini, "Numerical computation of polynomial zeros by means of Aberth's method", 1996) is the
 * upper convex hull of the points (k, log |c[k]|). An edge from k to l stands for l - k roots of modulus about
 * |c[k]/c[l]|^(1/(l-k)), and as many values are spread on the circle of that radius about 0.
 */
#include "algebra/root_problem.h"

#include <float.h>
#include <string.h>

/* Newton's method on Cauchy's equation, in 1/r, steps below the root at once, then rises, and ends below it by a part
 * of the accuracy. This is more steps than it takes. */
enum { RADIUS_STEPS = 60 };
#define RADIUS_ACCURACY 1e-2 /* relative; a start radius needs no more */

/* Warm starts nearer to each other than this, relative to their modulus, are moved apart by as much. The values of a
 * double root are uncertain by the square root of 2^-53, 1e-8, so nothing known is lost. Differences of 1e-9 keep seven
 * digits. */
#define COINCIDENCE 1e-9

/* Cauchy's bound. The first guess, the largest of (n |b[k]/b[n]|)^(1/(n-k)), is not below it. */
static double cauchy_radius(int n, const double b[])
{
  double height = -INFINITY; /* log2 of the guess */
  const double top = log2(fabs(b[n])), more = log2(n);
  for (int k = 0; k < n; k++)
    if (b[k] != 0.0) height = fmax(height, (more + log2(fabs(b[k])) - top) / (n - k));
  double radius = exp2(height);
  for (int step = 0; step < RADIUS_STEPS && radius > 0.0; step++) {
    /* f(r) = sum |b[k]| r^(k-n) - |b[n]|, in powers of 1/r */
    const double w = 1.0 / radius;
    double f = fabs(b[0]), slope = 0.0;
    for (int k = 1; k <= n; k++) {
      slope = slope * w + f;
      f = f * w + (k == n ? -fabs(b[n]) : fabs(b[k]));
    }
    const double next_w = w - f / slope;
    if (!(next_w > 0.0) || !isfinite(next_w)) break;
    const double next = 1.0 / next_w;
    const bool near = fabs(next - radius) <= RADIUS_ACCURACY * radius;
    radius = next;
    if (near) break;
  }
  return radius;
}

double start_mean_modulus(const struct root_problem *problem)
{
  return exp2((log2(fabs(problem->c[0])) - log2(fabs(problem->c[problem->degree]))) / problem->degree);
}

static void circle_values(const struct root_problem *problem, int wanted, double out_re[], double out_im[])
{
  const int n = problem->degree;
  double centre = -problem->c[n - 1] / (n * problem->c[n]);
  double b[POLYNOMIAL_MAX_DEGREE + 1];
  memcpy(b, problem->c, sizeof b[0] * (size_t)(n + 1));
  for (int j = 0; j < n; j++)
    for (int k = n - 1; k >= j; k--) b[k] += b[k + 1] * centre;
  double radius = cauchy_radius(n, b);
  if (!(radius > 0.0 && radius < sqrt(DBL_MAX)) || !(fabs(centre) < sqrt(DBL_MAX))) {
    /* All roots are equal, or the centre overflows. The mean modulus about 0 is always finite and positive. */
    centre = 0.0;
    radius = start_mean_modulus(problem);
  }
  const double turn = 2.0 * acos(-1.0) / n;
  for (int i = 0; i < wanted; i++) {
    const double angle = turn * (i + 0.25);
    out_re[i] = centre + radius * cos(angle);
    out_im[i] = radius * sin(angle);
  }
}

static void polygon_values(const struct root_problem *problem, int wanted, double out_re[], double out_im[])
{
  const int n = problem->degree;
  double height[POLYNOMIAL_MAX_DEGREE + 1];
  int corner[POLYNOMIAL_MAX_DEGREE + 1], corners = 0;
  for (int k = 0; k <= n; k++) {
    height[k] = log2(fabs(problem->c[k])); /* -infinity for 0: never on the hull, whose ends are not 0 */
    if (problem->c[k] != 0.0) corners = polynomial_add_corner(height, corner, corners, k);
  }
  const double full_turn = 2.0 * acos(-1.0);
  int i = 0;
  for (int edge = 0; edge + 1 < corners && i < wanted; edge++) {
    const int low = corner[edge], count = corner[edge + 1] - low;
    const double radius = exp2((height[low] - height[low + count]) / count);
    for (int k = 0; k < count && i < wanted; k++, i++) {
      /* Each circle is turned by its own angle, so that values are not conjugate and do not line up. */
      const double angle = full_turn * ((k + 0.25) / count + (double)edge / n);
      out_re[i] = radius * cos(angle);
      out_im[i] = radius * sin(angle);
    }
  }
}

/* The roots of `warm` in x. Returns false if there are not as many as the problem has, or if one is 0 or infinite. */
static bool warm_values(const struct root_problem *problem, const struct solver_warm *warm, double out_re[],
                        double out_im[])
{
  if (warm == NULL || warm->count != problem->degree) return false;
  for (int i = 0; i < warm->count; i++) {
    const struct complex_number u = {ldexp(warm->re[i], -problem->unit), ldexp(warm->im[i], -problem->unit)};
    const struct complex_number x = root_problem_x_from_u(problem->basis, u);
    if (!isfinite(x.re) || !isfinite(x.im) || (x.re == 0.0 && x.im == 0.0)) return false;
    out_re[i] = x.re;
    out_im[i] = x.im;
  }
  return true;
}

void start_values(const struct root_problem *problem, enum radii radii, const struct solver_warm *warm, int wanted,
                  double out_re[], double out_im[])
{
  const int n = problem->degree;
  if (!warm_values(problem, warm, out_re, out_im)) {
    (radii == RADII_CIRCLE ? circle_values : polygon_values)(problem, wanted, out_re, out_im);
    return;
  }
  for (int i = 0; i < n; i++) {
    for (int j = 0; j < i; j++) {
      const double dx = out_re[i] - out_re[j], dy = out_im[i] - out_im[j];
      const double size = fabs(out_re[i]) + fabs(out_im[i]);
      if (fabs(dx) + fabs(dy) <= COINCIDENCE * size) {
        const double angle = i; /* a different direction for each */
        out_re[i] += 2.0 * COINCIDENCE * size * cos(angle);
        out_im[i] += 2.0 * COINCIDENCE * size * sin(angle);
      }
    }
  }
}
