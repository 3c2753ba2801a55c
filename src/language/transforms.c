/* Affine transforms as POV-Ray has them: row vectors, angles in degrees, rotation about x, then y, then z. */
#include <math.h>

#include "language/build.h"

struct transform transform_identity(void)
{
  struct transform t = {.identity = true};
  for (int k = 0; k < 3; k++) t.A[k][k] = 1;
  return t;
}

struct transform transform_then(const struct transform *first, const struct transform *second)
{
  if (first->identity) return *second;
  if (second->identity) return *first;
  struct transform r = {.identity = false};
  for (int j = 0; j < 3; j++) {
    r.b[j] = second->b[j];
    for (int k = 0; k < 3; k++) {
      r.b[j] += first->b[k] * second->A[k][j];
      for (int i = 0; i < 3; i++) r.A[i][j] += first->A[i][k] * second->A[k][j];
    }
  }
  return r;
}

void transform_point(const struct transform *transform, const double p[3], double out[3])
{
  if (transform->identity) {
    for (int k = 0; k < 3; k++) out[k] = p[k];
    return;
  }
  long double q[3];
  for (int j = 0; j < 3; j++) {
    q[j] = transform->b[j];
    for (int k = 0; k < 3; k++) q[j] += p[k] * transform->A[k][j];
  }
  for (int k = 0; k < 3; k++) out[k] = (double)q[k];
}

struct transform transform_translate(struct language *language, struct place place, const struct value *value)
{
  (void)language, (void)place;
  struct transform t = transform_identity();
  for (int k = 0; k < 3; k++) t.b[k] = value->x[k], t.identity &= value->x[k] == 0;
  return t;
}

/* Sine and cosine of an angle in degrees, exact at multiples of 90. */
static void turn(double degrees, long double *out_sin, long double *out_cos)
{
  static const int exact[4][2] = {{0, 1}, {1, 0}, {0, -1}, {-1, 0}};
  const double quarter = remainder(degrees, 360) / 90, whole = rint(quarter);
  const int q = ((int)whole + 4) % 4;
  if (quarter == whole) {
    *out_sin = exact[q][0], *out_cos = exact[q][1];
    return;
  }
  const long double radians = (long double)remainder(degrees, 360) * (3.14159265358979323846264338327950288L / 180);
  *out_sin = sinl(radians), *out_cos = cosl(radians);
}

struct transform transform_rotate(struct language *language, struct place place, const struct value *value)
{
  (void)language, (void)place;
  struct transform all = transform_identity();
  for (int axis = 0; axis < 3; axis++) {
    if (value->x[axis] == 0) continue;
    const int i = (axis + 1) % 3, j = (axis + 2) % 3;
    struct transform t = transform_identity();
    long double s, c;
    turn(value->x[axis], &s, &c);
    t.identity = false;
    t.A[i][i] = c, t.A[i][j] = s, t.A[j][i] = -s, t.A[j][j] = c;
    all = transform_then(&all, &t);
  }
  return all;
}

struct transform transform_scale(struct language *language, struct place place, const struct value *value)
{
  struct transform t = transform_identity();
  for (int k = 0; k < 3; k++) {
    if (value->x[k] == 0) {
      language_error(language, place, "a scale of zero makes patches flat without a way back");
      return transform_identity();
    }
    t.A[k][k] = value->x[k], t.identity &= value->x[k] == 1;
  }
  return t;
}

void matrix_begin(struct language *language) { language->matrix_count = 0; }

void matrix_add(struct language *language, struct place place, const struct value *value)
{
  const double x = value_to_number(language, place, value);
  if (language->matrix_count < 12) language->matrix[language->matrix_count] = x;
  if (language->matrix_count <= 12) language->matrix_count++;
}

struct transform matrix_end(struct language *language, struct place place)
{
  struct transform t = {.identity = false};
  if (language->matrix_count != 12) {
    language_error(language, place, "a matrix has 12 numbers, not %s%d", language->matrix_count > 12 ? "more than " : "",
                   language->matrix_count > 12 ? 12 : language->matrix_count);
    return transform_identity();
  }
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++) t.A[i][j] = language->matrix[3 * i + j];
  for (int j = 0; j < 3; j++) t.b[j] = language->matrix[9 + j];
  return t;
}
