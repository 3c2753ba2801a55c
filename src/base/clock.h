/* Clocks of POSIX as one number. Any thread. */
#ifndef PSCN_BASE_CLOCK_H
#define PSCN_BASE_CLOCK_H

#include <time.h>

static inline double clock_value(struct timespec now) { return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec; }

/* Seconds since the clock's own start. The clock is CLOCK_MONOTONIC, CLOCK_PROCESS_CPUTIME_ID or
 * CLOCK_THREAD_CPUTIME_ID, of the calling thread. Only differences mean anything. */
static inline double clock_seconds(clockid_t clock)
{
  struct timespec now;
  clock_gettime(clock, &now);
  return clock_value(now);
}

/* Time taken, in seconds: on the wall clock, and of the processor by all threads of the process. */
struct seconds {
  double wall, cpu;
};

/* A moment, and the time since one. */
static inline struct seconds seconds_now(void)
{
  return (struct seconds){clock_seconds(CLOCK_MONOTONIC), clock_seconds(CLOCK_PROCESS_CPUTIME_ID)};
}

static inline struct seconds seconds_between(struct seconds start, struct seconds end)
{
  return (struct seconds){end.wall - start.wall, end.cpu - start.cpu};
}

static inline struct seconds seconds_since(struct seconds start) { return seconds_between(start, seconds_now()); }

#endif
