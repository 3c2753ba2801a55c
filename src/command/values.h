/* What stands after an option, read strictly: the whole text or nothing, and the same in every locale.
 *
 * Each function answers false and writes nothing where the text is not what it should be.
 */
#ifndef PSCN_COMMAND_VALUES_H
#define PSCN_COMMAND_VALUES_H

#include <stdbool.h>
#include <stddef.h>

#include "render/tile.h"

/* Decimal digits at *text, up to `end`, that are at most `maximum`; and one character. Steps over what it has read. */
bool value_digits(const char **text, const char *end, size_t maximum, size_t *out);
bool value_sign(const char **text, const char *end, char sign);

/* Decimal digits, minimum to maximum. */
bool value_integer(const char *text, size_t minimum, size_t maximum, size_t *out);

/* A finite number >= 0, or a quotient of two ("4/255"). */
bool value_number(const char *text, double *out);

/* Bytes: decimal digits, at least 1, with K, M, G or T (powers of 1024) behind them or nothing. */
bool value_bytes(const char *text, size_t *out);

/* "800x600", each side 1 to maximum. */
bool value_size(const char *text, size_t maximum, size_t *out_width, size_t *out_height);

/* "X,Y,W,H", W and H at least 1. */
bool value_rectangle(const char *text, struct rectangle *out);

#endif
