/* Work shared by several threads. The caller's team starts them; the library starts none.
 *
 * Threads of a team use libc's memory. A caller whose memory comes from hooks (memory.h) works by itself.
 */
#ifndef PSCN_BASE_TEAM_H
#define PSCN_BASE_TEAM_H

#include <assert.h>
#include <stddef.h>

#include "base/memory.h"
#include "base/status.h"

/* One thread's share, of worker 0 ... count-1. */
typedef enum status team_work(void *context, size_t worker);

struct team {
  /* Runs all workers at once, and returns when the last is done: STATUS_OK, or a status that one of them returned
   * instead, or STATUS_LIMIT where threads are short. Some workers may not have been called then. */
  enum status (*run)(size_t count, team_work *work, void *context);
  size_t count; /* >= 1 */
};

/* A NULL team is the calling thread by itself. */
static inline size_t team_count(const struct team *team) { return team ? team->count : 1; }

/* Runs as many workers as there are parts of work, at most all. They take the parts one after the other. */
STATUS_MUST_CHECK static inline enum status team_run(const struct team *team, size_t parts, team_work *work,
                                                     void *context)
{
  const size_t count = team_count(team) < parts ? team_count(team) : parts;
  /* The caller frees what they make. An empty scene has no part. */
  assert(count <= 1 || memory_is_libcs());
  return count > 1 ? team->run(count, work, context) : work(context, 0);
}

#endif
