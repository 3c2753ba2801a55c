/* Reads the arguments of options strictly: the whole text or nothing, and the same in every locale.
 *
 * Each function returns false and writes nothing if the text does not have the form described.
 */
#ifndef PSCN_COMMAND_VALUES_H
#define PSCN_COMMAND_VALUES_H

#include <stdbool.h>
#include <stddef.h>

#include "render/tile.h"

/* Decimal digits, minimum to maximum. */
bool value_integer(const char *text, size_t minimum, size_t maximum, size_t *out);

/* A finite number >= 0, or a quotient of two ("4/255"). */
bool value_number(const char *text, double *out);

/* Bytes: decimal digits, at least 1, and optionally K, M, G or T (powers of 1024). */
bool value_bytes(const char *text, size_t *out);

/* "800x600", each side 1 to maximum. */
bool value_size(const char *text, size_t maximum, size_t *out_width, size_t *out_height);

/* "X,Y,W,H", W and H at least 1. */
bool value_rectangle(const char *text, struct rectangle *out);

/* "3/16" or "1-24", with that sign between: the first at least 1, the last not less and at most maximum. */
bool value_range(const char *text, char sign, size_t maximum, size_t *out_first, size_t *out_last);

#endif
