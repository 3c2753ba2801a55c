/* Arrays, and the functions that ask about them. */
#ifndef PSCN_LANGUAGE_ARRAYS_H
#define PSCN_LANGUAGE_ARRAYS_H

#include "language/values.h"

/* An array whose elements have no values yet. `sizes`: a list, one a dimension, which is used up. Elements may be given
 * until the end, in rows for arrays of several dimensions. */
void array_begin(struct language *language, struct value *sizes, struct span place);
void array_row(struct language *language, struct span brace);
void array_given(struct language *language, const struct value *value);
void array_row_end(struct language *language, struct span brace);
struct value *array_end(struct language *language);

struct array *array_copy(struct language *language, const struct array *array);

/* The element of a declared array: `name` is a list of the array's name and then the indices. NULL after an error. */
struct value *array_element(struct language *language, struct value *array, const struct value *name);

#endif
