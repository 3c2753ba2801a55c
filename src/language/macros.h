/* What a macro does besides what it stands for. pscn passes over its text; but where POV-Ray calls it within a
 * declaration, names that it declares are not what they were before. */
#ifndef PSCN_LANGUAGE_MACROS_H
#define PSCN_LANGUAGE_MACROS_H

#include "language/symbols.h"

struct macro;

struct macro *macro_begin(struct language *language);
/* One token after the other, from behind the macro's name. */
void macro_note(struct language *language, struct macro *macro, int token, struct span place);

/* A word of a declaration or of what is passed over: where it is the name of a macro, what that declares is foreign from here on. */
void macro_called(struct language *language, struct span place);

#endif
