/* Errors of one reading, and what it leaves out. */
#include "language/errors.h"

#include <stdarg.h>
#include <stdio.h>

#include "language/sources.h"
#include "language/words.h"

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

void language_error(struct language *language, struct span place, const char *format, ...)
{
  va_list arguments;
  if (language->idle > 0) return;
  va_start(arguments, format);
  tell(language, place, format, arguments);
  va_end(arguments);
}

/* ---- what is not supported ---- */

struct left_out {
  struct left_out *before;
  char word[40]; /* POV-Ray's are shorter */
  struct span place;
  size_t times;
};

/* Counts it. Returns how often it has been left out before. */
static size_t leave_out(struct language *language, struct span place, const struct name *name)
{
  struct left_out *left = language->left_out;
  while (left && words_compare(name->text, name->length, left->word) != 0) left = left->before;
  if (!left) {
    left = language_alloc(language, sizeof *left);
    *left = (struct left_out){.before = language->left_out, .place = place};
    snprintf(left->word, sizeof left->word, "%.*s", (int)name->length, name->text);
    if (!language->ended_early) language->left_out = left;
  }
  return left->times++;
}

void language_lacks(struct language *language, struct span place, struct span what)
{
  static const char colour[] = "a transparent colour";
  char where[300] = "";
  if (language->idle > 0) return;
  language->left_out_last = place;
  if (language->declaration) {
    if (span_begin(language->declaration->lacks) == 0) language->declaration->lacks = what;
    return;
  }
  if (place.ends != what.ends) {
    const struct place declared = sources_place(language, what);
    const size_t line = source_locate(declared.source, declared.begin).line; /* recalls the text */
    snprintf(where, sizeof where, " (%s:%zu)", declared.source->name, line);
  }
  struct name name = sources_name(language, what);
  const int token = words_token(name.text, name.length);
  const bool is_word = token != PSCN_TOKEN_WORD, refused = token == PSCN_TOKEN_REFUSED;
  const bool own = token == PSCN_TOKEN_CAMERA || token == PSCN_TOKEN_LIGHT_SOURCE;
  const char *instead = is_word ? words_instead(name.text, name.length) : "rgb <R, G, B>";
  if (!is_word) name.text = colour, name.length = sizeof colour - 1;
  if (leave_out(language, place, &name) > 0 || (language->lenient && !refused)) return;
  language_error(language, place, "%s%.*s%s is not supported%s%s%s",
                 own       ? "a declared "
                 : is_word ? "POV-Ray's "
                           : "",
                 (int)name.length, name.text, where, *instead ? "; use " : "", instead,
                 refused    ? ""
                 : *instead ? ", or --lenient to leave it out"
                            : "; use --lenient to leave it out");
}

void language_tell_left_out(struct language *language)
{
  struct left_out *first = NULL;
  if (!language->lenient) return;
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
