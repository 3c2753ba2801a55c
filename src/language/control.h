/* Conditions, loops and #switch. A loop's text is read again from its place in the source. */
#ifndef PSCN_LANGUAGE_CONTROL_H
#define PSCN_LANGUAGE_CONTROL_H

#include "language/state.h"

/* If the scanner's last token is a directive of these, or an #end, handles it. Returns whether it did. */
bool control_pass(struct language *language, int token);

/* Skips to behind the matching #end; false if there is none. */
bool control_skip_to_end(struct language *language);

/* At the end of a source, reports what is open in it. */
void control_end(struct language *language);

/* Goes back to the includer or to the call. */
void control_leave(struct language *language);

#endif
