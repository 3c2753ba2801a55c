/* Directives, and all other tokens of the scanner that are not the grammar's. */
#ifndef PSCN_LANGUAGE_DIRECTIVES_H
#define PSCN_LANGUAGE_DIRECTIVES_H

#include "language/state.h"

/* Handles the scanner's last token if it is not the grammar's. Returns whether it did and the next one is wanted. */
bool directives_pass(struct language *language, int token);

/* The next token of the source being read, whatever it is; counts those that loops and macros read again. */
int directives_scan(struct language *language);

/* Reads the name behind a directive, which is not a word of the language or of POV-Ray's. False, after an error, if
 * there is none. */
bool directives_name(struct language *language, const char *directive, struct name *out);

/* Reports the comment or the quote that the source does not close. */
void directives_tell_open(struct language *language, int token);

/* At #debug, #warning or #error: reads the string behind it and prints it. */
void message_pass(struct language *language, int directive);

/* At the end, prints what #debug said without ending its line. */
void messages_end(struct language *language);

#endif
