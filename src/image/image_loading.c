/* A thread that loads OpenImageIO. */
#include "image/image_loading.h"

#include <sys/resource.h>

static void *load_beside(void *argument)
{
  struct image_loading *loading = argument;
  loading->status = image_file_ready(loading->message);
  if (loading->status != STATUS_OK) atomic_store(&loading->failed, 1);
  return NULL;
}

/* Where memory is limited the room for the module may be gone before it is taken, so it is taken at once. */
static bool is_limited(int resource)
{
  struct rlimit limit;
  return getrlimit(resource, &limit) != 0 || limit.rlim_cur != RLIM_INFINITY;
}

void image_loading_begin(struct image_loading *loading)
{
  atomic_init(&loading->failed, 0);
  loading->running = !is_limited(RLIMIT_AS) && !is_limited(RLIMIT_DATA) &&
                     pthread_create(&loading->thread, NULL, load_beside, loading) == 0;
  if (!loading->running) (void)load_beside(loading);
}

enum status image_loading_end(struct image_loading *loading, const char **out_message)
{
  if (loading->running) pthread_join(loading->thread, NULL);
  loading->running = false;
  *out_message = loading->message;
  return loading->status;
}
