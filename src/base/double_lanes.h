/* Double-double arithmetic on lanes: base/double_double.h, several numbers side by side.
 *
 * Contains only what the last places of a hit need. Sums are kept as they arise (hi, lo), |lo| a few units in the last
 * place of hi, and are not normalised in between. Needs compilation without contraction, except for double_lanes_sum.
 */
#ifndef PSCN_BASE_DOUBLE_LANES_H
#define PSCN_BASE_DOUBLE_LANES_H

#include "base/lanes.h"

struct double_lanes {
  lanes hi, lo;
};

/* a + b exactly. */
LANES_INLINE struct double_lanes double_lanes_sum(lanes a, lanes b)
{
  const lanes s = a + b, t = s - a;
  return (struct double_lanes){s, (a - (s - t)) + (b - t)};
}

/* a b exactly, barring underflow. */
LANES_INLINE struct double_lanes double_lanes_product(lanes a, lanes b)
{
  const lanes p = a * b;
  return (struct double_lanes){p, lanes_product_error(a, b, p)};
}

LANES_INLINE struct double_lanes double_lanes_multiply(struct double_lanes a, struct double_lanes b)
{
  const struct double_lanes p = double_lanes_product(a.hi, b.hi);
  return (struct double_lanes){p.hi, lanes_multiply_add(a.hi, b.lo, lanes_multiply_add(a.lo, b.hi, p.lo))};
}

LANES_INLINE struct double_lanes double_lanes_scale(struct double_lanes a, lanes b)
{
  const struct double_lanes p = double_lanes_product(a.hi, b);
  return (struct double_lanes){p.hi, lanes_multiply_add(a.lo, b, p.lo)};
}

LANES_INLINE struct double_lanes double_lanes_add(struct double_lanes a, struct double_lanes b)
{
  const struct double_lanes s = double_lanes_sum(a.hi, b.hi);
  return (struct double_lanes){s.hi, s.lo + (a.lo + b.lo)};
}

LANES_INLINE struct double_lanes double_lanes_subtract(struct double_lanes a, struct double_lanes b)
{
  return double_lanes_add(a, (struct double_lanes){-b.hi, -b.lo});
}

/* A number of size up to 2^24 as head + tail, exactly, the head being a multiple of 2^-26. Products of heads with
 * numbers of few bits are exact, and so are their sums. */
struct split_lanes {
  lanes head, tail;
};

LANES_INLINE lanes split_lanes_head(lanes x)
{
  const lanes unit = lanes_all(0x1.8p26);
  return (x + unit) - unit;
}

LANES_INLINE struct split_lanes split_lanes_of(lanes x)
{
  const lanes head = split_lanes_head(x);
  return (struct split_lanes){head, x - head};
}

#endif
