/* Declared names: a hash table of chains. */
#include <stdlib.h>
#include <string.h>

#include "language/build.h"
#include "language/tokens.h"
#include "language/words.h"

enum { BUCKETS = 4096 };

/* FNV-1a. */
static unsigned hash_of(const char *name, size_t length)
{
  unsigned hash = 2166136261u;
  for (size_t k = 0; k < length; k++) hash = (hash ^ (unsigned char)name[k]) * 16777619u;
  return hash;
}

/* The innermost of that name; with `depth` at least 0, only that of that depth. */
static struct symbol *find(const struct language *language, const char *name, size_t length, int depth)
{
  const unsigned hash = hash_of(name, length);
  struct symbol *best = NULL;
  for (struct symbol *s = language->symbols[hash % BUCKETS]; s; s = s->next) {
    if (s->hash != hash || s->length != length || memcmp(s->name, name, length) != 0) continue;
    if (depth >= 0 && s->depth != depth) continue;
    if (!best || s->depth > best->depth) best = s;
  }
  return best;
}

static struct symbol *add(struct language *language, const char *name, size_t length, int depth)
{
  struct symbol *symbol = language_alloc(language, sizeof *symbol);
  if (language->ended_early) return symbol;
  const unsigned hash = hash_of(name, length);
  *symbol = (struct symbol){.next = language->symbols[hash % BUCKETS], .name = name, .length = length, .hash = hash,
                            .depth = depth};
  language->symbols[hash % BUCKETS] = symbol;
  return symbol;
}

bool symbols_create(struct language *language)
{
  static const char name[] = "pscn";
  language->symbols = calloc(BUCKETS, sizeof *language->symbols);
  if (!language->symbols) return false;
  struct symbol *symbol = add(language, name, sizeof name - 1, 0);
  symbol->kind = SYMBOL_VALUE;
  symbol->value = value_of_number(1);
  return !language->ended_early;
}

void symbols_destroy(struct language *language) { free(language->symbols); }

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
  if (depth == 0) return;
  for (size_t b = 0; b < BUCKETS; b++) {
    for (struct symbol **s = &language->symbols[b]; *s;) {
      if ((*s)->depth >= depth) *s = (*s)->next;
      else s = &(*s)->next;
    }
  }
}

/* ---- what is told of names ---- */

void symbols_consider(const struct language *language, const char *word, size_t length, const char **best,
                      size_t *best_length, size_t *distance)
{
  for (size_t b = 0; b < BUCKETS; b++) {
    for (const struct symbol *s = language->symbols[b]; s; s = s->next) {
      if (s->kind != SYMBOL_BEGUN) words_consider(word, length, s->name, s->length, best, best_length, distance);
    }
  }
}

void symbol_unknown(struct language *language, struct place place, const struct token *name, const char *wanted)
{
  const char *best = NULL;
  size_t best_length = 0, distance = words_reach(name->length);
  language->unknown = place;
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
