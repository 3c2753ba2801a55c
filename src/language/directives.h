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

/* ---- conditions, loops and #switch; a loop's text is read again from its place in the source ---- */

/* If the scanner's last token is a directive of these, or an #end, handles it. Returns whether it did. */
bool control_pass(struct language *language, int token);

/* Skips to behind the matching #end; false if there is none. */
bool control_skip_to_end(struct language *language);

/* At the end of a source, reports what is open in it. */
void control_end(struct language *language);

/* Goes back to the includer or to the call. */
void control_leave(struct language *language);

/* ---- macros ---- */

/* At #macro: declares a macro, and passes over its text. */
void macro_declare(struct language *language);

/* If the word just read names a macro, reads its arguments and begins to read its text. Returns whether it did. */
bool macro_called(struct language *language);

#endif
