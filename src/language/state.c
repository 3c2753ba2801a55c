/* Errors and memory of one reading. */
#include "language/state.h"

#include <assert.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include "language/sources.h"

/* At most this many errors of one declaration are reported. */
enum { MOST_HELD = 20 };

bool language_holds_enough(const struct language *language)
{
  return language->declaration && language->declaration->held_count >= MOST_HELD;
}

/* The place for one more held error, or NULL if it is only counted. */
static struct held *hold(struct language *language, struct span place)
{
  struct declaration *declaration = language->declaration;
  language->held_count++;
  const bool enough = language_holds_enough(language);
  declaration->held_count++;
  if (enough) return NULL;
  struct held *held = *declaration->held_end = language_alloc(language, sizeof *held);
  declaration->held_end = &held->next;
  held->place = place;
  return held;
}

void language_hold(struct language *language, struct span place, struct held *of)
{
  struct held *held = hold(language, place);
  if (held) held->of = of;
}

static void tell(struct language *language, struct span place, bool holds, const char *format, va_list arguments)
{
  char message[400];
  struct held *held = holds ? hold(language, place) : NULL;
  if (holds && !held) return;
  const size_t size = 1 + (size_t)vsnprintf(message, sizeof message, format, arguments);
  const size_t kept = size < sizeof message ? size : sizeof message;
  if (held) held->text = memcpy(language_alloc(language, kept), message, kept);
  else diagnostics_error(language->diagnostics, sources_place(language, place), "%s", message);
}

void language_tell(struct language *language, struct span place, const char *format, ...)
{
  va_list arguments;
  va_start(arguments, format);
  tell(language, place, false, format, arguments);
  va_end(arguments);
}

bool language_holds(const struct language *language)
{
  return language->declaration && language->declaration->held_count > 0;
}

void language_error(struct language *language, struct span place, const char *format, ...)
{
  va_list arguments;
  va_start(arguments, format);
  tell(language, place, language_holds(language), format, arguments);
  va_end(arguments);
}

void language_foreign(struct language *language, struct span place, const char *format, ...)
{
  va_list arguments;
  va_start(arguments, format);
  tell(language, place, language->declaration != NULL, format, arguments);
  va_end(arguments);
}

struct block language_block(const struct language *language, struct span place)
{
  return (struct block){place, language->diagnostics->error_count + language->held_count};
}

bool language_sound(const struct language *language, const struct block *block)
{
  return language->diagnostics->error_count + language->held_count == block->errors;
}

void language_error_in(struct language *language, const struct block *block, struct span place, const char *text)
{
  if (language_sound(language, block)) language_error(language, place, "%s", text);
}

void language_limit(struct language *language, struct span place, const char *text)
{
  if (!language->ended_early) {
    diagnostics_error(language->diagnostics, sources_place(language, place), "%s", text);
    language->limit_told = true;
  }
  language->ended_early = true;
}

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
