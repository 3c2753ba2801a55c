/* Declared names, and their declarations. */
#include "language/symbols.h"

#include <math.h>
#include <string.h>

#include "language/sources.h"
#include "language/textures.h"
#include "language/tokens.h"
#include "language/values.h"

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
  const struct frame *frame = language->sources->frame;
  const bool stays = frame && frame->macro; /* a macro's text does, and may declare names again and again */
  const char *kept = stays ? name->text : language_keep(language, name->text, name->length);
  struct symbol **list = depth > 0 ? &symbols->locals : &symbols->globals;
  *symbol = (struct symbol){
    .name = kept, .length = name->length, .depth = depth, .before = *list, .own.kind = VALUE_NONE};
  symbol->value = &symbol->own;
  if (!table_add(&symbols->table, language->arena, &symbol->entry, name->text, name->length))
    language_end(language, STATUS_LIMIT);
  return *list = symbol;
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

/* ---- #declare and #local ---- */

/* The file ends, and POV-Ray loses such a name, or crashes. */
void declare_left_open(struct language *language, struct span end)
{
  for (const struct declaration *d = language->declaration; d; d = d->outer) {
    if (d->depth == 0 || d->depth < language->symbols->depth) continue;
    const struct name name = sources_name(language, d->name);
    language_tell(language, end, "the file ends within the declaration of its #local '%.*s'", (int)name.length,
                  name.text);
  }
}

static struct declaration *open_declaration(struct language *language, const struct declaration *declaration)
{
  struct declaration *open = &language->tokens->own->declaration;
  *open = *declaration;
  open->frame = language->sources->frame;
  open->braces = language->tokens->depth;
  open->outer = language->declaration;
  language->layered = NULL;
  return language->declaration = open;
}

struct declaration *declare_begin(struct language *language, struct value *target, const struct span *local)
{
  const struct name name = sources_name(language, target->place);
  if (local && !sources_has(language, *local))
    language_tell(language, *local, "#local, its name and the = must be in one file");
  const struct symbol *symbol = symbol_begin(language, &name, local != NULL);
  struct value *to = symbol->value;
  if (target->next) to = array_element(language, to, target);
  else if (to->kind == VALUE_MACRO)
    language_tell(language, name.place, "'%.*s' is a macro already; #undef it first", (int)name.length, name.text);
  value_last_of_list(language, target);
  return open_declaration(language, &(struct declaration){.to = to ? to : value_of(language, VALUE_UNKNOWN, name.place),
                                                          .name = name.place,
                                                          .depth = symbol->depth});
}

void declare_again(struct language *language, struct value *value)
{
  struct declaration *open = open_declaration(language, &(struct declaration){.to = value});
  open->lacks = value->lacks;
}

void declare_value(struct language *language, struct declaration *declaration, const struct value *value)
{
  if (value->kind >= VALUE_MACRO) symbol_mistaken(language, value, "a value");
  struct value *to = declaration->to;
  const bool lacks = span_begin(declaration->lacks) > 0 && !language->lenient;
  if (value->kind >= VALUE_MACRO || lacks) *to = (struct value){.kind = VALUE_UNKNOWN};
  else value_set(language, to, value);
  to->lacks = declaration->lacks;
  language->declaration = declaration->outer;
  language->declared++;
}

void declare_open(struct language *language, struct declaration *declaration, const struct value *value)
{
  const struct name name = sources_name(language, language->tokens->last.place);
  if (value->kind <= VALUE_COLOUR)
    language_tell(language, name.place,
                  name.length ? "unexpected '%.*s', expected ';'" : "the text ends here%.*s, expected ';'",
                  (int)name.length, name.text);
  declare_value(language, declaration, value);
}

void declare_broken(struct language *language, struct declaration *declaration)
{
  declare_value(language, declaration, &(struct value){.kind = VALUE_UNKNOWN});
}

void declare_number(struct language *language, const char *name, size_t length, double number)
{
  const struct name word = {.text = name, .length = length};
  value_set_number(symbol_begin(language, &word, false)->value, number);
}
