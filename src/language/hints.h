/* Hints: what replaces the features of POV-Ray that pscn lacks. */
#ifndef PSCN_LANGUAGE_HINTS_H
#define PSCN_LANGUAGE_HINTS_H

#include <stddef.h>

/* Writes what pscn has instead of a word, or of a directive with its #: the text that follows "but pscn". Cut off at
 * `size` bytes; HINT_SIZE is enough for every word of POV-Ray's. */
enum { HINT_SIZE = 200 };
void hint_write(const char *word, size_t length, char *out, size_t size);

/* The file of POV-Ray's that declares the name, or NULL if none is known to. */
const char *hint_file(const char *word, size_t length);

#endif
