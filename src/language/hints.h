/* Hints: which file declares a name. */
#ifndef PSCN_LANGUAGE_HINTS_H
#define PSCN_LANGUAGE_HINTS_H

#include <stddef.h>

/* The file of POV-Ray's that declares the name, or NULL if none is known to. */
const char *hint_file(const char *word, size_t length);

#endif
