/* The statements of transforms. */
#include "language/values.h"

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

const struct transform *transform_matrix(struct language *language, struct span place, struct value *parts)
{
  struct transform *t = begin_identity(language, place);
  double number[MATRIX_NUMBERS];
  bool known;
  struct value *list = value_reversed(parts);
  const int count = parts ? value_numbers(language, list, MATRIX_NUMBERS, number, &known) : 3;
  value_last_of_list(language, list);
  if (count != MATRIX_NUMBERS) {
    language_error(language, place, "matrix needs %d numbers, found %d", MATRIX_NUMBERS, count);
  } else if (known && is_singular(number)) {
    language_error(language, place, "this matrix cannot be inverted: it makes everything flat");
  } else if (known && has_empty_column(number)) {
    language_error(language, place, "POV-Ray ignores an axis whose numbers are all below 1e-10; use scale");
  } else if (known) {
    t->identity = t->moves = false;
    for (int i = 0; i < MATRIX_NUMBERS; i++) t->A[i / 3][i % 3] = dd(number[i]);
  }
  return t;
}

/* ---- declared transforms ---- */

struct transforms {
  struct transforms *outer;
  struct transform all;
};

void transforms_begin(struct language *language)
{
  struct transforms *open = language_alloc(language, sizeof *open);
  *open = (struct transforms){language->transforms, transform_identity()};
  language->transforms = open;
}

void transforms_add(struct language *language, const struct transform *transform)
{
  struct transform *all = &language->transforms->all;
  *all = transform_then(all, transform);
}

const struct transform *transforms_end(struct language *language, struct span place)
{
  struct transforms *open = language->transforms;
  language->transforms = open->outer;
  language->transform_place = place;
  return &open->all;
}

const struct transform *transform_named(struct language *language, const struct value *value)
{
  if (value->kind == VALUE_TRANSFORM) {
    language->transform_place = value->place;
    return value->transform;
  }
  symbol_mistaken(language, value, "a transform");
  return begin_identity(language, value->place);
}

struct value *value_of_transform(struct language *language, const struct transform *transform)
{
  struct value *value = value_of(language, VALUE_TRANSFORM, language->transform_place);
  value->transform = transform;
  return value;
}
