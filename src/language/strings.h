/* Strings, and the directives that print them. */
#ifndef PSCN_LANGUAGE_STRINGS_H
#define PSCN_LANGUAGE_STRINGS_H

#include "language/values.h"

/* The longest string, in bytes. */
enum { LONGEST_STRING = 65536 };

/* The string in quotes at `place`, its escapes resolved. */
struct value *value_of_string(struct language *language, struct span place);

/* A string of that many bytes, which are to be written to; NULL, after an error, if that is too long. */
char *string_make(struct language *language, struct value *value, size_t length);

/* POV-Ray's str(x, length, precision): at least `length` characters, filled by zeros if that is negative; a negative
 * precision is one of 6. Appends to text[0 .. *used-1] as far as `size` allows. */
void string_add_number(double x, double length, double precision, char *text, size_t size, size_t *used);

/* At #debug, #warning or #error: reads the string behind it and prints it. */
void message_pass(struct language *language, int directive);

/* At the end, prints what #debug said without ending its line. */
void messages_end(struct language *language);

#endif
