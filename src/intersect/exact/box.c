/* Boxes. See box.h. */
#include "intersect/exact/box.h"

#include <math.h>

#include "base/real.h"
#include "geometry/patch.h"
#include "intersect/certificate.h"

/* Newton's last step, in box parameters: its square, which would be the next step, is below the rounding of the values.
 * This is not a tolerance of the answer, whose radius is computed. */
#define LAST_STEP 0x1p-28

/* The hull of p a + q b on the box, in units of its error bound. */
static void combination(struct box *box, double p, double q, const double error[2], double out[2])
{
  const double unit = 1 / (fabs(p) * (error[0] + UNIT_ROUNDOFF * 4) + fabs(q) * (error[1] + UNIT_ROUNDOFF * 4));
  for (int n = 0; n < 16; n++) {
    const double value = (p * box->net[0][n / 4][n % 4] + q * box->net[1][n / 4][n % 4]) * unit;
    out[0] = n ? real_min(out[0], value) : value, out[1] = n ? real_max(out[1], value) : value;
  }
}

/* Tries the combinations a, b and the two rows of the adjugate Jacobian in the middle. The rows aim along the
 * parameters, or, if the Jacobian is singular, in the one direction in which the surface is seen edge-on. */
enum verdict box_test(struct box *box, const double error[2])
{
  const struct patch_jet a = patch_evaluate(box->net[0], 0.5, 0.5);
  const struct patch_jet b = patch_evaluate(box->net[1], 0.5, 0.5);
  const double rows[4][2] = {{1, 0}, {0, 1}, {b.dv, -a.dv}, {-b.du, a.du}};
  bool flat = false, steep = false;
  for (int k = 0; k < 4; k++) {
    if (rows[k][0] == 0 && rows[k][1] == 0) continue;
    double range[2] = {0, 0};
    combination(box, rows[k][0], rows[k][1], error, range);
    if (range[0] > 1 || range[1] < -1) return VERDICT_EMPTY;
    if (range[0] > -FLAT_ERRORS && range[1] < FLAT_ERRORS) flat = true;
    else steep = true;
  }
  return !flat ? VERDICT_OPEN : steep ? VERDICT_FLAT : VERDICT_POINT;
}

/* Bounds on the second derivatives of a row of M times the polynomials. */
static void row_bends(struct box *box, const double m[2], double out[3])
{
  double n[4][4];
  for (int c = 0; c < 16; c++) n[c / 4][c % 4] = m[0] * box->net[0][c / 4][c % 4] + m[1] * box->net[1][c / 4][c % 4];
  patch_bends(n, out);
}

/* Whether M there would prove a root in the middle alone; otherwise Newton's method is mostly in vain. A choice of
 * speed. */
static bool may_be_alone(struct box *box, double m[2][2])
{
  for (int k = 0; k < 2; k++) {
    double s[3];
    row_bends(box, m[k], s);
    if (s[0] + 2 * s[1] + s[2] > 2 * CERTIFICATE_ALONE) return false;
  }
  return true;
}

/* Up to this far outside the box, a value is off by (1 + 2/128)^6 = 1.1 times as much as coefficients, which the
 * theorem has to spare. */
#define BESIDE 0x1p-7

/* The certificate in the box's parameters, for a last step that went to `root`. It uses the second derivatives of M's
 * rows times the plane polynomials themselves. Sets the radii. */
static bool box_prove(struct box *box, double m[2][2], const double error[2], bool alone, double step,
                      const double root[2], double radius[2])
{
  const double out_u = real_max(-root[0], root[0] - 1) + CERTIFICATE_REACH;
  const double out_v = real_max(-root[1], root[1] - 1) + CERTIFICATE_REACH;
  if (!(out_u < BOX_MARGIN && out_v < BOX_MARGIN)) return false;
  const double growth = out_u > 0 || out_v > 0 ? BOX_MARGIN_GROWTH : 1;
  const double off = real_max(out_u, out_v) > BESIDE + CERTIFICATE_REACH ? BOX_MARGIN_OFF : 1;
  const double reach_u = 0.5 + fabs(root[0] - 0.5), reach_v = 0.5 + fabs(root[1] - 0.5);
  double bends[2], sizes[2], q = 0;
  for (int k = 0; k < 2; k++) {
    double s[3];
    row_bends(box, m[k], s);
    bends[k] = growth * (s[0] + 2 * s[1] + s[2]);
    sizes[k] = off * (fabs(m[k][0]) * error[0] + fabs(m[k][1]) * error[1]);
    q = real_max(q, growth * ((s[0] + s[1]) * reach_u + (s[1] + s[2]) * reach_v));
  }
  const double bend = real_max(bends[0], bends[1]), size = real_max(sizes[0], sizes[1]);
  for (int k = 0; k < 2; k++) radius[k] = certificate_radius(bends[k], step + size, sizes[k]);
  return certificate_holds(bend, step, size) && (!alone || certificate_alone(q, size));
}

