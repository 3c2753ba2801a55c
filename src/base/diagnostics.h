/* Diagnostics: errors found in text, each with its place, reported through a sink.
 *
 * An error is told as whole lines, in one call of the sink:
 *
 *     included from scene.pscn:3:10:          (one line an include level, outermost first)
 *     in round 3 of the loop at scene.pscn:9:1:  (one line a loop or a call of a macro, likewise)
 *     parts.inc:7:12: error: unknown word 'loaction'; did you mean 'location'?
 *       camera { loaction <0,0,-5> }
 *                ^~~~~~~~
 *
 * If memory is too short for that, the error is told without its place, and nothing else is lost. The library never
 * prints; the command's sink does. After DIAGNOSTICS_MAX_ERRORS errors one closing line is told, and the rest are only
 * counted; warnings are limited in the same way. Initialise with { .tell = f, .context = c }. One thread at a time.
 */
#ifndef PSCN_BASE_DIAGNOSTICS_H
#define PSCN_BASE_DIAGNOSTICS_H

#include <stdbool.h>
#include <stddef.h>

#include "base/source.h"

enum { DIAGNOSTICS_MAX_ERRORS = 20 };

/* Where the parts of a told text are, in bytes: the name of the file, and the message. */
struct diagnostics_parts {
  size_t name_begin, name_end, said_begin, said_end;
  size_t line, column; /* 0 if it has no place, and then no name */
  bool warning;
};

/* A loop or the call of a macro in which an error is found. */
struct diagnostics_around {
  struct place place;
  double round; /* of a loop, from 1 on; 0: a call */
};

struct diagnostics {
  void (*tell)(void *context, const char *text, size_t length); /* text ends with a newline; NULL: only counted */
  void *context;
  size_t error_count, warning_count;
  bool quiet;                              /* warnings are neither told nor counted */
  struct diagnostics_parts parts;          /* of the text, while it is told */
  const struct diagnostics_around *around; /* the next error: around_count of them, the outermost first */
  size_t around_count;
};

/* Tells an error at a place. A place without source gives a bare "error: text" line. */
void diagnostics_error(struct diagnostics *diagnostics, struct place place, const char *format, ...)
  __attribute__((format(printf, 3, 4)));

/* Tells a warning, "warning: text", in the same way. It does not count as an error. */
void diagnostics_warning(struct diagnostics *diagnostics, struct place place, const char *format, ...)
  __attribute__((format(printf, 3, 4)));

/* Tells a line of text that a scene prints, without its newline. */
void diagnostics_print(struct diagnostics *diagnostics, const char *text, size_t length);

/* Whether further errors would only be counted. */
static inline bool diagnostics_full(const struct diagnostics *diagnostics)
{
  return diagnostics->error_count >= DIAGNOSTICS_MAX_ERRORS;
}

#endif
