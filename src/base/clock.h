/* Clocks of POSIX as one number. Any thread. */
#ifndef PSCN_BASE_CLOCK_H
#define PSCN_BASE_CLOCK_H

#include <time.h>

/* Seconds since the clock's own start: CLOCK_MONOTONIC; CLOCK_PROCESS_CPUTIME_ID; CLOCK_THREAD_CPUTIME_ID, of the
 * calling thread. Only differences mean anything. */
static inline double clock_seconds(clockid_t clock)
{
  struct timespec now;
  clock_gettime(clock, &now);
  return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

#endif
