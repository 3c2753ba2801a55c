/* Double-double arithmetic: a number as the unevaluated sum of two doubles, about 106 bits.
 *
 * Dekker, A floating-point technique for extending the available precision (1971); Knuth's two-sum. Results carry a
 * relative error of a few 2^-104. Needs IEEE double arithmetic without contraction. Pure; safe on any thread.
 */
#ifndef PSCN_BASE_DOUBLE_DOUBLE_H
#define PSCN_BASE_DOUBLE_DOUBLE_H

#include <math.h>

struct double_double {
  double hi, lo; /* |lo| is at most half a unit in the last place of hi */
};

/* a + b exactly. */
static inline struct double_double dd_two_sum(double a, double b)
{
  const double s = a + b, t = s - a;
  return (struct double_double){s, (a - (s - t)) + (b - t)};
}

/* a b exactly, barring underflow. */
static inline struct double_double dd_two_product(double a, double b)
{
  const double p = a * b;
  return (struct double_double){p, fma(a, b, -p)};
}

static inline struct double_double dd_normal(double hi, double lo)
{
  const double s = hi + lo;
  return (struct double_double){s, lo - (s - hi)};
}

static inline struct double_double dd_negate(struct double_double a) { return (struct double_double){-a.hi, -a.lo}; }

static inline struct double_double dd_add(struct double_double a, struct double_double b)
{
  const struct double_double s = dd_two_sum(a.hi, b.hi), t = dd_two_sum(a.lo, b.lo);
  const struct double_double r = dd_normal(s.hi, s.lo + t.hi);
  return dd_normal(r.hi, r.lo + t.lo);
}

static inline struct double_double dd_scale(struct double_double a, double b)
{
  const struct double_double p = dd_two_product(a.hi, b);
  return dd_normal(p.hi, p.lo + a.lo * b);
}

static inline struct double_double dd_multiply(struct double_double a, struct double_double b)
{
  const struct double_double p = dd_two_product(a.hi, b.hi);
  return dd_normal(p.hi, p.lo + (a.hi * b.lo + a.lo * b.hi));
}

#endif
