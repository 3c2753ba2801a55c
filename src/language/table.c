/* Chains of entries under as many heads as there are entries, to a factor of two. */
#include "language/table.h"

enum { FIRST_SIZE = 64 };

/* FNV-1a; the upper bits, which are the better ones, are folded down to where heads are chosen. */
uint64_t table_hash(const void *bytes, size_t length)
{
  const unsigned char *byte = bytes;
  uint64_t hash = UINT64_C(0xcbf29ce484222325);
  for (size_t k = 0; k < length; k++) hash = (hash ^ byte[k]) * UINT64_C(0x100000001b3);
  return hash ^ (hash >> 32);
}

static struct table_entry **head_of(const struct table *table, uint64_t hash)
{
  return &table->heads[hash & (table->size - 1)];
}

static struct table_entry *equal(struct table_entry *entry, uint64_t hash)
{
  while (entry && entry->hash != hash) entry = entry->next;
  return entry;
}

struct table_entry *table_find(const struct table *table, uint64_t hash)
{
  return table->size ? equal(*head_of(table, hash), hash) : NULL;
}

struct table_entry *table_next(const struct table_entry *entry) { return equal(entry->next, entry->hash); }

/* The chains keep their order: of equal entries the newest stays first. */
static bool grow(struct table *table, struct arena *arena)
{
  struct table larger = {.size = table->size ? 2 * table->size : FIRST_SIZE, .count = table->count};
  larger.heads = arena_alloc(arena, larger.size, sizeof *larger.heads);
  if (!larger.heads) return false;
  for (size_t k = 0; k < table->size; k++) {
    struct table_entry **ends[2] = {&larger.heads[k], &larger.heads[k + table->size]};
    for (struct table_entry *entry = table->heads[k]; entry; entry = entry->next) {
      struct table_entry ***end = &ends[(entry->hash & table->size) != 0];
      **end = entry;
      *end = &entry->next;
    }
    *ends[0] = *ends[1] = NULL;
  }
  *table = larger;
  return true;
}

bool table_add(struct table *table, struct arena *arena, struct table_entry *entry, uint64_t hash)
{
  if (table->count == table->size && !grow(table, arena)) return false;
  struct table_entry **head = head_of(table, hash);
  *entry = (struct table_entry){*head, hash};
  *head = entry;
  table->count++;
  return true;
}

void table_remove(struct table *table, const struct table_entry *entry)
{
  struct table_entry **at = head_of(table, entry->hash);
  while (*at != entry) at = &(*at)->next;
  *at = entry->next;
  table->count--;
}
