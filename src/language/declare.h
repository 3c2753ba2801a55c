/* #declare and #local. */
#ifndef PSCN_LANGUAGE_DECLARE_H
#define PSCN_LANGUAGE_DECLARE_H

#include "language/values.h"

/* Begins a declaration of a name or of an array's element, whose `target` begins with the name's place, followed by the
 * indices. Declarations may be nested. `local`: the place of its #local, or NULL. */
struct declaration *declare_begin(struct language *language, struct value *target, const struct span *local);
/* Begins another one of a name that has been declared just now. */
void declare_again(struct language *language, struct value *value);
/* Ends it: the name has that value. */
void declare_value(struct language *language, struct declaration *declaration, const struct value *value);
/* The same where the ; is missing, without which POV-Ray reads strings, arrays, textures and objects only. */
void declare_open(struct language *language, struct declaration *declaration, const struct value *value);
void declare_broken(struct language *language, struct declaration *declaration); /* after an error */
/* At the end of a file, reports the open declarations of names that are local to it. */
void declare_left_open(struct language *language, struct span end);

/* Declares a number, such as the one by which a scene tells pscn from POV-Ray. */
void declare_number(struct language *language, const char *name, size_t length, double number);

#endif
