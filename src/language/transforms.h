/* Affine transforms as in POV-Ray: row vectors, angles in degrees, rotation about x, then y, then z. */
#ifndef PSCN_LANGUAGE_TRANSFORMS_H
#define PSCN_LANGUAGE_TRANSFORMS_H

#include "geometry/transform.h"
#include "language/values.h"

/* The statements. A result lives until the next one; after an error it is the identity. */
const struct transform *transform_translate(struct language *language, struct span place, const struct value *by);
const struct transform *transform_rotate(struct language *language, struct span place, const struct value *by);
const struct transform *transform_scale(struct language *language, struct span place, const struct value *by);

/* The numbers of a matrix statement, until the next one. For NULL, it has only three, as one vector. */
struct matrix {
  double number[12];
  int count;
};
struct matrix *matrix_begin(struct language *language, const struct value *first);
void matrix_add(struct language *language, struct matrix *matrix, const struct value *value);
const struct transform *transform_matrix(struct language *language, struct span place, const struct matrix *matrix);

#endif
