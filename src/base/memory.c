/* Memory from the hooks of this thread. */
#define _DEFAULT_SOURCE /* madvise */
#include "base/memory.h"

#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>

enum { HUGE_PAGE_BYTES = 1 << 21 };

static _Thread_local struct memory_hooks hooks_now;

struct memory_hooks memory_use(struct memory_hooks hooks)
{
  const struct memory_hooks before = hooks_now;
  hooks_now = hooks;
  return before;
}

bool memory_is_libcs(void) { return hooks_now.resize == NULL; }

void *memory_alloc(size_t count, size_t size)
{
  size_t bytes;
  if (!hooks_now.resize) return calloc(count ? count : 1, size);
  if (__builtin_mul_overflow(count, size, &bytes)) return NULL;
  void *block = hooks_now.resize(hooks_now.context, NULL, bytes ? bytes : 1);
  if (block) memset(block, 0, bytes);
  return block;
}

void *memory_resize(void *block, size_t size)
{
  return hooks_now.resize ? hooks_now.resize(hooks_now.context, block, size) : realloc(block, size);
}

enum { A_FEW = 32 };

void *memory_grow(void *block, size_t *room, size_t needed, size_t size)
{
  size_t larger, bytes;
  if (block && needed <= *room) return block;
  if (__builtin_mul_overflow(needed, 2, &larger) || __builtin_add_overflow(larger, A_FEW, &larger) ||
      __builtin_mul_overflow(larger, size, &bytes))
    return NULL;
  void *grown = memory_resize(block, bytes);
  if (grown) *room = larger;
  return grown;
}

void *growing_add(struct growing *list, size_t more, size_t size)
{
  void *at = memory_grow(list->at, &list->room, list->count + more, size);
  if (!at) return NULL;
  list->at = at, list->count += more;
  return (char *)at + size * (list->count - more);
}

char *memory_copy_text(const char *text)
{
  const size_t size = strlen(text) + 1;
  char *copy = memory_resize(NULL, size);
  return copy ? memcpy(copy, text, size) : NULL;
}

void memory_used_anywhere(void *block, size_t size)
{
#if defined(MADV_HUGEPAGE)
  const size_t before = -(uintptr_t)block % HUGE_PAGE_BYTES;
  if (hooks_now.resize || size < before + HUGE_PAGE_BYTES) return;
  const size_t whole = (size - before) / HUGE_PAGE_BYTES * HUGE_PAGE_BYTES;
  (void)madvise((char *)block + before, whole, MADV_HUGEPAGE); /* no effect where there are none */
#else
  (void)block, (void)size;
#endif
}

void memory_free(void *block)
{
  if (!hooks_now.resize) free(block);
  else if (block) (void)hooks_now.resize(hooks_now.context, block, 0);
}
