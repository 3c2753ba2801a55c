/* Affine transforms in double-double. */
#include "language/transforms.h"

#include <math.h>

static struct double_double dd(double x) { return (struct double_double){x, 0}; }

struct transform transform_identity(void)
{
  struct transform t = {.identity = true, .moves = true};
  for (int k = 0; k < 3; k++) t.A[k][k] = dd(1);
  return t;
}

/* Most of what transforms are made of is 0. */
static void add_product(struct double_double *sum, struct double_double a, struct double_double b)
{
  if (a.hi != 0) *sum = dd_add(*sum, dd_multiply(a, b));
}

struct transform transform_then(const struct transform *first, const struct transform *second)
{
  if (first->identity) return *second;
  if (second->identity) return *first;
  struct transform r = {.identity = false};
  if (first->moves && second->moves) {
    r = *first, r.identity = false;
    for (int j = 0; j < 3; j++) {
      r.b[j] = dd_add(second->b[j], first->b[j]);
      r.moves &= r.b[j].lo == 0;
    }
    return r;
  }
  for (int j = 0; j < 3; j++) {
    r.b[j] = second->b[j];
    for (int k = 0; k < 3; k++) {
      if (second->A[k][j].hi == 0) continue;
      add_product(&r.b[j], first->b[k], second->A[k][j]);
      for (int i = 0; i < 3; i++) add_product(&r.A[i][j], first->A[i][k], second->A[k][j]);
    }
  }
  return r;
}

bool transform_finite(const struct transform *transform)
{
  bool finite = true;
  for (int j = 0; j < 3; j++) {
    finite &= isfinite(transform->b[j].hi) != 0;
    for (int i = 0; i < 3; i++) finite &= isfinite(transform->A[i][j].hi) != 0;
  }
  return finite;
}

/* p A + b */
static void apply(const struct transform *transform, const struct double_double b[3], const double p[3], double out[3])
{
  const double from[3] = {p[0], p[1], p[2]};
  if (transform->moves) {
    for (int j = 0; j < 3; j++) out[j] = transform->identity ? from[j] : b[j].hi + from[j];
    return;
  }
  for (int j = 0; j < 3; j++) {
    struct double_double q = b[j];
    for (int k = 0; k < 3; k++)
      if (transform->A[k][j].hi != 0) q = dd_add(q, dd_scale(transform->A[k][j], from[k]));
    out[j] = q.hi + q.lo;
  }
}

void transform_point(const struct transform *transform, const double p[3], double out[3])
{
  apply(transform, transform->b, p, out);
}

void transform_direction(const struct transform *transform, const double p[3], double out[3])
{
  static const struct double_double nowhere[3];
  apply(transform, nowhere, p, out);
}

static struct transform *new_identity(struct language *language, struct span place)
{
  if (!language->transform) language->transform = language_alloc(language, sizeof *language->transform);
  *language->transform = transform_identity();
  language->transform->place = place;
  return language->transform;
}

const struct transform *transform_translate(struct language *language, struct span place, const struct value *value)
{
  double by[3] = {0, 0, 0};
  value_to_vector(language, value, by);
  struct transform *t = new_identity(language, span_join(place, value->place));
  for (int k = 0; k < 3; k++) {
    t->b[k] = dd(by[k]);
    t->identity &= by[k] == 0;
  }
  return t;
}

/* (a + error) / b to about 104 bits, for an error no larger than the rounding of a. */
static struct double_double divide(double a, double error, double b)
{
  const double q = a / b;
  const struct double_double back = dd_two_product(q, b);
  return dd_normal(q, ((a - back.hi) - back.lo + error) / b);
}

/* The sum of (-1)^n x^(2n+1) / (2n+1)! for |x| <= pi/4, up to a term that is less than what rounds the sum. From the
 * first term below 2^-53 of the sum on they are doubles, whose own rounding is below 2^-106 of it. */
static struct double_double sine(struct double_double x)
{
  const struct double_double square = dd_negate(dd_multiply(x, x));
  struct double_double term = x, sum = x;
  int n = 2;
  for (; fabs(term.hi) > 0x1p-53 * fabs(sum.hi); n += 2) {
    term = dd_multiply(term, square);
    term = divide(term.hi, term.lo, (double)(n * (n + 1)));
    sum = dd_add(sum, term);
  }
  double small = term.hi, tail = 0;
  for (; fabs(small) > 0x1p-108 * fabs(sum.hi); n += 2) {
    small *= square.hi / (double)(n * (n + 1));
    tail += small;
  }
  return dd_normal(sum.hi, sum.lo + tail);
}

/* The cosine to that sine, which is at least sqrt(1/2): 1 - s^2 by one step of Newton's iteration. */
static struct double_double cosine(struct double_double s)
{
  const struct double_double square = dd_add(dd(1), dd_negate(dd_multiply(s, s)));
  const double root = sqrt(square.hi);
  const struct double_double back = dd_two_product(root, root);
  return dd_normal(root, ((square.hi - back.hi) - back.lo + square.lo) / (2 * root));
}

