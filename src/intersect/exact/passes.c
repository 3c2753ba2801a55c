/* Whether a ray passes exactly through a point: all minors of (point - origin, direction) vanish. See judge.h. */
#include <math.h>

#include "base/double_double.h"
#include "base/real.h"
#include "intersect/exact/judge.h"

/* Adds x exactly to the sum of the terms e[0..count-1]. Returns their new number (Shewchuk, Adaptive precision
 * floating-point arithmetic, 1997). */
static int expansion_add(double e[], int count, double x)
{
  int kept = 0;
  for (int k = 0; k < count; k++) {
    const struct double_double s = dd_two_sum(e[k], x);
    x = s.hi;
    if (s.lo != 0) e[kept++] = s.lo;
  }
  if (x != 0) e[kept++] = x;
  return kept;
}

/* Smaller products, except 0, may have lost digits. */
#define LEAST_PRODUCT 0x1p-900

bool judge_passes(const struct ray *ray, const double point[3])
{
  double largest = 0;
  int exponent;
  for (int k = 0; k < 3; k++) largest = real_max(largest, fabs(point[k] - ray->origin[k]));
  frexp(largest, &exponent);
  for (int i = 0; i < 3; i++) {
    const int j = (i + 1) % 3;
    double sum[16];
    int count = 0;
    for (int s = 0; s < 2; s++) {
      const int at = s ? j : i, by = s ? i : j;
      const struct double_double way = dd_two_sum(point[at], -ray->origin[at]);
      const double d = s ? -ray->direction[by] : ray->direction[by],
                   parts[2] = {ldexp(way.lo, -exponent), ldexp(way.hi, -exponent)};
      if (ldexp(parts[0], exponent) != way.lo || ldexp(parts[1], exponent) != way.hi) return false;
      for (int n = 0; n < 2; n++) {
        const struct double_double p = dd_two_product(parts[n], d);
        if (parts[n] != 0 && d != 0 && !(fabs(p.hi) >= LEAST_PRODUCT && fabs(p.hi) <= 1 / LEAST_PRODUCT)) return false;
        count = expansion_add(sum, expansion_add(sum, count, p.lo), p.hi);
      }
    }
    if (count != 0) return false;
  }
  return true;
}
