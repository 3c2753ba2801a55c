/* Source text: the bytes of one scene file, and the line and column of a byte offset.
 *
 * The bytes are kept as they are in the file (any bytes, NUL included). An included source knows the place of its
 * #include. Sources are read-only once made, except that the scanner ends words in `text` for a moment. They own what
 * they point to, except `includer` and a shared text. The memory of a long file's text may be given back while it is
 * read (source_drop), and is filled again when that text is needed once more (source_recall).
 */
#ifndef PSCN_BASE_SOURCE_H
#define PSCN_BASE_SOURCE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "base/arena.h"
#include "base/input.h"
#include "base/status.h"

struct source {
  char *name;               /* as shown in diagnostics: the path, or a word in <> for text that has none */
  char *text;               /* length bytes, then two NULs */
  bool shared;              /* the text belongs to another source of the same file */
  struct source_rest *rest; /* of a long file, or NULL */
  size_t length;
  size_t lines_before;           /* of a text that is a part of another one: the lines before it */
  uint64_t device, inode;        /* which file it is; 0,0 for text */
  const struct source *includer; /* the source whose #include opened this one, or NULL */
  size_t include_begin;          /* where the file name is in the includer's text */
};

/* Bytes begin .. end-1 of a source. A NULL source means "no place". */
struct place {
  const struct source *source;
  size_t begin, end;
};

/* The longest file that is read. For longer ones the answer is STATUS_LIMIT. */
#define SOURCE_MAX_BYTES ((size_t)1 << 30)

/* Reads the whole file at `path` (input.h; opened once, so pipes work). STATUS_FILE: out_reason says why in English
 * words, and nothing is written to out_source. STATUS_LIMIT: memory or SOURCE_MAX_BYTES. The caller destroys the
 * source. source_read_open reads an open file of any kind, and closes it; `name` is shown in diagnostics. */
STATUS_MUST_CHECK enum status source_read(const char *path, enum input_kind kind, struct source **out_source,
                                          const char **out_reason);
STATUS_MUST_CHECK enum status source_read_open(const char *name, int file, struct source **out_source,
                                               const char **out_reason);

/* Gives back the memory of the text before byte `end`, except for some bytes, if it can be read from the file again. */
void source_drop(const struct source *source, size_t end);

/* Reads dropped text again, and keeps it; what the file no longer has becomes NUL. To be called before `text` is read
 * where it may have been dropped; source_locate does so. */
void source_recall(const struct source *source);

/* Which file `path` names now; false if there is none. */
bool source_identify(const char *path, uint64_t *out_device, uint64_t *out_inode);

/* A source of the same text under the name `path`, valid as long as `source`, or NULL where memory is short. */
struct source *source_share(const struct source *source, const char *path);

/* A source of a copy of `length` bytes at `text`, or NULL where memory is short. */
struct source *source_from_text(const char *name, const char *text, size_t length);

/* Line and column of a byte, both from 1. Columns count characters: a UTF-8 sequence is one, so is a tab. */
struct source_position {
  size_t line, column;
  size_t line_begin, line_end; /* bytes of the line, without its line end; of a very long line, a part */
};
struct source_position source_locate(const struct source *source, size_t offset);

/* 8 if the next eight bytes are eight characters, which may be passed at once; otherwise 0. */
size_t source_skip(const char *text, size_t length);

/* The length in bytes of the UTF-8 character at text[0 .. length-1], length >= 1; 0 if it is not well formed. */
size_t source_character(const char *text, size_t length);

/* Whether a terminal shows the character of `bytes` bytes and does not obey it: it is well formed, and no control
 * character, not even one of Unicode's. */
bool source_is_shown(const char *text, size_t bytes);

/* NULL is allowed. */
void source_destroy(struct source *source);

/* ---- the file that an #include names. Folders are searched as in POV-Ray: first the scene's, because POV-Ray is started
 * there, then the includer's, then those given. A name that ends in neither .inc nor .INC is first tried with each of
 * these endings, in all folders, and then by itself. A name that begins with / is a whole path. ---- */

struct include_folders {
  const struct source *scene, *includer; /* may be the same */
  const char *const *others;             /* ended by NULL; or NULL */
};

/* Returns the path of the first file that exists, and which file it is. If none exists, *out_inode is 0, and the path
 * is the one beside the includer. NULL if memory is short. */
char *include_path(struct arena *arena, const struct include_folders *folders, const char *name, size_t length,
                   uint64_t *out_device, uint64_t *out_inode);

/* Whether a stranger may ask for that name: it is no whole path, and no part of it is "..". Then whether the file found
 * is, by its descriptor, in one of the folders or below it. A scene that is no file has only the folder in its name. */
bool include_is_modest(const char *name, size_t length);
bool include_is_below(const struct include_folders *folders, int file);

#endif
