/* A scene's text as POV-Ray can read it: a copy of the file and of the files it includes, without solver statements.
 *
 * Everything else stays as it is, byte for byte, except that #includes name the copies, which are all in one folder.
 * Blanks replace what is removed, so that line numbers in POV-Ray's messages are those of the scene. Both branches of a
 * condition are copied; an #include of a file that does not exist is left alone.
 */
#ifndef PSCN_PAGE_PLAIN_COPY_H
#define PSCN_PAGE_PLAIN_COPY_H

#include "base/status.h"

enum { PLAIN_COPY_WORD_SIZE = 400 };

/* Copies the scene file at `path` to `folder`/`name`, and each included file to "K-FILE" beside it, K = 1, 2, ...
 * `folders` are those of language_settings. STATUS_FILE if a file cannot be read or written: out_reason says why in
 * English. STATUS_LIMIT if memory is short or more than 10000 files are included.
 *
 * out_word is "", unless POV-Ray could read or write files other than these by what the text says, skipped text and
 * macros included: then it is the first such word and its file, "#fopen in 'parts.inc'", and the copy is not whole. */
STATUS_MUST_CHECK enum status plain_copy(const char *path, const char *const *folders, const char *folder,
                                         const char *name, const char **out_reason,
                                         char out_word[PLAIN_COPY_WORD_SIZE]);

#endif
