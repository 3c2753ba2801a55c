/* A listener follows long work: it hears of progress and problems, and may stop the work.
 *
 * The library never prints; a command shows what is told here. A text has no newline at its end. One thread at a time.
 */
#ifndef PSCN_BASE_LISTENER_H
#define PSCN_BASE_LISTENER_H

#include <stdatomic.h>
#include <stdbool.h>

#include "base/status.h"

enum told {
  TOLD_PROGRESS, /* what goes on; a listener may ignore it */
  TOLD_WARNING,
  TOLD_ERROR,
  TOLD_DETAIL /* lines that belong to the error before them */
};

struct listener {
  void (*hear)(void *context, enum told what, const char *text);
  void *context;
  const atomic_int *stop; /* the work ends early when it turns nonzero (a signal handler may set it) */
};

/* Formats as printf does. A very long text is cut off. */
void listener_tell(const struct listener *listener, enum told what, const char *format, ...)
  __attribute__((format(printf, 3, 4)));

/* Tells an error, and returns its status. */
enum status listener_fail(const struct listener *listener, enum status status, const char *format, ...)
  __attribute__((format(printf, 3, 4)));

enum status listener_out_of_memory(const struct listener *listener);

bool listener_stopped(const struct listener *listener);

#endif
