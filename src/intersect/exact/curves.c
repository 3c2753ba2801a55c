/* Boxes on which a and b are one polynomial. See curves.h. */
#include "intersect/exact/curves.h"

#include <math.h>

#include "base/real.h"
#include "geometry/patch.h"

/* The range of a net's derivative by u or by v. `off` bounds the errors of the coefficients. */
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

/* The least and the largest absolute value in the range. */
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

/* The root of a cubic that rises from below 0 to above and has coefficients no larger than `most`: by Newton's method
 * as long as it stays between the bounds, else by halving. It ends when a value is within rounding. */
static double cubic_root(const double c[4], double most)
{
  double low = 0, high = 1, x = 0.5, slope;
  for (int n = 0; n < 64; n++) {
    const double value = cubic_at(c, x, &slope), next = x - value / slope;
    if (value < 0) low = x;
    else high = x;
    if (fabs(value) <= 4 * UNIT_ROUNDOFF * most) return real_clamp(next, low, high);
    x = next > low && next < high ? next : 0.5 * (low + high);
  }
  return x;
}

/* Where the cubic along a side is 0: sets out[..] to 0 to 2 places, each off by no more than *off, and returns their
 * number; negative if that is not known. */
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

/* The larger one of a and b; negative if the other one is not a multiple of it up to rounding. */
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

enum curves curves_begin(struct box *box, const double error[2], double way, double *u, double *v, double *off)
{
  double du[2][2], dv[2][2], first = INFINITY;
  const int larger = one_of_two(box, error);
  if (larger < 0) return CURVES_UNKNOWN;
  double(*c)[4] = box->net[larger], (*w)[4] = box->net[2];
  const double bound = error[larger] + 4 * UNIT_ROUNDOFF;
  derivative_range(c, true, bound, du[0]), derivative_range(c, false, bound, dv[0]);
  derivative_range(w, true, 4 * UNIT_ROUNDOFF, du[1]), derivative_range(w, false, 4 * UNIT_ROUNDOFF, dv[1]);
  if (!never_zero(du[0], dv[1], dv[0], du[1])) return CURVES_UNKNOWN;
  *off = 0;
  for (int side = 0; side < 4; side++) {
    const double end = side & 1, steep = range_least(side < 2 ? du[0] : dv[0]);
    double on[4], depth[4], place[2], away, slope;
    for (int n = 0; n < 4; n++) {
      const int i = side < 2 ? 3 * (side & 1) : n, j = side < 2 ? n : 3 * (side & 1);
      on[n] = c[i][j], depth[n] = w[i][j];
    }
    const int places = side_places(on, bound, place, &away);
    if (places < 0 || (places == 2 && !(steep > 0))) return CURVES_UNKNOWN;
    /* If all of the side is on the ray, up to rounding, so is anything this near to it. */
    const double beside = places == 2 ? 2 * bound / steep * range_most(side < 2 ? du[1] : dv[1]) : 0;
    for (int n = 0; n < places; n++) {
      const double at = way * cubic_at(depth, place[n], &slope);
      *off = real_max(*off, away * range_most(side < 2 ? dv[1] : du[1]) + beside);
      if (!(at < first)) continue;
      first = at, *u = side < 2 ? end : place[n], *v = side < 2 ? place[n] : end;
    }
  }
  return first < INFINITY ? CURVES_BEGIN : CURVES_NONE;
}

bool curves_at(struct box *box, const double error[2], double depth, double *u, double *v)
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
