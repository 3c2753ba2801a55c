/* Threads, started and waited for. */
#include "render/threads.h"

#include <stdlib.h>

static void *run(void *argument)
{
  struct thread *thread = argument;
  thread->status = thread->work(thread->context, thread->worker);
  return NULL;
}

size_t threads_start(struct thread threads[], size_t first, size_t count, team_work *work, void *context)
{
  for (size_t k = 0; k < count; k++) {
    threads[k] = (struct thread){.work = work, .context = context, .worker = first + k};
    if (pthread_create(&threads[k].id, NULL, run, &threads[k]) != 0) return k;
  }
  return count;
}

enum status threads_join(struct thread threads[], size_t count)
{
  enum status status = STATUS_OK;
  for (size_t k = 0; k < count; k++) {
    pthread_join(threads[k].id, NULL);
    if (status == STATUS_OK) status = threads[k].status;
  }
  return status;
}

static enum status run_team(size_t count, team_work *work, void *context)
{
  struct thread *others = calloc(count, sizeof *others);
  if (others == NULL) return STATUS_LIMIT;
  const size_t started = threads_start(others, 1, count - 1, work, context);
  const enum status own = started == count - 1 ? work(context, 0) : STATUS_LIMIT;
  const enum status status = threads_join(others, started);
  free(others);
  return own == STATUS_OK ? status : own;
}

struct team threads_team(size_t count) { return (struct team){run_team, count}; }
