/* Macros: where their text is, and their calls. */
#ifndef PSCN_LANGUAGE_MACROS_H
#define PSCN_LANGUAGE_MACROS_H

#include "language/sources.h"
#include "language/symbols.h"

struct macro {
  struct passage text;
  size_t parameter_count;
  struct parameter {
    struct parameter *next;
    const char *name;
    size_t length;
  } * parameters;
};

/* At #macro: declares a macro, and passes over its text. */
void macro_declare(struct language *language);

/* If the word just read names a macro, reads its arguments and begins to read its text. Returns whether it did. */
bool macro_called(struct language *language);

#endif
