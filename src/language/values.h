/* Values and arithmetic, with POV-Ray's promotion: beside a vector, a number stands for three equal ones; an operation
 * with a colour gives a colour. Errors are reported at the places of the values. */
#ifndef PSCN_LANGUAGE_VALUES_H
#define PSCN_LANGUAGE_VALUES_H

#include "geometry/transform.h"
#include "language/symbols.h"

/* POV-Ray's, absolute: numbers nearer than that are equal. */
#define VALUE_EQUAL 1e-10

/* Values are made in the order in which the grammar meets them. A result takes the memory of its first operand; the
 * other operands must not be used afterwards. */
struct value *value_of(struct language *language, enum value_kind kind, struct span place);
struct value *value_of_number(struct language *language, double x, struct span place);
struct value *value_of_vector(struct language *language, const double x[3], struct span place);
struct value *value_axis(struct language *language, int axis, struct span place);
struct value *value_named(struct language *language, struct span name);
/* An element of that array; `indices`: a list, the last one first, which is used up. */
struct value *value_element(struct language *language, struct value *array, struct value *indices, struct span place);
/* A vector; `parts`: a list, the last one first, which is used up. */
struct value *value_of_parts(struct language *language, struct value *parts, struct span place);
/* The same value at another place, no longer marked as a component. */
struct value *value_placed(struct value *value, struct span place);
/* An operation by its sign, part by part: arithmetic; comparisons, & and |, where what is nearer to 0 than VALUE_EQUAL
 * is false; [, ] and ! stand for <=, >= and !=, as comparison_at says. Signs before a value: +, -, !; and ( for a value
 * in parentheses, which its neighbours do not affect. */
struct value *value_binary(struct language *language, char op, struct value *a, struct value *b);
struct value *value_unary(struct language *language, char op, struct value *a, struct span place);
char comparison_at(const struct language *language, struct span place);
/* At the ?, at the : and at the end of a choice: errors in the branch that is not chosen do not count. */
void choice_begin(struct language *language, const struct value *condition);
void choice_else(struct language *language, const struct value *condition);
struct value *choice_end(struct language *language, struct value *condition, struct value *a, struct value *b);
/* `name`: that of the component. */
struct value *value_component(struct language *language, struct value *a, struct span name);
/* A colour: behind `color` a number stands for all its parts; behind rgb and similar words for as many as these name. */
struct value *value_color(struct language *language, struct value *a, struct span place);
struct value *value_rgb(struct language *language, struct span word, struct value *a);
/* A colour, black if NULL, with the part of that name. */
struct value *value_part(struct language *language, struct value *colour, struct span part, struct value *value);
/* One part of a vector or a colour, from 0 on; a number has the same in all. */
double value_x(const struct value *a, int k);
void value_set_number(struct value *to, double x);
/* Adds a value before a list; the list in the order of the text; and the end of its use. */
struct value *value_before(struct value *list, struct value *value);
struct value *value_reversed(struct value *list);
void value_last_of_list(struct language *language, struct value *list);
/* Takes up to `most` numbers from a list. Returns how many values are in it. If some are no numbers, that is reported, and
 * *out_all is false. */
int value_numbers(struct language *language, const struct value *list, int most, double out[], bool *out_all);
/* Gives a name or an element the value. Arrays are copied. */
void value_set(struct language *language, struct value *to, const struct value *value);
/* A complete value, about to be used. It can be read until the next one is made. */
struct value *value_last(struct language *language, struct value *value);

/* Converts a value, or reports an error; `out` is then not written, and value_to_number returns false. */
void value_to_vector(struct language *language, const struct value *a, double out[3]);
void value_to_colour(struct language *language, const struct value *a, double out[3]); /* its parts are floats */
bool value_to_number(struct language *language, const struct value *a, double *out);
/* As value_to_colour, where POV-Ray heeds transparency: a transparent colour, or a bare number, is not supported. */
void value_to_opaque(struct language *language, const struct value *a, double out[3]);
/* Whether x is within a float's range, as POV-Ray's colours and finishes are. Products of some are then doubles. */
bool value_is_float(double x);
/* A number in [low, high], or an error that `what` must be so, and false. */
bool value_in_range(struct language *language, const struct value *a, const char *what, double low, double high,
                    bool whole, double *out);

/* "a whole number from 1 to 9", "a number of at least 0", "a number above 0 and up to 1" (low = DBL_MIN). */
enum { RANGE_TEXT_SIZE = 100 };
void range_text(double low, double high, bool whole, char out[RANGE_TEXT_SIZE]);

/* ---- strings ---- */

/* The string in quotes at `place`, its escapes resolved. */
struct value *value_of_string(struct language *language, struct span place);

/* A string of that many bytes, which are to be written to. */
char *string_make(struct language *language, struct value *value, size_t length);

/* ---- arrays ---- */

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

/* ---- functions, with POV-Ray's names and meaning ---- */

/* The value of the function that is named at `place`. `arguments`: a list, the last one first, which is used up.
 * `whole`: from the name to the closing parenthesis. */
struct value *value_function(struct language *language, struct value *arguments, struct span place, struct span whole);

/* Whether the function that is named at `place` draws a random number or makes a generator of them. */
bool function_draws(const struct language *language, struct span place);

/* Whether the name in defined(NAME) is declared, as a number. */
struct value *value_defined(struct language *language, struct span name, struct span whole);

/* A word that stands for a number: pi, true, clock and so on. */
struct value *value_constant(struct language *language, struct span word);

/* ---- affine transforms as in POV-Ray: row vectors, angles in degrees, rotation about x, then y, then z ---- */

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
