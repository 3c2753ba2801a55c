/* `solver NAME { item value ... }`: names, items and ranges come from the tables in algebra/solver.h and scene/method.h. */
#include <float.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "base/number.h"
#include "language/build.h"
#include "language/words.h"

/* The table's names, for errors. */
typedef const char *name_at(size_t index); /* NULL behind the last */

static const char *solver_name(size_t index) { return index < solver_count() ? solver_at(index)->name : NULL; }

static const char *item_name(size_t index) { return index < method_item_count() ? method_item_at(index)->name : NULL; }

/* "a, b or c" */
static void list_names(name_at *name, char *out, size_t size)
{
  size_t used = 0;
  out[0] = '\0';
  for (size_t k = 0; name(k) && used < size; k++) {
    const char *before = k == 0 ? "" : name(k + 1) ? ", " : " or ";
    used += (size_t)snprintf(out + used, size - used, "%s%s", before, name(k));
  }
}

/* Ends the message on an unknown word with a guess, or with what there is, unless that is much. */
static void tell_unknown(struct language *language, struct place place, const char *what, const struct token *word,
                         name_at *name)
{
  const char *best = NULL;
  size_t best_length = 0, distance = words_reach(word->length);
  for (size_t k = 0; name(k); k++)
    words_consider(word->text, word->length, name(k), strlen(name(k)), &best, &best_length, &distance);
  enum { MOST_LISTED = 8 };
  char list[300] = "";
  if (!name(MOST_LISTED)) list_names(name, list, sizeof list);
  if (best) {
    language_error(language, place, "there is no %s '%.*s'; did you mean '%s'?", what, (int)word->length, word->text,
                   best);
  } else {
    language_error(language, place, "there is no %s '%.*s'%s%s", what, (int)word->length, word->text,
                   list[0] ? ", only " : "", list);
  }
}

void solver_begin(struct language *language, struct place place, const struct token *name)
{
  const struct solver *solver = solver_find(name->text, name->length);
  if (!solver) {
    tell_unknown(language, place, "solver", name, solver_name);
    solver = solver_at(0);
  }
  method_default(solver, &language->solver);
}

static const struct method_item *item_named(struct language *language, struct place place, const struct token *name)
{
  for (size_t k = 0; k < method_item_count(); k++) {
    const struct method_item *item = method_item_at(k);
    if (words_compare(name->text, name->length, item->name) == 0) return item;
  }
  tell_unknown(language, place, "solver item", name, item_name);
  return NULL;
}

/* "a, b or c" of the item's words. */
static void list_words(const struct method_item *item, char *out, size_t size)
{
  size_t used = 0;
  out[0] = '\0';
  for (size_t k = 0; item->keywords && item->keywords[k] && used < size; k++) {
    const char *before = k == 0 ? "" : item->keywords[k + 1] ? ", " : " or ";
    used += (size_t)snprintf(out + used, size - used, "%s%s", before, item->keywords[k]);
  }
}

static void tell_wanted(struct language *language, struct place place, const struct method_item *item)
{
  char words[200];
  list_words(item, words, sizeof words);
  if (item->kind == METHOD_ITEM_KEYWORD) {
    language_error(language, place, "%s is %s", item->name, words);
    return;
  }
  const char *number = item->kind == METHOD_ITEM_INTEGER ? "a whole number" : "a number";
  char from[NUMBER_TEXT_SIZE], to[NUMBER_TEXT_SIZE];
  number_write(item->minimum, from);
  number_write(item->maximum, to);
  const char *or = words[0] ? " or " : "";
  if (item->minimum == DBL_MIN) {
    language_error(language, place, "%s is %s%s%s above 0 and up to %s", item->name, words, or, number, to);
  } else if (isfinite(item->maximum)) {
    language_error(language, place, "%s is %s%s%s from %s to %s", item->name, words, or, number, from, to);
  } else {
    language_error(language, place, "%s is %s%s%s of at least %s", item->name, words, or, number, from);
  }
}

static void set_number(struct language *language, const struct method_item *item, struct place place, double value)
{
  const bool whole = item->kind != METHOD_ITEM_INTEGER || value == floor(value);
  if (item->kind == METHOD_ITEM_KEYWORD || !whole || !(value >= item->minimum && value <= item->maximum))
    tell_wanted(language, place, item);
  else item->set(&language->solver, value);
}

void solver_quantity(struct language *language, struct place place, const struct token *name, struct place value_place,
                     const struct value *value)
{
  const struct method_item *item = item_named(language, place, name);
  double number;
  if (item && value_to_number(language, value_place, value, &number)) set_number(language, item, value_place, number);
}

void solver_word(struct language *language, struct place place, const struct token *name, struct place value_place,
                 const struct token *value)
{
  const struct method_item *item = item_named(language, place, name);
  if (!item) return;
  for (size_t k = 0; item->keywords && item->keywords[k]; k++) {
    if (words_compare(value->text, value->length, item->keywords[k]) != 0) continue;
    item->set(&language->solver, (double)k);
    return;
  }
  const struct symbol *symbol = symbol_find(language, value->text, value->length);
  if (symbol && symbol->kind == SYMBOL_VALUE && symbol->value.kind == VALUE_NUMBER) {
    set_number(language, item, value_place, symbol->value.x[0]);
  } else if (!symbol || symbol->kind != SYMBOL_BROKEN) {
    tell_wanted(language, value_place, item);
  }
}

void solver_misplaced(struct language *language, struct place place)
{
  language_error(language, place, "solver stands in global_settings or in a bicubic_patch");
}
