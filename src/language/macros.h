/* What a macro does besides what it stands for. pscn skips its text. But where POV-Ray calls it within a declaration,
 * the names that it declares change their meaning. */
#ifndef PSCN_LANGUAGE_MACROS_H
#define PSCN_LANGUAGE_MACROS_H

#include "language/symbols.h"

struct macro;

struct macro *macro_begin(struct language *language);
/* Takes one token after another, beginning behind the macro's name. */
void macro_note(struct language *language, struct macro *macro, int token, struct span place);

/* Handles a word of a declaration or of skipped text: if it names a macro, all that this declares is foreign from here
 * on. */
void macro_called(struct language *language, struct span place);

#endif
