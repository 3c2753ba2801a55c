/* A ray through a patch in fixed point: at points of it, and at its roots. Newton's method refines a root as far as
 * wide arithmetic allows, and the certificate proves it anew. See zoom.h.
 */
#include "intersect/exact/zoom.h"

#include <math.h>

#include "intersect/certificate.h"

/* Value and derivatives of a polynomial in powers of x and y. */
static void evaluate(fixed c[4][4], fixed x, fixed y, fixed *value, fixed *dx, fixed *dy)
{
  *value = *dx = *dy = 0;
  for (int i = 3; i >= 0; i--) {
    fixed row = 0, row_dy = 0;
    for (int j = 3; j >= 0; j--) row_dy = fixed_product(row_dy, y) + row, row = fixed_product(row, y) + c[i][j];
    *dx = fixed_product(*dx, x) + *value, *value = fixed_product(*value, x) + row;
    *dy = fixed_product(*dy, x) + row_dy;
  }
}

wide zoom_t(struct zoom *zoom, wide u, wide v)
{
  fixed depth, unused[2];
  evaluate(zoom->power[2], fixed_from_wide(2 * u - 1), fixed_from_wide(2 * v - 1), &depth, &unused[0], &unused[1]);
  return (fixed_wide(depth) / zoom->unit[2] - zoom->origin) * zoom->to_t;
}

double zoom_combinations(struct zoom *zoom, wide u, wide v, const double size[2], double row[2][2], double out[2][3])
{
  fixed f[2][3];
  double sum = 0;
  const double unit = fmin(zoom->unit[0], zoom->unit[1]), to[3] = {1 / unit, size[0] / unit, size[1] / unit};
  for (int k = 0; k < 2; k++)
    evaluate(zoom->power[k], fixed_from_wide(2 * u - 1), fixed_from_wide(2 * v - 1), &f[k][0], &f[k][1], &f[k][2]);
  for (int k = 0; k < 2; k++) {
    const fixed p = fixed_from(row[k][0] * (unit / zoom->unit[0])), q = fixed_from(row[k][1] * (unit / zoom->unit[1]));
    for (int n = 0; n < 3; n++) out[k][n] = fixed_double(fixed_product(p, f[0][n]) + fixed_product(q, f[1][n])) * to[n];
    sum = fmax(sum, fabs(row[k][0]) + fabs(row[k][1]));
  }
  return (sum + 1) * zoom->error / unit;
}

/* Units of x and y (certificate.h): 1, or across a border that is one point, the root's distance from there. */
struct units {
  double of[2];
  int border; /* geometry/edges.h; -1: none */
};

/* For second_bound: next to that border f is f there, and its terms of degree 1 and more in the distance from it. They
 * are bounded as far from it as the certificate reaches. */
static double second_bound_at_pole(fixed c[4][4], const struct units *units)
{
  const double r = 1 + 2 * LEAF_MARGIN, power[4] = {1, r, r * r, r * r * r};
  const double d = units->of[units->border / 2], far = d * (1 + CERTIFICATE_REACH);
  double sum = 0;
  for (int j = 0; j < 4; j++) {
    fixed at[4]; /* a quarter, so that what is moved has room */
    for (int i = 0; i < 4; i++) at[i] = (units->border < 2 ? c[i][j] : c[j][i]) / 4;
    for (int n = 0; n < 3; n++)
      for (int k = 2; k >= n; k--) at[k] += units->border & 1 ? at[k + 1] : -at[k + 1];
    for (int i = 1; i < 4; i++) {
      const double size = 4 * fabs(fixed_double(at[i])), by = i == 1 ? 1 : i == 2 ? far : far * far;
      if (i > 1) sum += i * (i - 1) * d * d * (i == 3 ? far : 1) * power[j] * size;
      if (j > 0) sum += 2 * i * j * d * by * power[j - 1] * size;
      if (j > 1) sum += j * (j - 1) * by * far * power[j - 2] * size;
    }
  }
  return sum;
}

/* A bound on |f_xx| + 2 |f_xy| + |f_yy| of the polynomial with these powers, in these units, for x and y up to
 * LEAF_MARGIN beyond the patch. */
