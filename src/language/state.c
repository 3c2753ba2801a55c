/* Errors and memory of one reading. */
#include "language/state.h"

#include <assert.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include "language/sources.h"

enum { MOST_AROUND = 8 };

static void tell(struct language *language, struct span place, const char *format, va_list arguments)
{
  char message[400];
  struct diagnostics_around around[MOST_AROUND];
  struct diagnostics *diagnostics = language->diagnostics;
  vsnprintf(message, sizeof message, format, arguments);
  const size_t count = language->sources->again > 0 ? sources_around(language, around, MOST_AROUND) : 0;
  const size_t shown = count < MOST_AROUND ? count : MOST_AROUND;
  diagnostics->around = around + MOST_AROUND - shown;
  diagnostics->around_count = shown;
  diagnostics_error(diagnostics, sources_place(language, place), "%s", message);
  diagnostics->around_count = 0;
}

void language_tell(struct language *language, struct span place, const char *format, ...)
{
  va_list arguments;
  va_start(arguments, format);
  tell(language, place, format, arguments);
  va_end(arguments);
}

bool language_idle(const struct language *language)
{
  return language->idle > 0 ||
         (!language->lenient && language->declaration && span_begin(language->declaration->lacks) > 0);
}

void language_error(struct language *language, struct span place, const char *format, ...)
{
  va_list arguments;
  if (language_idle(language)) return;
  va_start(arguments, format);
  tell(language, place, format, arguments);
  va_end(arguments);
}

/* ---- what pscn lacks ---- */

struct left_out {
  struct left_out *before;
  char word[40]; /* POV-Ray's are shorter */
  struct span place;
  size_t times;
};

static void leave_out(struct language *language, const struct name *name)
{
  struct left_out *left = language->left_out;
  while (left && words_compare(name->text, name->length, left->word) != 0) left = left->before;
  if (!left) {
    left = language_alloc(language, sizeof *left);
    *left = (struct left_out){.before = language->left_out, .place = name->place};
    snprintf(left->word, sizeof left->word, "%.*s", (int)name->length, name->text);
    if (!language->ended_early) language->left_out = left;
  }
  left->times++;
}

void language_left_out(struct language *language, struct span place)
{
  const struct name name = sources_name(language, place);
  if (language->declaration) language->declaration->lacks = place;
  else leave_out(language, &name);
}

void language_lacks(struct language *language, struct span place, const struct name *what, const char *instead)
{
  if (language_idle(language)) return;
  language->left_out_last = place;
  if (language->declaration) language->declaration->lacks = place;
  else if (language->lenient) leave_out(language, what);
  else
    language_error(language, place, "%.*s is not supported%s%s; --lenient leaves it out", (int)what->length, what->text,
                   *instead ? ": " : "", instead);
}

void language_lacks_word(struct language *language, struct span place)
{
  const struct name name = sources_name(language, place);
  language_lacks(language, place, &name, words_instead(name.text, name.length));
}

void language_refuses(struct language *language, struct span place)
{
  const struct name name = sources_name(language, place);
  const char *instead = words_instead(name.text, name.length);
  if (language->declaration && !language_idle(language)) language->declaration->lacks = place;
  else
    language_error(language, place, "%.*s is not supported%s%s", (int)name.length, name.text, *instead ? ": " : "",
                   instead);
}

void language_tell_left_out(struct language *language)
{
  struct left_out *first = NULL;
  for (struct left_out *left = language->left_out, *before; left; left = before)
    before = left->before, left->before = first, first = left;
  for (const struct left_out *left = first; left; left = left->before) {
    char times[40] = "";
    if (left->times > 1) snprintf(times, sizeof times, ", in %zu places", left->times);
    diagnostics_warning(language->diagnostics, sources_place(language, left->place), "%s is left out%s", left->word,
                        times);
  }
}

struct block language_block(const struct language *language, struct span place)
{
  return (struct block){place, language->diagnostics->error_count};
}

bool language_sound(const struct language *language, const struct block *block)
{
  return language->diagnostics->error_count == block->errors;
}

void language_error_in(struct language *language, const struct block *block, struct span place, const char *text)
{
  if (language_sound(language, block)) language_error(language, place, "%s", text);
}

void language_limit(struct language *language, struct span place, const char *text)
{
  if (!language->ended_early) {
    language_tell(language, place, "%s", text);
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
