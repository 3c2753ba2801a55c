/* Declared names. */
#include "language/symbols.h"

#include <string.h>

#include "language/hints.h"
#include "language/settings.h"
#include "language/sources.h"
#include "language/tokens.h"

/* From this version on, POV-Ray declares a colour's component as a number. */
#define VERSION_COLOURS 3.5

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

static struct symbol *add(struct language *language, const char *name, size_t length, int depth)
{
  struct symbols *symbols = language->symbols;
  struct symbol *symbol = language_alloc(language, sizeof *symbol);
  const char *kept = language_keep(language, name, length);
  if (language->ended_early) return symbol;
  *symbol = (struct symbol){
    .name = kept, .length = length, .depth = depth, .before = symbols->last, .older = symbols->locals};
  if (!table_add(&symbols->table, language->arena, &symbol->entry, name, length)) language->ended_early = true;
  else if (depth > 0) symbols->locals = symbol;
  symbols->last = symbol;
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
  for (; symbols->locals && symbols->locals->depth >= symbols->depth; symbols->locals = symbols->locals->older)
    forget(symbols, symbols->locals);
  symbols->depth--;
}

const struct symbol *symbol_find(const struct language *language, const char *name, size_t length)
{
  const struct symbol *symbol = find(language->symbols, name, length, -1);
  return symbol && symbol->kind != SYMBOL_BEGUN && symbol->kind != SYMBOL_UNKNOWN ? symbol : NULL;
}

bool symbol_known(struct language *language, const struct name *name)
{
  const struct symbol *symbol = find(language->symbols, name->text, name->length, -1);
  if (symbol && symbol->kind == SYMBOL_FOREIGN && symbol->lost)
    language_tell(language, name->place, "whether '%.*s' is declared depends on what is passed over", (int)name->length,
                  name->text);
  return symbol && symbol->kind != SYMBOL_UNKNOWN;
}

/* ---- what is told of names ---- */

/* The most names that one reading considers for guesses: half a second's work if all are long. And the most guesses for
 * unknown words that declarations hold, which are mostly never reported. */
enum { MOST_CONSIDERED = 100000, MOST_GUESSED = 1000 };

void guess_symbols(struct guess *guess, struct language *language)
{
  struct symbols *symbols = language->symbols;
  const struct symbol *s = symbols->last;
  for (; s && symbols->considered < MOST_CONSIDERED; s = s->before, symbols->considered++)
    if (s->kind != SYMBOL_BEGUN && s->kind != SYMBOL_UNKNOWN && !s->gone) guess_consider(guess, s->name, s->length);
}

/* Counts a name that is missing. Returns how often it was missing before. */
static size_t count_missed(struct language *language, const struct name *name)
{
  struct symbol *symbol = find(language->symbols, name->text, name->length, -1);
  if (!symbol) {
    symbol = add(language, name->text, name->length, 0);
    symbol->kind = SYMBOL_UNKNOWN;
  }
  if (!symbol->missed) {
    symbol->missed = language_alloc(language, sizeof *symbol->missed);
    *symbol->missed = (struct missed){.symbol = symbol, .next = language->symbols->missed};
    language->symbols->missed = symbol->missed;
  }
  symbol->missed->last = name->place;
  return symbol->missed->times++;
}

/* A name that is missing in many places is reported once; how often it is missing is reported at the end. What a
 * declaration holds is not counted, because it may never be reported. */