/* Sine and cosine of an angle in degrees; exact at multiples of 90. */
static void turn(double degrees, struct double_double *out_sin, struct double_double *out_cos)
{
  static const struct double_double radians_a_degree = {0x1.1df46a2529d39p-6, 0x1.5c1d8becdd291p-62};
  int quarters;
  const double rest = remquo(degrees, 90, &quarters); /* exact, |rest| <= 45 */
  const struct double_double s = sine(dd_scale(radians_a_degree, rest)), c = cosine(s);
  switch (quarters & 3) {
  case 0: *out_sin = s, *out_cos = c; break;
  case 1: *out_sin = c, *out_cos = dd_negate(s); break;
  case 2: *out_sin = dd_negate(s), *out_cos = dd_negate(c); break;
  default: *out_sin = dd_negate(c), *out_cos = s; break;
  }
}

const struct transform *transform_rotate(struct language *language, struct span place, const struct value *value)
{
  double by[3] = {0, 0, 0};
  value_to_vector(language, value, by);
  struct transform *all = new_identity(language, span_join(place, value->place));
  for (int axis = 0; axis < 3; axis++) {
    if (by[axis] == 0) continue;
    const int i = (axis + 1) % 3, j = (axis + 2) % 3;
    struct transform t = transform_identity();
    t.identity = t.moves = false;
    turn(by[axis], &t.A[i][j], &t.A[i][i]);
    t.A[j][i] = dd_negate(t.A[i][j]);
    t.A[j][j] = t.A[i][i];
    *all = transform_then(all, &t);
  }
  all->place = span_join(place, value->place);
  return all;
}

const struct transform *transform_scale(struct language *language, struct span place, const struct value *value)
{
  static const char *const axes[8] = {"", "x", "y", "x and y", "z", "x and z", "y and z", "x, y and z"};
  double by[3] = {1, 1, 1};
  unsigned zeros = 0;
  value_to_vector(language, value, by);
  struct transform *t = new_identity(language, span_join(place, value->place));
  for (int k = 0; k < 3; k++) {
    if (by[k] == 0) zeros |= 1u << k;
    else t->A[k][k] = dd(by[k]);
    t->identity = t->moves &= by[k] == 1;
  }
  if (zeros)
    language_error(language, value->place, "scaling %s by 0 leaves nothing; POV-Ray would take 1 instead", axes[zeros]);
  return t;
}

enum { MATRIX_NUMBERS = 12 };

struct matrix *matrix_begin(struct language *language, const struct value *first)
{
  struct matrix *matrix = language_alloc(language, sizeof *matrix);
  matrix_add(language, matrix, first);
  return matrix;
}

void matrix_add(struct language *language, struct matrix *matrix, const struct value *value)
{
  double x = 1;
  value_to_number(language, value, &x);
  if (matrix->count < MATRIX_NUMBERS) matrix->number[matrix->count] = x;
  matrix->count++;
}

static struct double_double minor(const double m[12], int i, int j)
{
  const int i1 = (i + 1) % 3, i2 = (i + 2) % 3, j1 = (j + 1) % 3, j2 = (j + 2) % 3;
  return dd_add(dd_two_product(m[3 * i1 + j1], m[3 * i2 + j2]),
                dd_negate(dd_two_product(m[3 * i1 + j2], m[3 * i2 + j1])));
}

/* Whether the determinant is no more than what rounding leaves of a vanishing one: 2^-100 of the size of its terms,
 * a few units of double-double. The rows are scaled first, so that nothing overflows. */
static bool is_singular(const double matrix[12])
{
  double m[12], size = 0;
  for (int i = 0; i < 3; i++) {
    const double *row = &matrix[3 * i];
    const double largest = fmax(fabs(row[0]), fmax(fabs(row[1]), fabs(row[2])));
    if (largest == 0) return true;
    int exponent;
    frexp(largest, &exponent);
    for (int j = 0; j < 3; j++) m[3 * i + j] = ldexp(row[j], -exponent);
  }
  struct double_double determinant = dd(0);
  for (int j = 0; j < 3; j++) {
    determinant = dd_add(determinant, dd_scale(minor(m, 0, j), m[j]));
    size += fabs(m[j]);
  }
  return fabs(determinant.hi) <= 0x1p-100 * size;
}

const struct transform *transform_matrix(struct language *language, struct span place, const struct matrix *matrix)
{
  struct transform *t = new_identity(language, place);
  const int count = matrix ? matrix->count : 3;
  if (count != MATRIX_NUMBERS) {
    language_error(language, place, "matrix needs %d numbers, found %d", MATRIX_NUMBERS, count);
  } else if (is_singular(matrix->number)) {
    language_error(language, place, "this matrix cannot be inverted: it makes everything flat");
  } else {
    t->identity = t->moves = false;
    for (int i = 0; i < 9; i++) t->A[i / 3][i % 3] = dd(matrix->number[i]);
    for (int j = 0; j < 3; j++) t->b[j] = dd(matrix->number[9 + j]);
  }
  return t;
}
