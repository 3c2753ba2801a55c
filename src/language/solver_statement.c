/* The solver statement. */
#include "language/solver_statement.h"

#include <math.h>
#include <string.h>

#include "language/sources.h"

enum { MOST_NAMES = 64, MOST_LISTED = 8 };

/* Reports an unknown word, with a guess, or with a list of the names there are unless they are many. */
static void tell_unknown(struct language *language, const char *what, const struct name *word,
                         const char *const names[], size_t count)
{
  struct guess guess = guess_begin(word->text, word->length);
  for (size_t k = 0; k < count; k++) guess_consider(&guess, names[k], strlen(names[k]));
  char list[300] = "";
  if (count <= MOST_LISTED) words_list(names, count, list, sizeof list);
  if (guess.best) {
    language_error(language, word->place, "there is no %s '%.*s'; did you mean '%s'?", what, (int)word->length,
                   word->text, guess.best);
  } else {
    language_error(language, word->place, "there is no %s '%.*s'%s%s", what, (int)word->length, word->text,
                   list[0] ? "; use " : "", list);
  }
}

void solver_begin(struct language *language, struct span place)
{
  const struct name name = sources_name(language, place);
  if (language->untrusted) language_error(language, place, "a scene may not choose a solver (--untrusted)");
  const struct solver *solver = solver_find(name.text, name.length);
  if (!solver) {
    const char *names[MOST_NAMES];
    size_t count = 0;
    for (; count < solver_count() && count < MOST_NAMES; count++) names[count] = solver_at(count)->name;
    tell_unknown(language, "solver", &name, names, count);
    solver = solver_at(0);
  }
  language->method = language_alloc(language, sizeof *language->method);
  method_default(solver, language->method);
  language->method_name = place, language->method_items = 0;
}

const struct method_item *solver_item_find(const struct name *word)
{
  const struct method_item *item;
  for (size_t k = 0; (item = method_item_at(k)) != NULL; k++)
    if (words_compare(word->text, word->length, item->name) == 0) break;
  return item;
}

static const struct method_item *item_named(struct language *language, struct span place)
{
  const struct name name = sources_name(language, place);
  const struct method_item *item = solver_item_find(&name);
  const char *names[MOST_NAMES];
  size_t count = 0;
  for (; method_item_at(count) && count < MOST_NAMES; count++) names[count] = method_item_at(count)->name;
  if (!item) tell_unknown(language, "solver item", &name, names, count);
  return item;
}

static void tell_wanted(struct language *language, struct span place, const struct method_item *item)
{
  char words[200], range[RANGE_TEXT_SIZE] = "";
  size_t count = 0;
  while (item->keywords && item->keywords[count]) count++;
  words_list(item->keywords, count, words, sizeof words);
  if (item->kind != METHOD_ITEM_KEYWORD)
    range_text(item->minimum, item->maximum, item->kind == METHOD_ITEM_INTEGER, range);
  language_error(language, place, "%s must be %s%s%s", item->name, words, words[0] && range[0] ? " or " : "", range);
}

/* Sets an item. Those behind it in the table that it sets as well (`form paper` does) must not stand before it. */
static void set_item(struct language *language, const struct method_item *item, struct span place, double value)
{
  const struct method before = *language->method;
  item->set(language->method, value);
  const size_t index = (size_t)(item - method_item_at(0));
  for (size_t k = index + 1; k < method_item_count(); k++) {
    const struct method_item *other = method_item_at(k);
    if ((language->method_items >> k & 1) && other->get(&before) != other->get(language->method))
      language_error(language, place, "%s sets %s as well; write it before %s", item->name, other->name, other->name);
  }
  language->method_items |= 1u << index;
}

static void set_number(struct language *language, const struct method_item *item, struct span place, double value)
{
  const bool whole = item->kind != METHOD_ITEM_INTEGER || value == floor(value);
  if (item->kind == METHOD_ITEM_KEYWORD || !whole || !(value >= item->minimum && value <= item->maximum))
    tell_wanted(language, place, item);
  else set_item(language, item, place, value);
}

void solver_quantity(struct language *language, struct span name, const struct value *value)
{
  const struct method_item *item = item_named(language, name);
  double number;
  if (item && value_to_number(language, value, &number)) set_number(language, item, value->place, number);
}

void solver_word(struct language *language, struct span name, struct span place)
{
  const struct name value = sources_name(language, place);
  const struct method_item *item = item_named(language, name);
  if (!item) return;
  for (size_t k = 0; item->keywords && item->keywords[k]; k++) {
    if (words_compare(value.text, value.length, item->keywords[k]) != 0) continue;
    set_item(language, item, name, (double)k);
    return;
  }
  const struct value *named = symbol_find(language, value.text, value.length);
  if (named && named->kind == VALUE_NUMBER) set_number(language, item, place, named->x[0]);
  else if (!named || named->kind != VALUE_UNKNOWN) tell_wanted(language, place, item);
}

void solver_misplaced(struct language *language, struct span place)
{
  language_error(language, place, "solver must be in global_settings or in a bicubic_patch");
}
