/* Declared names. */
#include "language/symbols.h"

#include <math.h>
#include <string.h>

#include "language/sources.h"
#include "language/textures.h"

/* The innermost symbol of that name; if `depth` is at least 0, only one of that depth. */
static struct symbol *find(const struct symbols *symbols, const char *name, size_t length, int depth)
{
  struct symbol *best = NULL;
  struct table_entry *entry = table_find(&symbols->table, name, length);
  for (; entry; entry = entry->older) {
    struct symbol *s = (struct symbol *)entry;
    if (s->length != length || memcmp(s->name, name, length) != 0) continue;
    if (depth >= 0 && s->depth != depth) continue;
    if (!best || s->depth > best->depth) best = s;
  }
  return best;
}

static struct symbol *add(struct language *language, const struct name *name, int depth)
{
  struct symbols *symbols = language->symbols;
  struct symbol *symbol = symbols->unused;
  if (symbol) symbols->unused = symbol->before;
  else symbol = language_alloc(language, sizeof *symbol);
  const char *kept = sources_stays(language) ? name->text : language_keep(language, name->text, name->length);
  if (language->ended_early) return symbol->value = &symbol->own, symbol;
  struct symbol **list = depth > 0 ? &symbols->locals : &symbols->globals;
  *symbol = (struct symbol){
    .name = kept, .length = name->length, .depth = depth, .before = *list, .own.kind = VALUE_NONE};
  symbol->value = &symbol->own;
  if (!table_add(&symbols->table, language->arena, &symbol->entry, name->text, name->length))
    language->ended_early = true;
  else *list = symbol;
  return symbol;
}

void symbols_enter(struct symbols *symbols) { symbols->depth++; }

/* Undeclares a name. Values that were made with it keep their meaning. */
static void forget(struct symbols *symbols, struct symbol *symbol)
{
  if (!symbol->gone) table_remove(&symbols->table, &symbol->entry);
  symbol->gone = true;
}

void symbols_leave(struct symbols *symbols)
{
  while (symbols->locals && symbols->locals->depth >= symbols->depth) {
    struct symbol *symbol = symbols->locals;
    forget(symbols, symbol);
    symbols->locals = symbol->before;
    symbol->before = symbols->unused;
    symbols->unused = symbol;
  }
  symbols->depth--;
}

const struct symbol *symbol_of(const struct language *language, const char *name, size_t length)
{
  const struct symbol *symbol = find(language->symbols, name, length, -1);
  return symbol && symbol->value->kind != VALUE_NONE ? symbol : NULL;
}

struct value *symbol_find(const struct language *language, const char *name, size_t length)
{
  const struct symbol *symbol = symbol_of(language, name, length);
  return symbol ? symbol->value : NULL;
}

bool symbol_known(const struct language *language, const struct name *name)
{
  return find(language->symbols, name->text, name->length, -1) != NULL;
}

/* ---- what is reported of names ---- */

/* The most names that one reading considers for guesses: half a second's work if all are long. */
enum { MOST_CONSIDERED = 100000 };

void guess_symbols(struct guess *guess, struct language *language)
{
  struct symbols *symbols = language->symbols;
  const struct symbol *lists[] = {symbols->locals, symbols->globals};
  for (int k = 0; k < 2; k++) {
    const struct symbol *s = lists[k];
    for (; s && symbols->considered < MOST_CONSIDERED; s = s->before, symbols->considered++)
      if (!s->gone && s->value->kind < VALUE_NONE) guess_consider(guess, s->name, s->length);
  }
}

/* A name is reported once. */
static void tell_unknown(struct language *language, const struct name *name, const char *wanted)
{
  language->unknown = name->place;
  if (language->idle > 0) return;
  struct guess guess = guess_begin(name->text, name->length);
  if (!diagnostics_full(language->diagnostics)) { /* else the guess would not be read */
    guess_symbols(&guess, language);
    if (name->text[0] > 'Z') guess_keywords(&guess);
  }
  if (guess.best)
    language_error(language, name->place, "unknown word '%.*s'; did you mean '%.*s'?", (int)name->length, name->text,
                   (int)guess.best_length, guess.best);
  else
    language_error(language, name->place, "'%.*s' is not declared; expected %s%s", (int)name->length, name->text,
                   wanted, strcmp(wanted, "a colour") == 0 ? "; colors.inc declares POV-Ray's" : "");
  symbol_begin(language, name, false)->value->kind = VALUE_UNKNOWN;
}

static const char *kind_name(const struct value *value)
{
  switch (value->kind) {
  case VALUE_NUMBER: return "a number";
  case VALUE_VECTOR: return "a vector";
  case VALUE_COLOUR: return "a colour";
  case VALUE_STRING: return "a string";
  case VALUE_ARRAY: return "an array";
  case VALUE_TEXTURE: return texture_kind(value->texture);
  case VALUE_TRANSFORM: return "a transform";
  case VALUE_OBJECT: return "an object";
  default: return "a macro";
  }
}

void symbol_lacks(struct language *language, const struct value *value)
{
  if (span_begin(value->lacks) > 0) language_lacks(language, value->place, value->lacks);
}

void symbol_mistaken(struct language *language, const struct value *value, const char *wanted)
{
  if (value->kind == VALUE_UNKNOWN) {
    symbol_lacks(language, value);
    return;
  }
  const struct name name = sources_name(language, value->place);
  if (value->kind == VALUE_NONE && !value->named) tell_unknown(language, &name, wanted);
  else if (value->kind == VALUE_NONE) language_error(language, value->place, "this element of the array has no value");
  else if (value->named)
    language_error(language, value->place, "'%.*s' is %s; expected %s", (int)name.length, name.text, kind_name(value),
                   wanted);
  else language_error(language, value->place, "expected %s, not %s", wanted, kind_name(value));
}

/* ---- writing them ---- */

/* As in POV-Ray, #local writes to a name of this file or macro, and #declare to the innermost one there is, or else to a
 * global one. Which one is decided before the value is read. A declaration within the first one of its own name hides
 * that one; within a later one, the outer declaration is the last to write. */
struct symbol *symbol_begin(struct language *language, const struct name *name, bool local)
{
  const int depth = local ? language->symbols->depth : -1;
  struct symbol *symbol = find(language->symbols, name->text, name->length, depth);
  if (!symbol || symbol->value->kind == VALUE_NONE) symbol = add(language, name, local ? language->symbols->depth : 0);
  return symbol;
}

void symbol_parameter(struct language *language, const struct name *name, const struct value *argument)
{
  struct symbol *symbol = add(language, name, language->symbols->depth);
  symbol->own = *argument;
  symbol->own.named = symbol->own.next = NULL;
  if (argument->named) symbol->value = argument->named;
}

void symbol_gone(struct language *language, const struct name *name)
{
  struct symbol *symbol = find(language->symbols, name->text, name->length, -1);
  if (symbol) forget(language->symbols, symbol);
}
