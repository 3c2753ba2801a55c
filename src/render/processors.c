/* The processors that this process may use: those of its affinity mask, which containers and taskset(1) restrict. */
#define _GNU_SOURCE 1 /* for sched_getaffinity and CPU_COUNT */
#include <sched.h>
#include <unistd.h>

#include "render/render.h"

size_t render_processors(void)
{
  cpu_set_t set;
  CPU_ZERO(&set);
  if (sched_getaffinity(0, sizeof set, &set) == 0 && CPU_COUNT(&set) > 0) return (size_t)CPU_COUNT(&set);
  const long online = sysconf(_SC_NPROCESSORS_ONLN);
  return online > 0 ? (size_t)online : 1;
}
