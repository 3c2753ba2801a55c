/* Another program, run to its end.
 *
 * The program gets a process group of its own, so that a key pressed at the terminal reaches us alone; when `stop`
 * turns nonzero or its time is over the whole group is asked to end, then made to, and is reaped. Where we are killed,
 * Linux kills it too. One program at a time, started from a thread that outlives it.
 */
#ifndef PSCN_CHECK_PROCESS_H
#define PSCN_CHECK_PROCESS_H

#include <stdatomic.h>
#include <stdbool.h>
#include <stddef.h>

#include "base/clock.h"
#include "base/status.h"

struct process_request {
  const char *const *arguments; /* ended by NULL; [0] is the program, looked for along PATH where it has no slash */
  const char *folder;           /* where it runs, or NULL: here */
  /* pairs NAME, VALUE, ended by NULL, that change ours (a VALUE of NULL unsets); or NULL */
  const char *const *environment;
  const char *output; /* file that receives what it says on both outputs, seen from our folder */
  double timeout;     /* seconds by the clock that it may take; 0: any */
  size_t memory;      /* bytes that it may address, and that a file of its may have; 0: any */
  bool confined;      /* it may write in `folder` only, where the system can see to that */
};

struct process_result {
  bool missing;        /* there is no such program, or it may not be run; `reason` says why, the rest is unset */
  int reason;          /* errno of a program that could not be started, or 0 */
  int exit_code;       /* 128 + the signal's number where a signal ended it */
  struct seconds time; /* by the clock, and of the processor by the program and those it waited for */
};

/* Standard input is empty. STATUS_FILE where it could not be started, STATUS_INTERRUPTED where `stop` ended it,
 * STATUS_LIMIT where the time did; an exit code other than 0 is a result. */
enum status process_run(const struct process_request *request, const atomic_int *stop,
                        struct process_result *out) STATUS_MUST_CHECK;

/* Whether the system can see to `confined`: Linux with Landlock (5.13). */
bool process_can_confine(void);

#endif
