/* The arithmetic of transforms. Compiled once per instruction set. */
#include "geometry/transform.h"

#include "base/double_lanes.h"
#include "base/kernel.h"
#include "base/real.h"

/* The rows of a transform, and the points of a row; LANES of them are done at once. */
enum { ROWS = 4 };

static const struct double_lanes ZERO = {{0}, {0}};

/* As in double_double.h, on several lanes. */
static struct double_lanes normal(lanes hi, lanes lo)
{
  const lanes s = hi + lo;
  return (struct double_lanes){s, lo - (s - hi)};
}

static struct double_lanes add(struct double_lanes a, struct double_lanes b)
{
  const struct double_lanes s = double_lanes_sum(a.hi, b.hi), t = double_lanes_sum(a.lo, b.lo);
  const struct double_lanes r = normal(s.hi, s.lo + t.hi);
  return normal(r.hi, r.lo + t.lo);
}

/* sum + a b. Most entries of transforms are 0, and are left out. */
static struct double_lanes add_product(struct double_lanes sum, struct double_lanes a, struct double_double b)
{
  if (b.hi == 0) return sum;
  const struct double_lanes p = double_lanes_product(a.hi, lanes_all(b.hi));
  const struct double_lanes more = add(sum, normal(p.hi, p.lo + (a.hi * b.lo + a.lo * b.hi)));
  const lane_mask zero = a.hi == 0;
  return (struct double_lanes){lanes_select(zero, sum.hi, more.hi), lanes_select(zero, sum.lo, more.lo)};
}

/* The columns of LANES rows, from `row` on. */
static void load_columns(const struct transform *transform, size_t row, struct double_lanes out[3])
{
  const double *from = &transform->A[row][0].hi;
  struct double_lanes x, y, z;
  lanes_load4(from, 6, &x.hi, &x.lo, &y.hi, &y.lo);
  lanes_load4(from + 2, 6, &y.hi, &y.lo, &z.hi, &z.lo);
  out[0] = x, out[1] = y, out[2] = z;
}

static void store_columns(const struct double_lanes column[3], size_t row, struct transform *out)
{
  double *to = &out->A[row][0].hi;
  lanes_store4(column[0].hi, column[0].lo, column[1].hi, column[1].lo, to, 6);
  lanes_store4(column[1].hi, column[1].lo, column[2].hi, column[2].lo, to + 2, 6);
}

static void compose(const struct transform *first, const struct transform *second, struct transform *out)
{
  out->identity = out->moves = false;
  for (size_t row = 0; row < ROWS; row += LANES) {
    struct double_lanes a[3], sum[3] = {ZERO, ZERO, ZERO};
    load_columns(first, row, a);
#pragma GCC unroll 3
    for (int j = 0; j < 3; j++) {
      if (row + LANES == ROWS) sum[j].hi[LANES - 1] = second->A[3][j].hi, sum[j].lo[LANES - 1] = second->A[3][j].lo;
#pragma GCC unroll 3
      for (int k = 0; k < 3; k++) sum[j] = add_product(sum[j], a[k], second->A[k][j]);
    }
    store_columns(sum, row, out);
  }
}

static void apply(const struct transform *transform, const transform_row p, transform_row out)
{
  for (size_t row = 0; row < ROWS; row += LANES) {
    lanes from[3], to[3];
    for (int k = 0; k < 3; k++) from[k] = lanes_load_every(&p[row][k], 3);
    for (int j = 0; j < 3; j++) {
      const struct double_double *b = &transform->A[3][j];
      struct double_lanes q = {lanes_all(b->hi), lanes_all(b->lo)};
      for (int k = 0; k < 3; k++) {
        const struct double_double a = transform->A[k][j];
        if (a.hi == 0) continue;
        const struct double_lanes product = double_lanes_product(lanes_all(a.hi), from[k]);
        q = add(q, normal(product.hi, product.lo + a.lo * from[k]));
      }
      to[j] = q.hi + q.lo;
    }
    for (int j = 0; j < 3; j++)
      for (size_t n = 0; n < LANES; n++) out[row + n][j] = to[j][n];
  }
}

/* (a + error) / b to about 104 bits, for an error no larger than the rounding of a. */
static struct double_double divide(double a, double error, double b)
{
  const double q = a / b;
  const struct double_double back = dd_two_product(q, b);
  return dd_normal(q, ((a - back.hi) - back.lo + error) / b);
}

