/* Runs another program to its end.
 *
 * The program gets its own process group, so that a key pressed at the terminal reaches only us. If `stop` turns
 * nonzero, or its time is over, the whole group is asked to end, then forced to, and the program is reaped. If we are
 * killed, Linux kills it too. Only one program at a time, started by a thread that outlives it.
 */
#ifndef PSCN_PAGE_PROCESS_H
#define PSCN_PAGE_PROCESS_H

#include <stdatomic.h>
#include <stdbool.h>
#include <stddef.h>

#include "base/clock.h"
#include "base/status.h"

struct process_request {
  const char *const *arguments; /* ended by NULL; [0] is the program, searched for in PATH if it has no slash */
  const char *folder;           /* where it runs; NULL: here */
  /* pairs NAME, VALUE, ended by NULL, that change our environment (VALUE NULL: unset); or NULL */
  const char *const *environment;
  const char *output; /* file for both its outputs, relative to our folder */
  double timeout;     /* seconds of wall time that it may take; 0: no limit */
  size_t written;     /* bytes that the files in `folder` may grow by, together; 0: no limit */
  size_t memory;      /* limit on its address space and on each of its files, in bytes; 0: none */
  bool confined;      /* it may write only in `folder`, if the system can enforce that */
};

struct process_result {
  bool missing;        /* the program does not exist or may not be run; `reason` says why, the rest is unset */
  bool overfull;       /* STATUS_LIMIT is because of `written` */
  int reason;          /* errno if the program could not be started, or 0 */
  int exit_code;       /* 128 + the signal's number if a signal ended it */
  struct seconds time; /* wall time, and CPU time of the program and those it waited for */
};

/* Runs the program, with empty standard input. Returns STATUS_FILE if it could not be started, STATUS_INTERRUPTED or
 * STATUS_LIMIT if `stop` or a limit ended it. An exit code other than 0 is a result. */
enum status process_run(const struct process_request *request, const atomic_int *stop,
                        struct process_result *out) STATUS_MUST_CHECK;

/* Whether the system can enforce `confined`: Linux with Landlock (5.13). */
bool process_can_confine(void);

#endif