bool box_solve(struct box *box, const double error[2], bool alone, double root[2], double radius[2])
{
  double u = root[0], v = root[1], step = 2, m[2][2] = {{0}};
  for (int n = 0; n < 12 && step > LAST_STEP; n++) {
    const struct patch_jet a = patch_evaluate(box->net[0], u, v), b = patch_evaluate(box->net[1], u, v);
    const double determinant = a.du * b.dv - a.dv * b.du;
    if (determinant == 0) return false;
    const double inverse = 1 / determinant;
    m[0][0] = b.dv * inverse, m[0][1] = -a.dv * inverse, m[1][0] = -b.du * inverse, m[1][1] = a.du * inverse;
    if (alone && n == 0 && !may_be_alone(box, m)) return false;
    const double su = m[0][0] * a.value + m[0][1] * b.value, sv = m[1][0] * a.value + m[1][1] * b.value;
    step = real_max(fabs(su), fabs(sv));
    u -= su, v -= sv;
    if (!(fabs(u - 0.5) < 1 && fabs(v - 0.5) < 1)) return false;
  }
  if (!(step <= LAST_STEP)) return false;
  root[0] = u, root[1] = v;
  return box_prove(box, m, error, alone, step, root, radius);
}

/* Keeps the shortest step finite if the polynomials are dependent. It is relative: a choice of how short the step then
 * is. */
#define LEAST_DEPENDENT 0x1p-40

bool box_onto_ray(struct box *box, const double error[2], double *u, double *v)
{
  for (int n = 0; n < ONTO_STEPS; n++) {
    const struct patch_jet a = patch_evaluate(box->net[0], *u, *v), b = patch_evaluate(box->net[1], *u, *v);
    if (fabs(a.value) <= ONTO_ERRORS * error[0] && fabs(b.value) <= ONTO_ERRORS * error[1]) return true;
    double aa = a.du * a.du + a.dv * a.dv, bb = b.du * b.du + b.dv * b.dv;
    const double ab = a.du * b.du + a.dv * b.dv, least = LEAST_DEPENDENT * real_max(aa, bb);
    aa += least, bb += least;
    const double determinant = aa * bb - ab * ab;
    if (!(determinant > 0)) break;
    const double p = (bb * a.value - ab * b.value) / determinant, q = (aa * b.value - ab * a.value) / determinant;
    *u = real_clamp(*u - (p * a.du + q * b.du), 0, 1);
    *v = real_clamp(*v - (p * a.dv + q * b.dv), 0, 1);
  }
  return false;
}

void box_variation(const struct box *box, int first, int last, double *along_u, double *along_v)
{
  *along_u = *along_v = 0;
  for (int k = first; k <= last; k++) {
    for (int i = 0; i < 4; i++) {
      for (int j = 0; j < 3; j++) {
        *along_v = real_max(*along_v, fabs(box->net[k][i][j + 1] - box->net[k][i][j]));
        *along_u = real_max(*along_u, fabs(box->net[k][j + 1][i] - box->net[k][j][i]));
      }
    }
  }
}

static void cubic_halves(const double *c, int stride, double *low, double *high)
{
  const double half = 0.5, c1 = c[stride], c2 = c[2 * stride];
  const double q0 = half * (c[0] + c1), q1 = half * (c1 + c2), q2 = half * (c2 + c[3 * stride]);
  const double r0 = half * (q0 + q1), r1 = half * (q1 + q2);
  low[0] = c[0], low[stride] = q0, low[2 * stride] = r0;
  low[3 * stride] = high[0] = half * (r0 + r1);
  high[stride] = r1, high[2 * stride] = q2, high[3 * stride] = c[3 * stride];
}

void box_cut(struct box *box, bool across_u, struct box out[2])
{
  for (int h = 0; h < 2; h++) {
    out[h].u = box->u, out[h].v = box->v, out[h].size_u = box->size_u, out[h].size_v = box->size_v;
    if (across_u) out[h].size_u /= 2, out[h].u += h * out[h].size_u;
    else out[h].size_v /= 2, out[h].v += h * out[h].size_v;
    out[h].halvings = box->halvings + 1;
  }
  for (int k = 0; k < 3; k++)
    for (int n = 0; n < 4; n++)
      if (across_u) cubic_halves(&box->net[k][0][n], 4, &out[0].net[k][0][n], &out[1].net[k][0][n]);
      else cubic_halves(box->net[k][n], 1, out[0].net[k][n], out[1].net[k][n]);
}
