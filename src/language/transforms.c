/* The statements of transforms. */
#include "language/transforms.h"

#include <math.h>

static struct double_double dd(double x) { return (struct double_double){x, 0}; }

/* The transform of the statement, as the last one left it. */
static struct transform *begin(struct language *language, struct span place)
{
  if (!language->transform) language->transform = language_alloc(language, sizeof *language->transform);
  language->transform_place = place;
  return language->transform;
}

static struct transform *begin_identity(struct language *language, struct span place)
{
  struct transform *t = begin(language, place);
  *t = transform_identity();
  return t;
}

const struct transform *transform_translate(struct language *language, struct span place, const struct value *value)
{
  double by[3] = {0, 0, 0};
  value_to_vector(language, value, by);
  struct transform *t = begin_identity(language, span_join(place, value->place));
  for (int k = 0; k < 3; k++) {
    t->A[3][k] = dd(by[k]);
    t->identity &= by[k] == 0;
  }
  return t;
}

const struct transform *transform_rotate(struct language *language, struct span place, const struct value *value)
{
  double by[3] = {0, 0, 0};
  value_to_vector(language, value, by);
  struct transform *t = begin(language, span_join(place, value->place));
  transform_rotation(by, language->angles, t);
  return t;
}

const struct transform *transform_scale(struct language *language, struct span place, const struct value *value)
{
  static const char *const axes[8] = {"", "x", "y", "x and y", "z", "x and z", "y and z", "x, y and z"};
  double by[3] = {1, 1, 1};
  unsigned zeros = 0;
  value_to_vector(language, value, by);
  struct transform *t = begin_identity(language, span_join(place, value->place));
  for (int k = 0; k < 3; k++) {
    if (by[k] == 0) zeros |= 1u << k;
    else t->A[k][k] = dd(by[k]);
    t->moves = t->moves && by[k] == 1;
  }
  t->identity = t->moves;
  if (zeros)
    language_error(language, value->place, "scaling %s by 0 leaves nothing; POV-Ray would take 1 instead", axes[zeros]);
  return t;
}

enum { MATRIX_NUMBERS = 12 };

/* POV-Ray's absolute limit: a matrix whose numbers for one axis are all smaller has none for it. */
#define EMPTY 1e-10

struct matrix *matrix_begin(struct language *language, const struct value *first)
{
  if (!language->matrix) language->matrix = language_alloc(language, sizeof *language->matrix);
  struct matrix *matrix = language->matrix;
  matrix->count = 0;
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

/* Whether POV-Ray takes a column for 0, and then 1 for the number in its diagonal. */
static bool has_empty_column(const double m[12])
{
  for (int j = 0; j < 3; j++)
    if (fabs(m[j]) < EMPTY && fabs(m[3 + j]) < EMPTY && fabs(m[6 + j]) < EMPTY) return true;
  return false;
}

/* Whether the determinant is no more than what rounding leaves of a vanishing one: 2^-100 of the size of its terms, a
 * few units of double-double. The rows are scaled first, so that nothing overflows. */
static bool is_singular(const double matrix[12])
{
  double m[12], size = 0;
  for (int i = 0; i < 3; i++) {
    const double *row = &matrix[3 * i];
    const double largest = fmax(fabs(row[0]), fmax(fabs(row[1]), fabs(row[2])));
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
  struct transform *t = begin_identity(language, place);
  const int count = matrix ? matrix->count : 3;
  if (count != MATRIX_NUMBERS) {
    language_error(language, place, "matrix needs %d numbers, found %d", MATRIX_NUMBERS, count);
  } else if (is_singular(matrix->number)) {
    language_error(language, place, "this matrix cannot be inverted: it makes everything flat");
  } else if (has_empty_column(matrix->number)) {
    language_error(language, place, "POV-Ray leaves an axis as it is of which all numbers are below 1e-10; use scale");
  } else {
    t->identity = t->moves = false;
    for (int i = 0; i < MATRIX_NUMBERS; i++) t->A[i / 3][i % 3] = dd(matrix->number[i]);
  }
  return t;
}
