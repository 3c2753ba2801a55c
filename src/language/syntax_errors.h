/* The text of syntax errors. */
#ifndef PSCN_LANGUAGE_SYNTAX_ERRORS_H
#define PSCN_LANGUAGE_SYNTAX_ERRORS_H

#include "language/errors.h"

/* Reports the last token, which is none of `count` expected ones. `is_word`: nor is it a word of the language. */
void syntax_error(struct language *language, bool is_word, const char *const expected[], int count);

/* Reports the character at which the scanner stopped. */
void character_error(struct language *language);

#endif