static double second_bound(fixed c[4][4], const struct units *units)
{
  if (units->border >= 0) return second_bound_at_pole(c, units);
  const double r = 1 + 2 * LEAF_MARGIN, power[4] = {1, r, r * r, r * r * r};
  double sum = 0;
  for (int i = 0; i < 4; i++) {
    for (int j = 0; j < 4; j++) {
      const double size = fabs(fixed_double(c[i][j]));
      if (i > 1) sum += i * (i - 1) * power[i - 2] * power[j] * size;
      if (i > 0 && j > 0) sum += 2 * i * j * power[i - 1] * power[j - 1] * size;
      if (j > 1) sum += j * (j - 1) * power[i] * power[j - 2] * size;
    }
  }
  return sum;
}

/* Bound on rounding in a row of M. */
static double row_size(const struct zoom *zoom, const wide m[2])
{
  return (double)(wide_abs(m[0]) + wide_abs(m[1])) * zoom->error;
}

/* A bound on the second derivatives of the row's combination. They are much smaller than those of a and b if these are
 * nearly one. */
static double row_bend(struct zoom *zoom, const wide m[2], const struct units *units)
{
  const wide most = wide_max(wide_abs(m[0]), wide_abs(m[1]));
  fixed row[4][4];
  zoom_combine(zoom->power[0], zoom->power[1], fixed_from_wide(m[0] / most), fixed_from_wide(m[1] / most), row);
  return (double)most * second_bound(row, units) + CERTIFICATE_SECOND * row_size(zoom, m);
}

/* Newton's method ends when a step is within rounding, or more than half the one before. It starts within the root's
 * radius, where it converges quadratically except for the first few steps next to a pole. */
enum { SHARPEN_STEPS = 24 };

/* Newton's method from (x,y): sets where it ends, its last step in x and y, and the rows of the inverse Jacobian there.
 * The rows are wide: next to a pole the whole determinant is small, and so each row is right to its own last places. */
static bool newton(struct zoom *zoom, fixed *x, fixed *y, double out_step[2], wide m[2][2])
{
  static const fixed most = (fixed)((1 + 2 * LEAF_MARGIN - CERTIFICATE_REACH) / FIXED_UNIT);
  double before = INFINITY;
  for (int n = 0; n < SHARPEN_STEPS; n++) {
    fixed f[2][3];
    wide a[3], b[3];
    for (int k = 0; k < 2; k++) evaluate(zoom->power[k], *x, *y, &f[k][0], &f[k][1], &f[k][2]);
    for (int k = 0; k < 3; k++) a[k] = (wide)f[0][k], b[k] = (wide)f[1][k]; /* in units of FIXED_UNIT, like the steps */
    const wide determinant = a[1] * b[2] - a[2] * b[1];
    if (determinant == 0) return false;
    const wide inverse = (wide)(1 / FIXED_UNIT) / determinant;
    const wide step_x = (b[2] * a[0] - a[2] * b[0]) * inverse, step_y = (a[1] * b[0] - b[1] * a[0]) * inverse;
    out_step[0] = (double)wide_abs(step_x) * FIXED_UNIT, out_step[1] = (double)wide_abs(step_y) * FIXED_UNIT;
    const double step = fmax(out_step[0], out_step[1]);
    if (!(step <= 4)) return false;
    *x -= (fixed)step_x, *y -= (fixed)step_y;
    if (!(fixed_size(*x) <= most && fixed_size(*y) <= most)) return false;
    m[0][0] = b[2] * inverse, m[0][1] = -a[2] * inverse, m[1][0] = -b[1] * inverse, m[1][1] = a[1] * inverse;
    const double size[2] = {row_size(zoom, m[0]) / FIXED_UNIT, row_size(zoom, m[1]) / FIXED_UNIT};
    if (wide_abs(step_x) <= size[0] && wide_abs(step_y) <= size[1]) return true;
    if (n > 4 && step > before / 2) return true;
    before = step;
  }
  return true;
}

/* A root whose t is known to this many errors of wide arithmetic is not ill-conditioned: the ray meets the surface at a
 * slant no worse than about that. A choice of words: if two roots are no farther apart than their errors and one is
 * worse than this, their order is called grazing; otherwise they are at one place. */
#define TIE_ERRORS 256

/* Moves the root to a place that is better, but not proven: its bounds have to hold from there. */
static void move_root(struct zoom *zoom, wide u, wide v, struct exact_root *root)
{
  const wide t = zoom_t(zoom, u, v);
  root->radius_u += (double)wide_abs(u - root->u), root->radius_v += (double)wide_abs(v - root->v);
  root->t_error += (double)wide_abs(t - root->t);
  root->u = u, root->v = v, root->t = t;
}