static void tell_unknown(struct language *language, const struct name *name, const char *wanted)
{
  const bool held = language_holds(language);
  if (language->unknown.ends == name->place.ends) return; /* it has been reported for its letters */
  language->unknown = name->place;
  if (!held && count_missed(language, name) > 0) return;
  const char *file = hint_file(name->text, name->length);
  if (file) {
    language_error(language, name->place, "'%.*s' is not declared: #include \"%s\" declares it", (int)name->length,
                   name->text, file);
    return;
  }
  struct guess guess = guess_begin(name->text, name->length);
  if (!diagnostics_full(language->diagnostics) && /* else the guess would not be read */
      !(held && language->symbols->guessed++ >= MOST_GUESSED)) {
    guess_symbols(&guess, language);
    guess_keywords(&guess);
  }
  if (guess.best) {
    language_error(language, name->place, "unknown word '%.*s'; did you mean '%.*s'?", (int)name->length, name->text,
                   (int)guess.best_length, guess.best);
  } else {
    language_error(language, name->place, "'%.*s' is not declared; %s is wanted here", (int)name->length, name->text,
                   wanted);
  }
}

void symbols_tell_missed(struct language *language)
{
  for (const struct missed *m = language->symbols->missed; m; m = m->next) {
    if (m->times > 1)
      language_error(language, m->last, "'%.*s' is missing here as well, in %zu places in all", (int)m->symbol->length,
                     m->symbol->name, m->times);
  }
}

/* Reports, at the first use of a foreign name, all that its declarations hold. A declaration that uses it holds it
 * instead. */
static void tell_foreign(struct language *language, const struct name *name, struct symbol *symbol)
{
  if (language->declaration) {
    language_hold(language, name->place, symbol->held);
    return;
  }
  language_error(language, name->place, "'%.*s' is declared with what pscn has not, or within it", (int)name->length,
                 name->text);
  struct held *list = symbol->held->told ? NULL : symbol->held, *last = list;
  symbol->held->told = true;
  for (; list; list = list->after) {
    for (const struct held *held = list; held; held = held->next) {
      if (held->of && !held->of->told) {
        held->of->told = true;
        last = last->after = held->of;
      }
      if (held->text) diagnostics_error(language->diagnostics, sources_place(language, held->place), "%s", held->text);
    }
  }
  symbol->kind = SYMBOL_BROKEN;
}

void symbol_mistaken(struct language *language, struct span place, const struct symbol *symbol, const char *wanted)
{
  const char *is = symbol->kind == SYMBOL_OBJECT    ? "an object"
                   : symbol->kind == SYMBOL_TEXTURE ? symbol->texture_kind
                                                    : "a value";
  if (symbol->kind != SYMBOL_MACRO) {
    language_error(language, place, "'%.*s' is %s; %s is wanted here", (int)symbol->length, symbol->name, is, wanted);
    return;
  }
  language->unknown = place;
  language_foreign(language, place, "'%.*s' is a macro, which pscn does not call; write what it stands for",
                   (int)symbol->length, symbol->name);
}

const struct symbol *symbol_wanted(struct language *language, const struct name *name, enum symbol_kind kind,
                                   const char *wanted)
{
  struct symbol *symbol = find(language->symbols, name->text, name->length, -1);
  if (!symbol || symbol->kind == SYMBOL_BEGUN || symbol->kind == SYMBOL_UNKNOWN) tell_unknown(language, name, wanted);
  else if (symbol->kind == kind) return symbol;
  else if (symbol->kind == SYMBOL_FOREIGN) tell_foreign(language, name, symbol);
  else if (symbol->kind != SYMBOL_BROKEN) symbol_mistaken(language, name->place, symbol, wanted);
  return NULL;
}

/* ---- declarations ---- */

/* As in POV-Ray, #local writes to a name of this file, and #declare to the innermost one there is, or else to a global
 * one. Which one is decided before the value is read. A declaration within the first one of its own name hides that
 * one; within a later one, the outer declaration is the last to write. */
static struct symbol *symbol_begin(struct language *language, const struct name *name, bool local)
{
  const int depth = local ? language->symbols->depth : -1;
  struct symbol *symbol = find(language->symbols, name->text, name->length, depth);
  if (symbol && symbol->kind == SYMBOL_UNKNOWN) return symbol->kind = SYMBOL_BEGUN, symbol;
  if (symbol && symbol->kind != SYMBOL_BEGUN) return symbol;
  return add(language, name->text, name->length, local ? depth : 0);
}

