/* A list that grows. See growing.h. */
#include "base/growing.h"

#include "base/memory.h"

void *growing_add(struct growing *list, size_t more, size_t size)
{
  void *at = memory_grow(list->at, &list->room, list->count + more, size);
  if (!at) return NULL;
  list->at = at, list->count += more;
  return (char *)at + size * (list->count - more);
}
