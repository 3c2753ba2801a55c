/* `solver NAME { item value ... }`: names, items and ranges come from the tables in algebra/solver.h and
 * scene/method.h. What the statement says becomes language->method. */
#ifndef PSCN_LANGUAGE_SOLVER_STATEMENT_H
#define PSCN_LANGUAGE_SOLVER_STATEMENT_H

#include "language/values.h"
#include "scene/method.h"

/* Actions of the grammar: the name, which makes the method as it is by default, then each item. `place`: of the word. */
void solver_begin(struct language *language, struct span name);
void solver_misplaced(struct language *language, struct span place);
void solver_quantity(struct language *language, struct span item, const struct value *value);
/* A word of the item's, or else the name of a number. */
void solver_word(struct language *language, struct span item, struct span value);

#endif
