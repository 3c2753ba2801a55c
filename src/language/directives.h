/* Directives, and all other tokens of the scanner that are not the grammar's. */
#ifndef PSCN_LANGUAGE_DIRECTIVES_H
#define PSCN_LANGUAGE_DIRECTIVES_H

#include "language/state.h"

/* Handles the scanner's last token if it is not the grammar's. Returns whether it did and the next one is wanted. */
bool directives_pass(struct language *language, int token);

/* Reports a directive that pscn, or nobody, has. */
void directives_tell(struct language *language, int token);

#endif
