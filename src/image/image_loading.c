/* Loads OpenImageIO on another thread. */
#include "image/image_loading.h"

#include <sys/resource.h>

#include "base/clock.h"

static void *load_beside(void *argument)
{
  struct image_loading *loading = argument;
  const double start = clock_seconds(CLOCK_THREAD_CPUTIME_ID);
  loading->status = image_file_ready(loading->message);
  if (loading->status != STATUS_OK) atomic_store(&loading->failed, 1);
  atomic_store(&loading->seconds, clock_seconds(CLOCK_THREAD_CPUTIME_ID) - start);
  atomic_store(&loading->done, true);
  return NULL;
}

/* If memory is limited, other work could take the module's room before it loads, so it is loaded at once. */
static bool is_limited(int resource)
{
  struct rlimit limit;
  return getrlimit(resource, &limit) != 0 || limit.rlim_cur != RLIM_INFINITY;
}

void image_loading_begin(struct image_loading *loading, bool needed)
{
  *loading = (struct image_loading){.status = STATUS_OK};
  if (!needed) return;
  loading->running = !is_limited(RLIMIT_AS) && !is_limited(RLIMIT_DATA) &&
                     pthread_create(&loading->thread, NULL, load_beside, loading) == 0;
  if (!loading->running) (void)load_beside(loading);
}

double image_loading_seconds(const struct image_loading *loading)
{
  clockid_t clock;
  struct timespec now;
  const bool runs = loading->running && pthread_getcpuclockid(loading->thread, &clock) == 0 &&
                    clock_gettime(clock, &now) == 0; /* otherwise it has ended */
  const double all = atomic_load(&loading->seconds);
  return all > 0 || !runs ? all : clock_value(now);
}

bool image_loading_done(const struct image_loading *loading)
{
  return !loading->running || atomic_load(&loading->done);
}

enum status image_loading_end(struct image_loading *loading, const char **out_message)
{
  if (loading->running) pthread_join(loading->thread, NULL);
  loading->running = false;
  *out_message = loading->message;
  return loading->status;
}
