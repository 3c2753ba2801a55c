/* Functions of numbers, vectors, strings and arrays, with POV-Ray's names and meaning. */
#ifndef PSCN_LANGUAGE_FUNCTIONS_H
#define PSCN_LANGUAGE_FUNCTIONS_H

#include "language/arrays.h"

/* The value of the function that is named at `place`. `arguments`: a list, the last one first, which is used up.
 * `whole`: from the name to the closing parenthesis. */
struct value *value_function(struct language *language, struct value *arguments, struct span place, struct span whole);

/* Whether the function that is named at `place` draws a random number or makes a generator of them. */
bool function_draws(const struct language *language, struct span place);

/* Whether the name in defined(NAME) is declared, as a number. */
struct value *value_defined(struct language *language, struct span name, struct span whole);

/* A word that stands for a number: pi, true, clock and so on. */
struct value *value_constant(struct language *language, struct span word);

#endif
