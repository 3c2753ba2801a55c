/* Memory from the hooks of this thread. */
#define _DEFAULT_SOURCE /* madvise */
#include "base/memory.h"

#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#if defined(__linux__)
#include <malloc.h> /* malloc_usable_size */
#endif

enum { HUGE_PAGE_BYTES = 1 << 21 };

static _Thread_local struct memory_hooks hooks_now;
static _Thread_local struct memory_limit *limit_now;

struct memory_hooks memory_use(struct memory_hooks hooks)
{
  const struct memory_hooks before = hooks_now;
  hooks_now = hooks;
  return before;
}

struct memory_limit *memory_limit_use(struct memory_limit *limit)
{
  struct memory_limit *before = limit_now;
  limit_now = limit;
  return before;
}

struct memory_limit *memory_limit_now(void) { return limit_now; }

bool memory_limit_reached(void) { return limit_now && atomic_load(&limit_now->reached); }

/* What a block takes: its size, and libc's own number before it. */
static size_t taken(void *block)
{
#if defined(__linux__)
  return block ? malloc_usable_size(block) + sizeof(size_t) : 0;
#else
  (void)block;
  return 0;
#endif
}

/* Whether that many more bytes are allowed. */
static bool allowed(size_t bytes)
{
  if (!limit_now || limit_now->most == 0) return true;
  const size_t used = atomic_load(&limit_now->used);
  if (used <= limit_now->most && bytes <= limit_now->most - used) return true;
  atomic_store(&limit_now->reached, true);
  return false;
}

/* Counts a new block instead of one that took `before`. */
static void *counted(void *block, size_t before)
{
  if (limit_now && block) atomic_fetch_add(&limit_now->used, taken(block) - before);
  return block;
}

/* Zeroed elements from libc. */
static void *new_block(size_t count, size_t size)
{
  size_t bytes;
  if (__builtin_mul_overflow(count, size, &bytes) || !allowed(bytes)) return NULL;
  return counted(calloc(count ? count : 1, size), 0);
}

bool memory_is_libcs(void) { return hooks_now.resize == NULL; }

void *memory_alloc(size_t count, size_t size)
{
  size_t bytes;
  if (!hooks_now.resize) return new_block(count, size);
  if (__builtin_mul_overflow(count, size, &bytes)) return NULL;
  void *block = hooks_now.resize(hooks_now.context, NULL, bytes ? bytes : 1);
  if (block) memset(block, 0, bytes);
  return block;
}

void *memory_resize(void *block, size_t size)
{
  if (hooks_now.resize) return hooks_now.resize(hooks_now.context, block, size);
  const size_t before = limit_now ? taken(block) : 0;
  return size > before && !allowed(size - before) ? NULL : counted(realloc(block, size), before);
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
  if (!hooks_now.resize && limit_now) atomic_fetch_sub(&limit_now->used, taken(block));
  if (!hooks_now.resize) free(block);
  else if (block) (void)hooks_now.resize(hooks_now.context, block, 0);
}
