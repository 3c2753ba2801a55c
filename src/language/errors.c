/* The words of syntax errors. */
#include <stdio.h>
#include <string.h>

#include "language/build.h"
#include "language/tokens.h"
#include "language/words.h"

struct place language_span(const struct place *first, const struct place *last)
{
  if (first->source != last->source || last->end < first->begin) return *first;
  return (struct place){first->source, first->begin, last->end};
}

static bool is_one_of(const char *name, const char *const list[])
{
  for (; *list; list++)
    if (strcmp(name, *list) == 0) return true;
  return false;
}

static bool contains(const char *const names[], int count, const char *wanted)
{
  for (int k = 0; k < count; k++)
    if (strcmp(names[k], wanted) == 0) return true;
  return false;
}

/* Says in few words what could have stood there: a value instead of all that may begin one; no operators, commas and
 * directives, which may stand nearly everywhere. Empty where still too much is left to be of help. */
static void list_expected(const char *const expected[], int count, char *out, size_t size)
{
  enum { MOST_LISTED = 10 };
  static const char *const in_values[] = {"a number",    "a vector",     "x",   "y",   "z",   "pi",
                                          "image_width", "image_height", "'('", "'<'", "'+'", "'-'",
                                          "rgb",         "color",        NULL};
  static const char *const anywhere[] = {"'+'", "'-'", "'*'", "'/'", "'.'", "','", "#declare", "#local", "#version",
                                         "the end of the text", NULL};
  const char *list[MOST_LISTED];
  int listed = 0;
  const bool value = contains(expected, count, "image_width"), objects = contains(expected, count, "object");
  if (value) list[listed++] = "a value";
  for (int k = 0; k < count; k++) {
    if (value && (is_one_of(expected[k], in_values) || strcmp(expected[k], "a name") == 0)) continue;
    if (count > 1 && is_one_of(expected[k], anywhere)) continue;
    if (objects && strcmp(expected[k], "solver") == 0) continue; /* understood there, but never right */
    if (listed == MOST_LISTED) return;
    list[listed++] = expected[k];
  }
  size_t used = 0;
  for (int k = 0; k < listed && used < size; k++) {
    const char *before = k == 0 ? ", expected " : k + 1 == listed ? " or " : ", ";
    used += (size_t)snprintf(out + used, size - used, "%s%s", before, list[k]);
  }
}

/* The nearest of what the grammar could have gone on with, or else of all words and names. */
static const char *guess(const struct language *language, const char *word, size_t length, const char *const expected[],
                         int count, size_t *out_length)
{
  const char *best = NULL;
  size_t distance = words_reach(length);
  for (int k = 0; k < count; k++) {
    if (expected[k][0] == '\'' || strncmp(expected[k], "a ", 2) == 0) continue;
    words_consider(word, length, expected[k], strlen(expected[k]), &best, out_length, &distance);
  }
  if (best) return best;
  keywords_consider(word, length, &best, out_length, &distance);
  symbols_consider(language, word, length, &best, out_length, &distance);
  return best;
}

static void tell_foreign(struct language *language, struct place place, const char *word, int length)
{
  if (words_foreign_shape(word, (size_t)length)) {
    language_error(language, place, "%.*s is POV-Ray, but pscn renders bicubic_patch only", length, word);
  } else {
    language_error(language, place, "%.*s is POV-Ray, but pscn has no %.*s", length, word, length, word);
  }
}

void language_unexpected(struct language *language, struct place place, bool is_word, const char *const expected[],
                         int count)
{
  enum { LONGEST_SHOWN = 40 };
  const bool told = place.source == language->told.source && place.begin == language->told.begin;
  /* What follows a word just told to be unknown fits the word that was meant. */
  const bool follows = language->unknown.source && language->previous.source == language->unknown.source &&
                       language->previous.begin == language->unknown.begin;
  if (told || follows || language->ended_early) return;
  language->told = place;
  const size_t length = place.end - place.begin;
  const int shown = length < LONGEST_SHOWN ? (int)length : LONGEST_SHOWN;
  const char *text = place.source->text + place.begin;
  if (length == 0 && language->depth > 0) {
    language_error(language, language->braces[language->depth - 1], "this brace is not closed");
    return;
  }
  if (language->last.token == PSCN_TOKEN_FOREIGN) {
    tell_foreign(language, place, text, shown);
    return;
  }
  char list[300] = "";
  list_expected(expected, count, list, sizeof list);
  if (is_word) {
    size_t best_length = 0;
    const bool declared = symbol_find(language, text, length) != NULL;
    const char *best = declared ? NULL : guess(language, text, length, expected, count, &best_length);
    if (best) {
      language_error(language, place, "unknown word '%.*s'; did you mean '%.*s'?", shown, text, (int)best_length, best);
    } else {
      language_error(language, place, "%s '%.*s'%s", declared ? "unexpected name" : "unknown word", shown, text, list);
    }
    return;
  }
  if (length == 0) language_error(language, place, "the text ends here%s", list);
  else language_error(language, place, "unexpected '%.*s'%s", shown, text, list);
}
