/* Starts threads and waits for them. */
#include "render/threads.h"

#include <signal.h>
#include <stdbool.h>
#include <stdlib.h>
#include <sys/resource.h>

static void *run(void *argument)
{
  struct thread *thread = argument;
  (void)memory_limit_use(thread->limit);
  thread->status = thread->work(thread->context, thread->worker);
  return NULL;
}

/* Each thread's least stack, whatever `ulimit -s` says: more than twice the need of a hard ray as in
 * intersect/exact/exact.h. */
enum { LEAST_STACK = 4 << 20 };

size_t threads_start(struct thread threads[], size_t first, size_t count, team_work *work, void *context)
{
  pthread_attr_t attributes;
  size_t stack = 0, started = 0;
  if (pthread_attr_init(&attributes) != 0) return 0;
  bool ready = pthread_attr_getstacksize(&attributes, &stack) == 0;
  if (ready && stack < LEAST_STACK) ready = pthread_attr_setstacksize(&attributes, LEAST_STACK) == 0;
  for (; ready && started < count; started++) {
    struct thread *thread = &threads[started];
    *thread = (struct thread){.work = work, .context = context, .limit = memory_limit_now(), .worker = first + started};
    if (pthread_create(&thread->id, &attributes, run, thread) != 0) break;
  }
  (void)pthread_attr_destroy(&attributes);
  return started;
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

enum status threads_run_deep(team_work *work, void *context)
{
  struct rlimit limit;
  struct thread thread;
  sigset_t all, before;
  if (getrlimit(RLIMIT_STACK, &limit) != 0 || limit.rlim_cur >= LEAST_STACK) return work(context, 0);
  if (threads_start(&thread, 0, 1, work, context) != 1) return STATUS_LIMIT;
  sigfillset(&all);
  pthread_sigmask(SIG_SETMASK, &all, &before);
  const enum status status = threads_join(&thread, 1);
  pthread_sigmask(SIG_SETMASK, &before, NULL);
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