int naming_next(struct naming *naming, int token, struct span place)
{
  const int directive = naming->token;
  if (directive == TOKEN_READ && token != 0 && token < TOKEN_INCLUDE && token != ')' && token != PSCN_TOKEN_DECLARE &&
      token != PSCN_TOKEN_LOCAL)
    return token == PSCN_TOKEN_WORD ? PSCN_TOKEN_DECLARE : 0;
  switch (token) {
  case PSCN_TOKEN_DEPRECATED: /* may come before the name */
  case PSCN_TOKEN_ONCE:
  case PSCN_TOKEN_STRING:
  case '(': return 0;
  case PSCN_TOKEN_DECLARE:
  case PSCN_TOKEN_LOCAL:
  case TOKEN_UNDEF:
  case TOKEN_READ: *naming = (struct naming){token, place}; return 0;
  case TOKEN_FOR:
  case TOKEN_FILE: *naming = (struct naming){PSCN_TOKEN_DECLARE, place}; return 0;
  default: naming->token = 0; return token == PSCN_TOKEN_WORD ? directive : 0;
  }
}

void declare_passed(struct language *language, int token, struct span place, struct naming *naming)
{
  const int directive = naming_next(naming, token, place);
  if (token == PSCN_TOKEN_DEFAULT || token == TOKEN_INCLUDE || token == PSCN_TOKEN_VERSION)
    language_tell(language, place, "this stands in what pscn has not, and is passed over");
  if (directive != 0) declare_unseen(language, place, directive == PSCN_TOKEN_LOCAL ? &naming->place : NULL);
}

void declare_unseen(struct language *language, struct span place, const struct span *local)
{
  struct declaration *declaration = declare_begin(language, place, local);
  language_foreign(language, place, "this is declared in what pscn has not, and passed over");
  declaration->symbol->lost = true;
  declare_end(language, declaration);
}

/* POV-Ray loses such a name, or crashes. */
void declare_left_open(struct language *language, struct span end)
{
  for (const struct declaration *d = language->declaration; d; d = d->outer) {
    if (d->symbol->depth < language->symbols->depth) continue;
    language_tell(language, end, "the file ends within the declaration of its #local '%.*s'", (int)d->symbol->length,
                  d->symbol->name);
  }
  const struct declaration *layered = language->layered; /* more layers are expected */
  if (layered && layered->symbol->depth >= language->symbols->depth)
    language_tell(language, end, "the file ends before the ; of its #local '%.*s'", (int)layered->symbol->length,
                  layered->symbol->name);
}

static struct declaration *begin(struct language *language, const struct name *name, bool local)
{
  struct declaration *declaration = language->symbols->ended;
  if (declaration) language->symbols->ended = declaration->outer;
  else declaration = language_alloc(language, sizeof *declaration);
  *declaration = (struct declaration){
    .symbol = symbol_begin(language, name, local), .outer = language->declaration, .held_end = &declaration->held};
  declaration->symbol->lost = false;
  language->layered = NULL;
  return language->declaration = declaration;
}

struct declaration *declare_begin(struct language *language, struct span place, const struct span *local)
{
  const struct name name = sources_name(language, place);
  if (local && !sources_has(language, *local))
    language_tell(language, *local, "a #local stands in one file with its name and =");
  const struct symbol *known = find(language->symbols, name.text, name.length, local ? language->symbols->depth : -1);
  if (known && known->kind == SYMBOL_MACRO && !language->tokens->skipping)
    language_tell(language, place, "'%.*s' is a macro already; #undef it before", (int)name.length, name.text);
  return begin(language, &name, local);
}

struct symbol *declare_end(struct language *language, struct declaration *declaration)
{
  struct symbol *symbol = declaration->symbol;
  language->declaration = declaration->outer;
  if (!declaration->held) return symbol;
  symbol->kind = SYMBOL_FOREIGN;
  symbol->held = declaration->held;
  return NULL;
}

