/* Declared names. */
#include <string.h>

#include "language/build.h"
#include "language/tokens.h"
#include "language/words.h"

/* The innermost of that name; with `depth` at least 0, only that of that depth. */
static struct symbol *find(const struct language *language, const char *name, size_t length, int depth)
{
  struct symbol *best = NULL;
  struct table_entry *entry = table_find(&language->symbols, table_hash(name, length));
  for (; entry; entry = table_next(entry)) {
    struct symbol *s = (struct symbol *)entry;
    if (s->length != length || memcmp(s->name, name, length) != 0) continue;
    if (depth >= 0 && s->depth != depth) continue;
    if (!best || s->depth > best->depth) best = s;
  }
  return best;
}

static struct symbol *add(struct language *language, const char *name, size_t length, int depth)
{
  struct symbol *symbol = language_alloc(language, sizeof *symbol);
  *symbol = (struct symbol){.name = name, .length = length, .depth = depth};
  if (language->ended_early) return symbol;
  if (!table_add(&language->symbols, language->arena, &symbol->entry, table_hash(name, length))) {
    language->ended_early = true;
  } else if (depth > 0) {
    symbol->older = language->locals;
    language->locals = symbol;
  }
  return symbol;
}

bool symbols_create(struct language *language)
{
  static const char name[] = "pscn";
  struct symbol *symbol = add(language, name, sizeof name - 1, 0);
  symbol->kind = SYMBOL_VALUE;
  symbol->value = value_of_number(1);
  return !language->ended_early;
}

const struct symbol *symbol_find(const struct language *language, const char *name, size_t length)
{
  const struct symbol *symbol = find(language, name, length, -1);
  return symbol && symbol->kind != SYMBOL_BEGUN ? symbol : NULL;
}

bool symbol_known(const struct language *language, const char *name, size_t length)
{
  return find(language, name, length, -1) != NULL;
}

void symbols_leave(struct language *language, int depth)
{
  for (; language->locals && language->locals->depth >= depth; language->locals = language->locals->older)
    table_remove(&language->symbols, &language->locals->entry);
}

/* ---- what is told of names ---- */

void symbols_consider(const struct language *language, const char *word, size_t length, const char **best,
                      size_t *best_length, size_t *distance)
{
  for (size_t k = 0; k < language->symbols.size; k++) {
    for (const struct table_entry *entry = language->symbols.heads[k]; entry; entry = entry->next) {
      const struct symbol *s = (const struct symbol *)entry;
      if (s->kind != SYMBOL_BEGUN) words_consider(word, length, s->name, s->length, best, best_length, distance);
    }
  }
}

void symbol_unknown(struct language *language, struct place place, const struct token *name, const char *wanted)
{
  const char *best = NULL;
  size_t best_length = 0, distance = words_reach(name->length);
  language->unknown = place;
  if (diagnostics_full(language->diagnostics)) distance = 0; /* nobody would read the guess */
  symbols_consider(language, name->text, name->length, &best, &best_length, &distance);
  keywords_consider(name->text, name->length, &best, &best_length, &distance);
  if (best) {
    language_error(language, place, "unknown word '%.*s'; did you mean '%.*s'?", (int)name->length, name->text,
                   (int)best_length, best);
  } else {
    language_error(language, place, "'%.*s' is not declared; %s is wanted here", (int)name->length, name->text, wanted);
  }
}

void symbol_mistaken(struct language *language, struct place place, const struct symbol *symbol, const char *wanted)
{
  const char *is = "a value";
  if (symbol->kind == SYMBOL_OBJECT) is = "an object";
  if (symbol->kind == SYMBOL_TEXTURE) {
    is = symbol->texture->block == TEXTURE_ALL       ? "a texture"
         : symbol->texture->block == TEXTURE_PIGMENT ? "a pigment"
                                                     : "a finish";
  }
  language_error(language, place, "'%.*s' is %s; %s is wanted here", (int)symbol->length, symbol->name, is, wanted);
}

/* ---- declarations ---- */

/* As in POV-Ray: #local writes to a name of this file, #declare to the innermost there is, or else to one that belongs
 * to all. Which one is settled before the value is read: a declaration within the first one of its own name hides
 * that, within a later one the outer one is the last to write. */
struct symbol *declare_begin(struct language *language, const struct token *name, bool local)
{
  const int depth = local ? language->include_depth : -1;
  struct symbol *symbol = find(language, name->text, name->length, depth);
  if (symbol && symbol->kind != SYMBOL_BEGUN) return symbol;
  return add(language, name->text, name->length, local ? depth : 0);
}

/* A value that is but the name of something else declares another name for it. */
void declare_value(struct symbol *symbol, const struct value *value)
{
  if (value->kind == VALUE_NAMED) {
    symbol->kind = value->symbol->kind;
    symbol->object = value->symbol->object;
    symbol->texture = value->symbol->texture;
    return;
  }
  symbol->kind = value->kind == VALUE_UNKNOWN ? SYMBOL_BROKEN : SYMBOL_VALUE;
  symbol->value = *value;
}

void declare_object(struct language *language, struct symbol *symbol, struct node *object)
{
  if (!object->sharing) object->sharing = language_alloc(language, sizeof *object->sharing);
  symbol->kind = SYMBOL_OBJECT;
  symbol->object = object;
}

/* A declared block is whole: what it leaves open has the default. */
void declare_texture(struct language *language, struct symbol *symbol, const struct texture *texture)
{
  struct texture *whole = language_alloc(language, sizeof *whole);
  *whole = *texture;
  whole->set = texture->block;
  symbol->kind = SYMBOL_TEXTURE;
  symbol->texture = whole;
}

void declare_broken(struct symbol *symbol) { symbol->kind = SYMBOL_BROKEN; }
