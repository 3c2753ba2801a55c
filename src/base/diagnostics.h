/* Diagnostics: errors found in text, each with its place, told to whoever asked.
 *
 * An error is told as whole lines, in one call of the sink:
 *
 *     included from scene.pscn:3:10:          (one line an include level, outermost first)
 *     parts.inc:7:12: error: unknown word 'loaction'; did you mean 'location'?
 *       camera { loaction <0,0,-5> }
 *                ^~~~~~~~
 *
 * Where memory is too short for that it is told without its place, and nothing else is lost. The library never prints:
 * the command's sink does. After DIAGNOSTICS_MAX_ERRORS errors a closing line is told, once, and the rest are only
 * counted; so it is with warnings. Initialise with { .tell = f, .context = c }. One thread at a time.
 */
#ifndef PSCN_BASE_DIAGNOSTICS_H
#define PSCN_BASE_DIAGNOSTICS_H

#include <stdbool.h>
#include <stddef.h>

#include "base/source.h"

enum { DIAGNOSTICS_MAX_ERRORS = 20 };

/* Where in a text that is told its parts stand, in bytes: the name of the file, and what is said of it. */
struct diagnostics_parts {
  size_t name_begin, name_end, said_begin, said_end;
  size_t line, column; /* 0 where it has no place, and then no name */
  bool warning;
};

struct diagnostics {
  void (*tell)(void *context, const char *text, size_t length); /* text ends with a newline; NULL: only counted */
  void *context;
  size_t error_count, warning_count;
  bool quiet;                     /* warnings are not told */
  struct diagnostics_parts parts; /* of the text, while it is told */
};

/* An error at a place. A place without source gives a bare "error: text" line. */
void diagnostics_error(struct diagnostics *diagnostics, struct place place, const char *format, ...)
  __attribute__((format(printf, 3, 4)));

/* Likewise a warning, "warning: text"; it is no error and is not counted as one. */
void diagnostics_warning(struct diagnostics *diagnostics, struct place place, const char *format, ...)
  __attribute__((format(printf, 3, 4)));

/* Whether further errors would only be counted. */
static inline bool diagnostics_full(const struct diagnostics *diagnostics)
{
  return diagnostics->error_count >= DIAGNOSTICS_MAX_ERRORS;
}

#endif
