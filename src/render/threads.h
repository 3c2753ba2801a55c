/* Threads that share one piece of work.
 *
 * Internal to src/render, except threads_team and threads_run_deep.
 */
#ifndef PSCN_RENDER_THREADS_H
#define PSCN_RENDER_THREADS_H

#include <pthread.h>

#include "base/team.h"

struct thread {
  pthread_t id;
  team_work *work;
  void *context;
  struct memory_limit *limit; /* that of the thread that starts it */
  size_t worker;
  enum status status;
};

/* Starts threads[0 .. count-1], for the workers of their indices plus `first`. Returns how many could be started. */
size_t threads_start(struct thread threads[], size_t first, size_t count, team_work *work, void *context);

/* Waits for them. Returns the first status other than STATUS_OK. */
enum status threads_join(struct thread threads[], size_t count);

/* Does the work as worker 0 with enough stack for a hard ray: on the calling thread, or, if `ulimit -s` leaves less, on
 * another one, which then also gets the signals. Returns STATUS_LIMIT if that cannot be started. */
enum status threads_run_deep(team_work *work, void *context);

/* A team of `count` threads, including the calling one. */
struct team threads_team(size_t count);

#endif
