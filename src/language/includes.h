/* Files that #include names. */
#ifndef PSCN_LANGUAGE_INCLUDES_H
#define PSCN_LANGUAGE_INCLUDES_H

#include "language/errors.h"

/* Begins to read a source, which it takes over, even on failure. False if memory is short. */
bool include_open(struct language *language, struct source *source);

/* Begins to read the file of that name, given at `place`, or reports an error. */
void include_file(struct language *language, struct span place, const char *name, size_t length);

#endif
