/* Declared names: a hash table of chains, the innermost local first. */
#include <stdlib.h>
#include <string.h>

#include "language/build.h"
#include "language/words.h"

enum { BUCKETS = 4096 };

bool symbols_create(struct language *language)
{
  language->symbols = calloc(BUCKETS, sizeof *language->symbols);
  return language->symbols != NULL;
}

void symbols_destroy(struct language *language) { free(language->symbols); }

/* FNV-1a. */
static unsigned hash_of(const char *name, size_t length)
{
  unsigned hash = 2166136261u;
  for (size_t k = 0; k < length; k++) hash = (hash ^ (unsigned char)name[k]) * 16777619u;
  return hash;
}

static struct symbol *find_at(struct language *language, const char *name, size_t length, int depth)
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

struct symbol *symbol_find(struct language *language, const char *name, size_t length)
{
  return find_at(language, name, length, -1);
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

void symbol_unknown(struct language *language, struct place place, const struct token *name, const char *where)
{
  const char *best = NULL;
  size_t distance = words_reach(name->length);
  for (size_t b = 0; b < BUCKETS; b++)
    for (const struct symbol *s = language->symbols[b]; s; s = s->next) {
      const char *text = arena_copy(language->arena, s->name, s->length);
      if (text) words_consider(name->text, name->length, text, &best, &distance);
    }
  if (best)
    language_error(language, place, "'%.*s' is not declared (%s is wanted); did you mean '%s'?", (int)name->length, name->text,
                   where, best);
  else language_error(language, place, "'%.*s' is not declared (%s is wanted)", (int)name->length, name->text, where);
}

/* The symbol to write to: a #local in an included file is its own, everything else belongs to all. */
static struct symbol *declared(struct language *language, const struct token *name)
{
  const int depth = name->local ? language->include_depth : 0;
  struct symbol *symbol = find_at(language, name->text, name->length, depth);
  if (symbol) return symbol;
  symbol = language_alloc(language, sizeof *symbol);
  symbol->name = name->text, symbol->length = name->length, symbol->depth = depth;
  symbol->hash = hash_of(name->text, name->length);
  symbol->next = language->symbols[symbol->hash % BUCKETS];
  language->symbols[symbol->hash % BUCKETS] = symbol;
  return symbol;
}

void declare_value(struct language *language, struct place place, const struct token *name, const struct value *value)
{
  (void)place;
  struct symbol *symbol = declared(language, name);
  symbol->kind = SYMBOL_VALUE, symbol->value = *value;
}

void declare_object(struct language *language, struct place place, const struct token *name, struct node *object)
{
  (void)place;
  struct symbol *symbol = declared(language, name);
  symbol->kind = SYMBOL_OBJECT, symbol->object = object;
}

void declare_texture(struct language *language, struct place place, const struct token *name, const struct texture *texture)
{
  (void)place;
  struct symbol *symbol = declared(language, name);
  symbol->kind = SYMBOL_TEXTURE, symbol->texture = *texture;
  /* A declared block is whole: what it leaves open has the default. */
  symbol->texture.set = texture->block;
}
