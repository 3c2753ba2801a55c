/* What to do instead of what POV-Ray has and pscn has not. */
#ifndef PSCN_LANGUAGE_HINTS_H
#define PSCN_LANGUAGE_HINTS_H

#include <stddef.h>

/* What pscn has instead of a word, or of a directive with its #, as it stands behind "but pscn". Cut off at `size` bytes;
 * HINT_SIZE holds any of a word of POV-Ray's. */
enum { HINT_SIZE = 200 };
void hint_write(const char *word, size_t length, char *out, size_t size);

#endif