static void symbol_set(struct symbol *symbol, const struct value *value)
{
  symbol->kind = value->kind == VALUE_UNKNOWN ? SYMBOL_BROKEN : SYMBOL_VALUE;
  symbol->value = *value;
}

static bool is_of_name(char c)
{
  return c == '_' || (c >= '0' && c <= '9') || (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z');
}

/* Whether the text at a place begins with a colour's name. */
static bool begins_with_colour(const struct language *language, struct span place)
{
  struct name name = sources_name(language, place);
  const size_t most = name.length;
  for (name.length = 0; name.length < most && is_of_name(name.text[name.length]);) name.length++;
  const struct symbol *symbol = symbol_find(language, name.text, name.length);
  return symbol && symbol->kind == SYMBOL_VALUE && symbol->value.kind == VALUE_COLOUR;
}

/* A value that is only the name of something else declares another name for that. */
void declare_value(struct language *language, struct declaration *declaration, const struct value *value)
{
  if (value->bare)
    language_error(language, value->place, "POV-Ray ends a declaration before the part of a colour; write color first");
  if (language->settings->version < VERSION_COLOURS && (value->kind == VALUE_NUMBER || value->kind == VALUE_VECTOR) &&
      begins_with_colour(language, value->place))
    language_error(
      language, value->place,
      "before version 3.5 what begins with a colour's name is declared as a colour; put this in parentheses");
  struct symbol *symbol = declare_end(language, declaration);
  declaration->outer = language->symbols->ended;
  language->symbols->ended = declaration;
  if (!symbol) return;
  if (value->kind == VALUE_NAMED) {
    const struct symbol *same = value->symbol;
    symbol->kind = same->kind;
    if (same->kind == SYMBOL_OBJECT) symbol->object = same->object;
    else symbol->texture = same->texture, symbol->texture_kind = same->texture_kind;
    return;
  }
  symbol_set(symbol, value);
}

void declare_broken(struct language *language, struct declaration *declaration)
{
  struct symbol *symbol = declare_end(language, declaration);
  if (symbol) symbol->kind = SYMBOL_BROKEN;
}

void declare_macro(struct language *language, const struct name *name, struct macro *macro)
{
  const struct symbol *known = find(language->symbols, name->text, name->length, -1);
  if (known && (known->kind == SYMBOL_VALUE || known->kind == SYMBOL_TEXTURE || known->kind == SYMBOL_OBJECT ||
                (known->kind == SYMBOL_FOREIGN && !known->lost)))
    language_tell(language, name->place, "'%.*s' is declared already, and no macro; #undef it before",
                  (int)name->length, name->text);
  struct symbol *symbol = symbol_begin(language, name, false);
  symbol->kind = SYMBOL_MACRO;
  symbol->macro = macro;
  language->symbols->macro_count++;
}

void declare_lost(struct language *language, const struct name *name)
{
  const struct symbol *known = find(language->symbols, name->text, name->length, -1);
  if (known && known->kind == SYMBOL_FOREIGN && known->lost) return; /* as by an earlier call */
  struct declaration *declaration = begin(language, name, false);
  language_foreign(language, name->place, "'%.*s' is declared by this macro, which is passed over", (int)name->length,
                   name->text);
  declaration->symbol->lost = true;
  declare_end(language, declaration);
}

void declare_gone(struct language *language, const struct name *name)
{
  struct symbol *symbol = find(language->symbols, name->text, name->length, -1);
  if (symbol && symbol->kind != SYMBOL_BEGUN) forget(language->symbols, symbol);
}

void declare_number(struct language *language, const char *name, size_t length, double number)
{
  const struct name word = {.text = name, .length = length};
  symbol_set(symbol_begin(language, &word, false), &(struct value){.x = {number, number, number}});
}
