/* Boxes. See box.h. */
#include "intersect/exact/box.h"

#include <math.h>

#include "base/real.h"
#include "geometry/patch.h"
#include "intersect/certificate.h"

/* Newton's last step in box parameters: its square, all that the next one would be, is below the rounding of the
 * values. Not a tolerance of the answer, whose radius is computed. */
#define LAST_STEP 0x1p-28

/* Where p a + q b stands on the box: its hull in units of its error bound. */
static void combination(struct box *box, double p, double q, const double error[2], double out[2])
{
  const double unit = 1 / (fabs(p) * (error[0] + UNIT_ROUNDOFF * 4) + fabs(q) * (error[1] + UNIT_ROUNDOFF * 4));
  for (int n = 0; n < 16; n++) {
    const double value = (p * box->net[0][n / 4][n % 4] + q * box->net[1][n / 4][n % 4]) * unit;
    out[0] = n ? real_min(out[0], value) : value, out[1] = n ? real_max(out[1], value) : value;
  }
}

/* Tries the combinations a, b and the two rows of the adjugate Jacobian in the middle, which aim along the
 * parameters, or, where the Jacobian is singular, at the one direction in which the surface is seen edge-on. */
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

void box_bends(double n[4][4], double out[3])
{
  out[0] = out[1] = out[2] = 0;
  for (int i = 0; i < 4; i++) {
    for (int j = 0; j < 4; j++) {
      if (i < 2) out[0] = real_max(out[0], 6 * fabs(n[i + 2][j] - 2 * n[i + 1][j] + n[i][j]));
      if (i < 3 && j < 3) out[1] = real_max(out[1], 9 * fabs(n[i + 1][j + 1] - n[i + 1][j] - n[i][j + 1] + n[i][j]));
      if (j < 2) out[2] = real_max(out[2], 6 * fabs(n[i][j + 2] - 2 * n[i][j + 1] + n[i][j]));
    }
  }
}

/* A row of M times the polynomials: bounds on its second derivatives. */
static void row_bends(struct box *box, const double m[2], double out[3])
{
  double n[4][4];
  for (int c = 0; c < 16; c++) n[c / 4][c % 4] = m[0] * box->net[0][c / 4][c % 4] + m[1] * box->net[1][c / 4][c % 4];
  box_bends(n, out);
}

/* Whether a root in the middle would be shown to be alone, by M there: else Newton's process is mostly in vain. A choice
 * of speed. */
static bool may_be_alone(struct box *box, double m[2][2])
{
  for (int k = 0; k < 2; k++) {
    double s[3];
    row_bends(box, m[k], s);
    if (s[0] + 2 * s[1] + s[2] > 2 * CERTIFICATE_ALONE) return false;
  }
  return true;
}

/* The certificate in the box's own parameters, with the second derivatives of M's rows of the plane polynomials
 * themselves, for a last step that went to `root`. Sets the radii. */