/* The sum of (-1)^n x^(2n+1) / (2n+1)! for |x| <= pi/4, up to a term that is less than the rounding of the sum. From
 * the first term below 2^-53 of the sum on, terms are doubles, whose own rounding is below 2^-106 of it. */
static struct double_double sine(struct double_double x)
{
  const struct double_double square = dd_negate(dd_multiply(x, x));
  struct double_double term = x, sum = x;
  int n = 2;
  for (; fabs(term.hi) > 0x1p-53 * fabs(sum.hi); n += 2) {
    term = dd_multiply(term, divide(square.hi, square.lo, (double)(n * (n + 1))));
    sum = dd_add(sum, term);
  }
  double small = term.hi, tail = 0;
  for (; fabs(small) > 0x1p-108 * fabs(sum.hi); n += 2) {
    small *= square.hi / (double)(n * (n + 1));
    tail += small;
  }
  return dd_normal(sum.hi, sum.lo + tail);
}

/* The cosine for that sine, at least sqrt(1/2): the root of 1 - s^2 by one step of Newton's iteration. */
static struct double_double cosine(struct double_double s)
{
  const struct double_double square = dd_add((struct double_double){1, 0}, dd_negate(dd_multiply(s, s)));
  const double root = sqrt(square.hi);
  const struct double_double back = dd_two_product(root, root);
  return dd_normal(root, ((square.hi - back.hi) - back.lo + square.lo) / (2 * root));
}

/* Each angle has one place, by its bits (Knuth, The Art of Computer Programming 3, 6.4, multiplicative hashing). */
static struct transform_angle *place_of(double degrees, struct transform_angles *angles)
{
  return &angles->known[real_bits(degrees) * UINT64_C(0x9e3779b97f4a7c15) >> (64 - TRANSFORM_ANGLE_BITS)];
}

/* An angle of at most 45 degrees. */
static struct transform_angle small_angle(double degrees, struct transform_angles *angles)
{
  static const struct double_double radians_a_degree = {0x1.1df46a2529d39p-6, 0x1.5c1d8becdd291p-62};
  struct transform_angle *angle = place_of(degrees, angles);
  if (angle->degrees != degrees || degrees == 0) {
    angle->degrees = degrees;
    angle->sine = sine(dd_scale(radians_a_degree, degrees));
    angle->cosine = cosine(angle->sine);
  }
  return *angle;
}

/* Exact at multiples of 90 degrees. Many angles, such as those of whole degrees, become few without their quarters. */
static struct transform_angle known_angle(double degrees, struct transform_angles *angles)
{
  struct transform_angle *angle = place_of(degrees, angles);
  if (angle->degrees == degrees) return *angle;
  int quarters;
  const struct transform_angle rest = small_angle(remquo(degrees, 90, &quarters), angles); /* exact */
  const struct double_double s = rest.sine, c = rest.cosine;
  angle->degrees = degrees;
  switch (quarters & 3) {
  case 0: angle->sine = s, angle->cosine = c; break;
  case 1: angle->sine = c, angle->cosine = dd_negate(s); break;
  case 2: angle->sine = dd_negate(s), angle->cosine = dd_negate(c); break;
  default: angle->sine = dd_negate(c), angle->cosine = s; break;
  }
  return *angle;
}

static void rotation(const double degrees[3], struct transform_angles *angles, struct transform *out)
{
  static const struct transform unit = {.A = {{{1, 0}}, {{0, 0}, {1, 0}}, {{0, 0}, {0, 0}, {1, 0}}}};
  struct transform_angle angle[3];
  out->identity = out->moves = degrees[0] == 0 && degrees[1] == 0 && degrees[2] == 0;
  for (int axis = 0; axis < 3; axis++)
    if (degrees[axis] != 0) angle[axis] = known_angle(degrees[axis], angles);
  for (size_t row = 0; row < ROWS; row += LANES) {
    struct double_lanes a[3];
    load_columns(&unit, row, a);
#pragma GCC unroll 3
    for (int axis = 0; axis < 3; axis++) {
      if (degrees[axis] == 0) continue;
      const int i = (axis + 1) % 3, j = (axis + 2) % 3; /* the columns that turn */
      const struct double_lanes x = a[i], y = a[j];
      const struct double_double s = angle[axis].sine, c = angle[axis].cosine;
      a[i] = add_product(add_product(ZERO, x, c), y, dd_negate(s));
      a[j] = add_product(add_product(ZERO, x, s), y, c);
    }
    store_columns(a, row, out);
  }
}

const struct transform_kernel KERNEL(transform_kernel) = {compose, apply, rotation};
