/* Errors and memory of one reading. */
#include "language/state.h"

#include <assert.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

struct place language_span(const struct place *first, const struct place *last)
{
  if (first->source != last->source || last->end < first->begin) return *first;
  return (struct place){first->source, first->begin, last->end};
}

void language_error(struct language *language, struct place place, const char *format, ...)
{
  char message[400];
  va_list arguments;
  va_start(arguments, format);
  vsnprintf(message, sizeof message, format, arguments);
  va_end(arguments);
  diagnostics_error(language->diagnostics, place, "%s", message);
}

struct block language_block(const struct language *language, struct place place)
{
  return (struct block){place, language->diagnostics->error_count};
}

bool language_sound(const struct language *language, const struct block *block)
{
  return language->diagnostics->error_count == block->errors;
}

void language_error_in(struct language *language, const struct block *block, struct place place, const char *text)
{
  if (language_sound(language, block)) language_error(language, place, "%s", text);
}

void language_limit(struct language *language, struct place place, const char *text)
{
  if (!language->ended_early) language_error(language, place, "%s", text);
  language->ended_early = true;
}

bool language_afford(struct language *language, size_t bytes)
{
  language->unaffordable |= bytes > language->max_memory - language->memory_bytes;
  if (!language->unaffordable) language->memory_bytes += bytes;
  return !language->unaffordable;
}

/* Where memory is short a spare block stands in, and reading ends at the next token; the few blocks wanted until
 * then do not overlap. */
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
