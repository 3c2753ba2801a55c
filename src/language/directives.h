/* Directives, and whatever else the scanner finds that is not the grammar's. */
#ifndef PSCN_LANGUAGE_DIRECTIVES_H
#define PSCN_LANGUAGE_DIRECTIVES_H

#include "language/state.h"

/* Deals with the scanner's last token where it is not the grammar's: true where it was such and the next one is wanted. */
bool directives_pass(struct language *language, int token);

/* Tells of one that pscn has not, or nobody. */
void directives_tell(struct language *language, int token);

#endif
