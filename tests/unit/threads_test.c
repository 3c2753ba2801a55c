/* Threads: each worker works once, and no worker's failure is lost. */
#include "render/threads.h"

#include <errno.h>
#include <limits.h>
#include <signal.h>
#include <stdatomic.h>
#include <sys/resource.h>

#include "cmocka_test.h"

enum { WORKERS = 5 };

struct work {
  size_t failing;
  enum status with;
  atomic_int times[WORKERS];
};

static enum status work_once(void *context, size_t worker)
{
  struct work *work = context;
  atomic_fetch_add(&work->times[worker], 1);
  return worker == work->failing ? work->with : STATUS_OK;
}

TEST(a_failure_is_not_lost)
{
  for (size_t failing = 0; failing <= WORKERS; failing++) {
    struct work work = {.failing = failing, .with = STATUS_LIMIT};
    const struct team team = threads_team(WORKERS);
    const enum status status = team.run(WORKERS, work_once, &work);
    assert_int_equal(status, failing < WORKERS ? STATUS_LIMIT : STATUS_OK);
    for (int k = 0; k < WORKERS; k++) assert_int_equal(work.times[k], 1);
  }
}

/* This many calls of pthread_create succeed. */
static int startable = INT_MAX;

int __real_pthread_create(pthread_t *id, const pthread_attr_t *attributes, void *(*run)(void *), void *argument);
int __wrap_pthread_create(pthread_t *id, const pthread_attr_t *attributes, void *(*run)(void *), void *argument);
int __wrap_pthread_create(pthread_t *id, const pthread_attr_t *attributes, void *(*run)(void *), void *argument)
{
  return startable-- > 0 ? __real_pthread_create(id, attributes, run, argument) : EAGAIN;
}

/* A team that lacks a thread fails, and the missing members' work is not done. */
TEST(a_missing_thread_is_told)
{
  struct work work = {.failing = WORKERS};
  startable = WORKERS - 2;
  const enum status status = threads_team(WORKERS).run(WORKERS, work_once, &work);
  startable = INT_MAX;
  assert_int_equal(status, STATUS_LIMIT);
  for (int k = 0; k < WORKERS; k++) assert_int_equal(work.times[k], k > 0 && k < WORKERS - 1);
}

/* Workers are numbered from the given first one, and the first failure is returned. */
TEST(they_are_joined)
{
  struct thread threads[WORKERS];
  struct work work = {.failing = 2, .with = STATUS_INTERRUPTED};
  assert_int_equal(threads_start(threads, 1, WORKERS - 1, work_once, &work), WORKERS - 1);
  assert_int_equal(threads_join(threads, WORKERS - 1), STATUS_INTERRUPTED);
  for (int k = 0; k < WORKERS; k++) assert_int_equal(work.times[k], k > 0);
}

/* If the stack is small, the work is done in a thread with a larger one. Afterwards the signal mask is as before. */
static enum status fill_stack(void *context, size_t worker)
{
  volatile char much[3 << 20];
  for (size_t k = 0; k < sizeof much; k += 1024) much[k] = 1;
  *(char *)context = much[1024];
  return worker == 0 ? STATUS_FILE : STATUS_OK;
}

TEST(there_is_room_for_deep_work)
{
  struct rlimit limit, little;
  sigset_t before, after;
  char done = 0;
  assert_int_equal(pthread_sigmask(SIG_SETMASK, NULL, &before), 0);
  assert_int_equal(getrlimit(RLIMIT_STACK, &limit), 0);
  little = limit, little.rlim_cur = 1 << 20;
  assert_int_equal(setrlimit(RLIMIT_STACK, &little), 0);
  assert_int_equal(threads_run_deep(fill_stack, &done), STATUS_FILE);
  assert_int_equal(setrlimit(RLIMIT_STACK, &limit), 0);
  assert_int_equal(done, 1);
  assert_int_equal(pthread_sigmask(SIG_SETMASK, NULL, &after), 0);
  for (int number = 1; number < 32; number++)
    assert_int_equal(sigismember(&after, number), sigismember(&before, number));
}
