/* The memory of one reading. */
#include "language/state.h"

#include <assert.h>
#include <string.h>

bool language_afford(struct language *language, size_t bytes)
{
  language->unaffordable |= bytes > language->max_memory - language->memory_bytes;
  if (!language->unaffordable) language->memory_bytes += bytes;
  return !language->unaffordable;
}

/* If memory is short, a spare block stands in, and reading ends at the next token. The few blocks needed until then do
 * not overlap. */
void *language_alloc(struct language *language, size_t size)
{
  void *memory = language_afford(language, size) ? arena_alloc(language->arena, 1, size) : NULL;
  if (memory) return memory;
  language->ended_early = true;
  const size_t alignment = _Alignof(max_align_t), room = (size + alignment - 1) / alignment * alignment;
  assert(room <= sizeof language->spare);
  if (room > sizeof language->spare - language->spare_used) language->spare_used = 0;
  memory = language->spare + language->spare_used;
  language->spare_used += room;
  return memset(memory, 0, size);
}

const char *language_keep(struct language *language, const char *text, size_t length)
{
  char *kept = language_afford(language, length) ? arena_alloc(language->arena, length, 1) : NULL;
  language->ended_early |= !kept;
  return kept ? memcpy(kept, text, length) : NULL;
}
