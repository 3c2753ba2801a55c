/* Threads that do one thing together.
 *
 * Internal to src/render, but for threads_team and threads_run_deep.
 */
#ifndef PSCN_RENDER_THREADS_H
#define PSCN_RENDER_THREADS_H

#include <pthread.h>

#include "base/team.h"

struct thread {
  pthread_t id;
  team_work *work;
  void *context;
  size_t worker;
  enum status status;
};

/* Starts threads[0 .. count-1], each for the worker of its index plus `first`; returns how many there was room for. */
size_t threads_start(struct thread threads[], size_t first, size_t count, team_work *work, void *context);

/* Waits for them; the first status that is not STATUS_OK. */
enum status threads_join(struct thread threads[], size_t count);

/* Does the work as worker 0 with the stack that a hard ray takes: on the calling thread, or, where `ulimit -s` leaves
 * that less, on another one, which then gets the signals too. STATUS_LIMIT where there is no room for it. */
enum status threads_run_deep(team_work *work, void *context);

/* A team of so many, the calling thread one of them. */
struct team threads_team(size_t count);

#endif
