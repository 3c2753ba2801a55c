/* `solver NAME { item value ... }`. Names, items and ranges come from the tables in algebra/solver.h and
 * scene/method.h. The statement's result becomes language->method. */
#ifndef PSCN_LANGUAGE_SOLVER_STATEMENT_H
#define PSCN_LANGUAGE_SOLVER_STATEMENT_H

#include "language/values.h"
#include "scene/method.h"

/* Actions of the grammar: the name, which sets the method's defaults, then each item. `place`: that of the word. */
void solver_begin(struct language *language, struct span name);
void solver_misplaced(struct language *language, struct span place);
/* The item that the word names, in capitals or not; NULL if there is none. */
const struct method_item *solver_item_find(const struct name *word);
void solver_quantity(struct language *language, struct span item, const struct value *value);
/* A keyword of the item, or else the name of a number. */
void solver_word(struct language *language, struct span item, struct span value);

#endif
