/* `solver NAME { item value ... }`: names, items and ranges come from the tables in algebra/solver.h. */
#include <math.h>
#include <string.h>

#include "language/build.h"
#include "language/words.h"

/* Ends the message on an unknown word with a guess, or with what there is. */
static void tell_unknown(struct language *language, struct place place, const char *what, const struct token *word,
                         const char *best)
{
  if (best) language_error(language, place, "there is no %s '%.*s'; did you mean '%s'?", what, (int)word->length, word->text, best);
  else language_error(language, place, "there is no %s '%.*s'", what, (int)word->length, word->text);
}

void solver_begin(struct language *language, struct place place, const struct token *name)
{
  language->solver_place = place;
  const struct solver *solver = solver_find(name->text, name->length);
  if (!solver) {
    const char *best = NULL;
    size_t distance = words_reach(name->length);
    for (size_t k = 0; k < solver_count(); k++) words_consider(name->text, name->length, solver_at(k)->name, &best, &distance);
    tell_unknown(language, place, "solver", name, best);
    solver = solver_at(0);
  }
  solver_options_default(solver, &language->solver);
}

static const struct solver_item *item_named(struct language *language, struct place place, const struct token *name)
{
  const char *best = NULL;
  size_t distance = words_reach(name->length);
  for (size_t k = 0; k < solver_item_count(); k++) {
    const struct solver_item *item = solver_item_at(k);
    if (strlen(item->name) == name->length && memcmp(item->name, name->text, name->length) == 0) return item;
    words_consider(name->text, name->length, item->name, &best, &distance);
  }
  tell_unknown(language, place, "solver item", name, best);
  return NULL;
}

/* "a, b or c" of the item's words. */
static void list_words(const struct solver_item *item, char *out, size_t size)
{
  size_t used = 0;
  out[0] = '\0';
  for (size_t k = 0; item->keywords && item->keywords[k]; k++) {
    const char *part = k == 0 ? "" : item->keywords[k + 1] ? ", " : " or ";
    const size_t length = strlen(part) + strlen(item->keywords[k]);
    if (used + length + 1 > size) return;
    strcpy(out + used, part);
    strcat(out + used, item->keywords[k]);
    used += length;
  }
}

static void tell_wanted(struct language *language, struct place place, const struct solver_item *item)
{
  char words[200];
  list_words(item, words, sizeof words);
  if (item->kind == SOLVER_ITEM_KEYWORD) {
    language_error(language, place, "%s is %s", item->name, words);
    return;
  }
  const char *number = item->kind == SOLVER_ITEM_INTEGER ? "a whole number" : "a number";
  if (isfinite(item->maximum))
    language_error(language, place, "%s is %s%s%s from %g to %g", item->name, words, words[0] ? " or " : "", number,
                   item->minimum, item->maximum);
  else language_error(language, place, "%s is %s%s%s of at least %g", item->name, words, words[0] ? " or " : "", number, item->minimum);
}

void solver_number(struct language *language, struct place place, const struct token *name, struct place value_place, double value)
{
  const struct solver_item *item = item_named(language, place, name);
  if (!item) return;
  const bool whole = item->kind != SOLVER_ITEM_INTEGER || value == floor(value);
  if (item->kind == SOLVER_ITEM_KEYWORD || !whole || !(value >= item->minimum && value <= item->maximum))
    tell_wanted(language, value_place, item);
  else item->set(&language->solver, value);
}

void solver_word(struct language *language, struct place place, const struct token *name, struct place value_place,
                 const struct token *value)
{
  const struct solver_item *item = item_named(language, place, name);
  if (!item) return;
  for (size_t k = 0; item->keywords && item->keywords[k]; k++) {
    if (strlen(item->keywords[k]) != value->length || memcmp(item->keywords[k], value->text, value->length) != 0) continue;
    item->set(&language->solver, (double)k);
    return;
  }
  tell_wanted(language, value_place, item);
}

void solver_statement(struct language *language, struct place place)
{
  if (!language->solver_only) language_error(language, place, "solver stands in global_settings or in an object");
}
