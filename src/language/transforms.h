/* Affine transforms as POV-Ray has them: row vectors, angles in degrees, rotation about x, then y, then z.
 *
 * They are composed in double-double, and a point is rounded once at the end: what comes out is the nearest double of
 * what the scene says, the same on every machine.
 */
#ifndef PSCN_LANGUAGE_TRANSFORMS_H
#define PSCN_LANGUAGE_TRANSFORMS_H

#include "base/double_double.h"
#include "language/values.h"

/* p' = p A + b. `identity` where nothing has been applied, so that points stay as they are to the bit; `moves` where A is
 * the identity and b doubles. */
struct transform {
  bool identity, moves;
  struct span place; /* of the statement */
  struct double_double A[3][3], b[3];
};

struct transform transform_identity(void);
/* first, then second. */
struct transform transform_then(const struct transform *first, const struct transform *second);
bool transform_finite(const struct transform *transform);
/* out may be p; a direction is not moved. */
void transform_point(const struct transform *transform, const double p[3], double out[3]);
void transform_direction(const struct transform *transform, const double p[3], double out[3]);

/* The statements, each until the next one; the identity where an error has been told. */
const struct transform *transform_translate(struct language *language, struct span place, const struct value *by);
const struct transform *transform_rotate(struct language *language, struct span place, const struct value *by);
const struct transform *transform_scale(struct language *language, struct span place, const struct value *by);

/* The numbers of a matrix statement; NULL: it has but three, as one vector. */
struct matrix {
  double number[12];
  int count;
};
struct matrix *matrix_begin(struct language *language, const struct value *first);
void matrix_add(struct language *language, struct matrix *matrix, const struct value *value);
const struct transform *transform_matrix(struct language *language, struct span place, const struct matrix *matrix);

#endif