/* What the certificate says of a root. */
struct proof {
  struct units units;
  double radius[2], alone; /* in x and y */
};

/* The certificate in these units, for a last step that went to (x,y). Returns whether it holds. */
static bool prove(struct zoom *zoom, const fixed at[2], const double steps[2], wide m[2][2], struct proof *out)
{
  const struct units *units = &out->units;
  double sizes[2], bends[2], step = 0;
  for (int k = 0; k < 2; k++) {
    sizes[k] = row_size(zoom, m[k]) / units->of[k], bends[k] = row_bend(zoom, m[k], units) / units->of[k];
    step = fmax(step, steps[k] / units->of[k]);
  }
  const double size = fmax(sizes[0], sizes[1]), bend = fmax(bends[0], bends[1]);
  if (!certificate_holds(bend, step, size)) return false;
  for (int k = 0; k < 2; k++) out->radius[k] = units->of[k] * certificate_radius(bends[k], step + size, sizes[k]);
  /* The certificate's map contracts as long as bend |w - z| plus rounding is less than 1, where bend is valid. */
  const double here = fixed_double(fixed_max(fixed_size(at[0]), fixed_size(at[1])));
  const double valid = units->border >= 0 ? CERTIFICATE_REACH : 1 + 2 * LEAF_MARGIN - here;
  out->alone = fmin(units->of[0], units->of[1]) * fmax(fmin(0.5 / bend, valid) - 2 * step, 0);
  return true;
}

/* The same in units of 1, or of the distance from a border that is one point. */
static bool prove_somehow(struct zoom *zoom, const fixed at[2], const double steps[2], wide m[2][2], struct proof *out)
{
  const fixed one = fixed_from(1);
  out->units = (struct units){{1, 1}, -1};
  if (prove(zoom, at, steps, m, out)) return true;
  for (int border = 0; border < 4; border++) {
    const int across = border / 2;
    const fixed from = border & 1 ? one - at[across] : one + at[across];
    if (!zoom->pole[border] || from <= 0 || from >= one) continue;
    out->units = (struct units){{1, 1}, border};
    out->units.of[across] = fixed_double(from);
    if (prove(zoom, at, steps, m, out)) return true;
  }
  return false;
}

bool zoom_sharpen(struct zoom *zoom, struct exact_root *root)
{
  fixed at[2] = {fixed_from_wide(2 * root->u - 1), fixed_from_wide(2 * root->v - 1)};
  double steps[2], radius[2];
  wide m[2][2];
  struct proof proof;
  if (!newton(zoom, &at[0], &at[1], steps, m)) return false;
  const wide u = (1 + fixed_wide(at[0])) / 2, v = (1 + fixed_wide(at[1])) / 2;
  if (!prove_somehow(zoom, at, steps, m, &proof)) {
    if (wide_abs(u - root->u) <= root->radius_u && wide_abs(v - root->v) <= root->radius_v) move_root(zoom, u, v, root);
    return false;
  }
  for (int k = 0; k < 2; k++) radius[k] = proof.radius[k] / 2 + (double)WIDE_ROUNDOFF;
  /* Each enclosure holds one root; it is the same root if the old enclosure holds the new one. */
  if (!((double)wide_abs(u - root->u) + radius[0] <= root->radius_u &&
        (double)wide_abs(v - root->v) + radius[1] <= root->radius_v))
    return false;
  fixed depth, dx, dy;
  evaluate(zoom->power[2], at[0], at[1], &depth, &dx, &dy);
  const double rx = 2 * radius[0], ry = 2 * radius[1], reach = rx / proof.units.of[0] + ry / proof.units.of[1];
  const double off = fabs(fixed_double(dx)) * rx + fabs(fixed_double(dy)) * ry +
                     second_bound(zoom->power[2], &proof.units) * reach * reach;
  root->u = u, root->v = v, root->t = (fixed_wide(depth) / zoom->unit[2] - zoom->origin) * zoom->to_t;
  root->radius_u = radius[0], root->radius_v = radius[1];
  root->alone = proof.alone / 2;
  root->t_error = error_to_t((double)zoom->to_t, off / zoom->unit[2] + zoom->depth_error) +
                  8 * (double)(WIDE_ROUNDOFF * wide_abs(root->t));
  root->sharp = true;
  root->well_known = root->t_error <= TIE_ERRORS * (zoom_error(zoom) * fabs((double)zoom->to_t) +
                                                    (double)(WIDE_ROUNDOFF * wide_abs(root->t)));
  return true;
}
