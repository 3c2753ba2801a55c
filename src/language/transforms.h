/* Affine transforms as in POV-Ray: row vectors, angles in degrees, rotation about x, then y, then z. */
#ifndef PSCN_LANGUAGE_TRANSFORMS_H
#define PSCN_LANGUAGE_TRANSFORMS_H

#include "geometry/transform.h"
#include "language/values.h"

/* The statements. A result lives until the next one, unless it stays; after an error it is the identity. */
const struct transform *transform_translate(struct language *language, struct span place, const struct value *by);
const struct transform *transform_rotate(struct language *language, struct span place, const struct value *by);
const struct transform *transform_scale(struct language *language, struct span place, const struct value *by);

/* The numbers of a matrix: a list, the last one first, which is used up; for NULL, three of them as one vector. */
const struct transform *transform_matrix(struct language *language, struct span place, struct value *parts);

/* transform { }: what it holds, one after another; the result stays. Then a declared one, and one to be declared. */
void transforms_begin(struct language *language);
void transforms_add(struct language *language, const struct transform *transform);
const struct transform *transforms_end(struct language *language, struct span place);
const struct transform *transform_named(struct language *language, const struct value *value);
struct value *value_of_transform(struct language *language, const struct transform *transform);

#endif
