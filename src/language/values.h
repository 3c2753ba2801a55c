/* Values and arithmetic, with POV-Ray's promotion: beside a vector a number stands for three of it, and what a colour
 * takes part in is a colour. Errors are told at the places that values bring along. */
#ifndef PSCN_LANGUAGE_VALUES_H
#define PSCN_LANGUAGE_VALUES_H

#include "language/symbols.h"

struct value value_of_number(double x, struct place place);
struct value value_of_vector(const double x[3], struct place place);
/* A vector of two parts, which is refused. */
struct value value_flat(struct language *language, struct place place);
struct value value_of_parts(struct language *language, const struct value *x, const struct value *y,
                            const struct value *z, struct place place);
struct value value_axis(int axis, struct place place);
struct value value_placed(struct value value, struct place place);
struct value value_named(struct language *language, const struct token *name);
struct value value_binary(struct language *language, char op, const struct value *a, const struct value *b);
struct value value_negative(struct language *language, const struct value *a, struct place place);
struct value value_component(struct language *language, const struct value *a, int index, struct place place);
struct value value_rgb(struct language *language, const struct value *a, struct place place);
struct value value_color(struct language *language, const struct value *a, struct place place);
/* After rgbf, rgbt (4 parts) and rgbft (5): a number or a colour; or each part, transmit NULL where there are 4. */
struct value value_rgbft(struct language *language, const struct value *a, int parts, struct place place);
struct value value_wide(struct language *language, const struct value *red, const struct value *green,
                        const struct value *blue, const struct value *filter, const struct value *transmit,
                        struct place place);
/* A colour, black where NULL, with one part said by name: 0 red, 1 green, 2 blue, 3 filter or transmit. */
struct value value_part(struct language *language, const struct value *colour, int part, const struct value *value,
                        struct place place);

/* What is wanted, or an error. Nothing is written to `out` then; value_to_number answers false. */
void value_to_vector(struct language *language, const struct value *a, double out[3]);
void value_to_colour(struct language *language, const struct value *a, double out[3]);
bool value_to_number(struct language *language, const struct value *a, double *out);
/* As value_to_colour, where POV-Ray heeds transparency: a colour that has some there, or a bare number, is an error. */
void value_to_opaque(struct language *language, const struct value *a, double out[3]);
/* As a number in [low, high], or an error saying that `what` must be so, and false. */
bool value_in_range(struct language *language, const struct value *a, const char *what, double low, double high,
                    bool whole, double *out);

/* "a whole number from 1 to 9", "a number of at least 0", "a number above 0 and up to 1" (low = DBL_MIN). */
enum { RANGE_TEXT_SIZE = 100 };
void range_text(double low, double high, bool whole, char out[RANGE_TEXT_SIZE]);

#endif