static bool box_prove(struct box *box, double m[2][2], const double error[2], bool alone, double step,
                      const double root[2], double radius[2])
{
  const double out_u = real_max(-root[0], root[0] - 1), out_v = real_max(-root[1], root[1] - 1);
  if (!(out_u < BOX_MARGIN && out_v < BOX_MARGIN)) return false;
  const double growth = out_u > 0 || out_v > 0 ? BOX_MARGIN_GROWTH : 1;
  const double reach_u = 0.5 + fabs(root[0] - 0.5), reach_v = 0.5 + fabs(root[1] - 0.5);
  double bends[2], sizes[2], q = 0;
  for (int k = 0; k < 2; k++) {
    double s[3];
    row_bends(box, m[k], s);
    bends[k] = growth * (s[0] + 2 * s[1] + s[2]);
    sizes[k] = fabs(m[k][0]) * error[0] + fabs(m[k][1]) * error[1];
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

/* How many steps take a point of a box onto the ray, where they can: it converges quadratically, or halves what is left
 * where there is a double root; and how far off it may be then, in error bounds. A choice of words: what is told is
 * grazing. */
enum { ONTO_STEPS = 8, ONTO_ERRORS = 16 };

/* Keeps the shortest step finite where the polynomials are dependent: relative, a choice of how short it is then. */
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
    *u = real_min(real_max(*u - (p * a.du + q * b.du), 0), 1);
    *v = real_min(real_max(*v - (p * a.dv + q * b.dv), 0), 1);
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

/* ---- where a and b are one polynomial ---- */

/* The least and the largest of a net's derivative by u or by v; `off` bounds what the coefficients are off by. */
static void derivative_range(double n[4][4], bool by_u, double off, double out[2])
{
  out[0] = INFINITY, out[1] = -INFINITY;
  for (int i = 0; i < 3; i++) {
    for (int j = 0; j < 4; j++) {
      const double d = 3 * (by_u ? n[i + 1][j] - n[i][j] : n[j][i + 1] - n[j][i]);
      out[0] = real_min(out[0], d - 6 * off), out[1] = real_max(out[1], d + 6 * off);
    }
  }
}

/* The least size of a number in the range, and the largest. */
static double range_least(const double x[2]) { return real_max(real_max(x[0], -x[1]), 0); }
static double range_most(const double x[2]) { return real_max(fabs(x[0]), fabs(x[1])); }

/* Whether p q - r s is never 0. */
static bool never_zero(const double p[2], const double q[2], const double r[2], const double s[2])
{
  double low[2] = {INFINITY, INFINITY}, high[2] = {-INFINITY, -INFINITY};
  for (int n = 0; n < 4; n++) {
    const double one = p[n & 1] * q[n >> 1], two = r[n & 1] * s[n >> 1];
    low[0] = real_min(low[0], one), high[0] = real_max(high[0], one);
    low[1] = real_min(low[1], two), high[1] = real_max(high[1], two);
  }
  const double slack = 8 * UNIT_ROUNDOFF * (range_most(p) * range_most(q) + range_most(r) * range_most(s));
  return low[0] - high[1] > slack || low[1] - high[0] > slack;
}

static double cubic_at(const double c[4], double x, double *slope)
{
  const double y = 1 - x;
  *slope = 3 * (y * (y * (c[1] - c[0]) + 2 * x * (c[2] - c[1])) + x * x * (c[3] - c[2]));
  return y * y * (y * c[0] + 3 * x * c[1]) + x * x * (3 * y * c[2] + x * c[3]);
}

/* The root of a cubic that rises from below 0 to above, and whose coefficients are no larger than `most`: by Newton's
 * process where it stays next to it, else by halving. It ends where a value is what rounding makes. */
static double cubic_root(const double c[4], double most)
{
  double low = 0, high = 1, x = 0.5, slope;
  for (int n = 0; n < 64; n++) {
    const double value = cubic_at(c, x, &slope), next = x - value / slope;
    if (value < 0) low = x;
    else high = x;
    if (fabs(value) <= 4 * UNIT_ROUNDOFF * most) return real_min(real_max(next, low), high);
    x = next > low && next < high ? next : 0.5 * (low + high);
  }
  return x;
}

/* Where a side's coefficients are 0: out[..] along it, 0 to 2 places, each off by no more than *off; negative where that is
 * not known. */
static int side_places(const double c[4], double error, double out[2], double *off)
{
  double least = INFINITY, rise = INFINITY, fall = INFINITY, most = 0;
  for (int n = 0; n < 4; n++) {
    least = real_min(least, c[0] > 0 ? c[n] : -c[n]), most = real_max(most, fabs(c[n]));
    if (n > 0) rise = real_min(rise, c[n] - c[n - 1]), fall = real_min(fall, c[n - 1] - c[n]);
  }
  *off = 0;
  if (least > error) return 0;
  if (most <= error) {
    out[0] = 0, out[1] = 1;
    return 2;
  }
  const double slope = 3 * (real_max(rise, fall) - 2 * error);
  if (!(slope > 0)) return -1;
  *off = 2 * error / slope;
  double up[4];
  for (int n = 0; n < 4; n++) up[n] = rise > fall ? c[n] : -c[n];
  if (up[0] > error || up[3] < -error) return 0;
  out[0] = up[0] >= 0 ? 0 : up[3] <= 0 ? 1 : cubic_root(up, most);
  return 1;
}

/* Which of a and b is the larger one; negative where the other one is not a multiple of it to rounding. */
static int one_of_two(struct box *box, const double error[2])
{
  double most[2] = {0, 0};
  for (int k = 0; k < 2; k++)
    for (int n = 0; n < 16; n++)
      if (fabs(box->net[k][n / 4][n % 4]) > fabs(most[k])) most[k] = box->net[k][n / 4][n % 4];
  const int larger = fabs(most[1]) > fabs(most[0]);
  double factor = 0;
  for (int n = 0; n < 16; n++)
    if (box->net[larger][n / 4][n % 4] == most[larger]) factor = box->net[!larger][n / 4][n % 4] / most[larger];
  for (int n = 0; n < 16; n++) {
    const double off = box->net[!larger][n / 4][n % 4] - factor * box->net[larger][n / 4][n % 4];
    if (!(fabs(off) <= 2 * (error[0] + error[1]) + 8 * UNIT_ROUNDOFF)) return -1;
  }
  return larger;
}

enum box_curves box_curves_begin(struct box *box, const double error[2], double way, double *u, double *v, double *off)
{
  double du[2][2], dv[2][2], first = INFINITY;
  const int larger = one_of_two(box, error);
  if (larger < 0) return BOX_CURVES_UNKNOWN;
  double(*c)[4] = box->net[larger], (*w)[4] = box->net[2];
  const double bound = error[larger] + 4 * UNIT_ROUNDOFF;
  derivative_range(c, true, bound, du[0]), derivative_range(c, false, bound, dv[0]);
  derivative_range(w, true, 4 * UNIT_ROUNDOFF, du[1]), derivative_range(w, false, 4 * UNIT_ROUNDOFF, dv[1]);
  if (!never_zero(du[0], dv[1], dv[0], du[1])) return BOX_CURVES_UNKNOWN;
  *off = 0;
  for (int side = 0; side < 4; side++) {
    const double end = side & 1, steep = range_least(side < 2 ? du[0] : dv[0]);
    double on[4], depth[4], place[2], away, slope;
    for (int n = 0; n < 4; n++) {
      const int i = side < 2 ? 3 * (side & 1) : n, j = side < 2 ? n : 3 * (side & 1);
      on[n] = c[i][j], depth[n] = w[i][j];
    }
    const int places = side_places(on, bound, place, &away);
    if (places < 0 || (places == 2 && !(steep > 0))) return BOX_CURVES_UNKNOWN;
    /* Where all of the side is on the ray, to rounding, so is what is this near to it. */
    const double beside = places == 2 ? 2 * bound / steep * range_most(side < 2 ? du[1] : dv[1]) : 0;
    for (int n = 0; n < places; n++) {
      const double at = way * cubic_at(depth, place[n], &slope);
      *off = real_max(*off, away * range_most(side < 2 ? dv[1] : du[1]) + beside);
      if (!(at < first)) continue;
      first = at, *u = side < 2 ? end : place[n], *v = side < 2 ? place[n] : end;
    }
  }
  return first < INFINITY ? BOX_CURVES_BEGIN : BOX_CURVES_NONE;
}

bool box_curves_at(struct box *box, const double error[2], double depth, double *u, double *v)
{
  const int larger = one_of_two(box, error);
  *u = *v = 0.5;
  for (int n = 0; n < ONTO_STEPS && larger >= 0; n++) {
    const struct patch_jet c = patch_evaluate(box->net[larger], *u, *v), w = patch_evaluate(box->net[2], *u, *v);
    const double off = w.value - depth, inverse = 1 / (c.du * w.dv - c.dv * w.du);
    if (fabs(c.value) <= ONTO_ERRORS * error[larger] && fabs(off) <= ONTO_ERRORS * UNIT_ROUNDOFF) return true;
    *u -= (w.dv * c.value - c.dv * off) * inverse, *v -= (c.du * off - w.du * c.value) * inverse;
    if (!(*u >= 0 && *u <= 1 && *v >= 0 && *v <= 1)) return false;
  }
  return false;
}
