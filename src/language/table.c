/* Open addressing with linear probing (Knuth, The Art of Computer Programming 3, 6.4, algorithm L): one slot for each
 * hash, from which the entries of that hash hang. So a lookup meets neighbours in memory, and mostly no entry. */
#include "language/table.h"

enum { FIRST_SIZE = 64, FULL = 4 /* grows where less than 1 of so many slots is free: a miss looks at 8.5 then */ };

/* FNV-1a; the upper bits, which are the better ones, are folded down to where slots are chosen. */
uint64_t table_hash(const void *bytes, size_t length)
{
  const unsigned char *byte = bytes;
  uint64_t hash = UINT64_C(0xcbf29ce484222325);
  for (size_t k = 0; k < length; k++) hash = (hash ^ byte[k]) * UINT64_C(0x100000001b3);
  hash ^= hash >> 32;
  return hash ? hash : 1;
}

/* The slot of that hash, or the free one where it would be. */
static struct table_slot *slot_of(const struct table *table, uint64_t hash)
{
  size_t k = hash & (table->size - 1);
  while (table->slots[k].hash != hash && table->slots[k].hash != 0) k = (k + 1) & (table->size - 1);
  return &table->slots[k];
}

struct table_entry *table_find(const struct table *table, uint64_t hash)
{
  return table->size ? slot_of(table, hash)->newest : NULL;
}

static bool grow(struct table *table, struct arena *arena)
{
  struct table larger = {.size = table->size ? 2 * table->size : FIRST_SIZE};
  larger.slots = arena_alloc(arena, larger.size, sizeof *larger.slots);
  if (!larger.slots) return false;
  for (size_t k = 0; k < table->size; k++) {
    const struct table_slot *slot = &table->slots[k];
    if (!slot->newest) continue;
    *slot_of(&larger, slot->hash) = *slot;
    larger.used++;
  }
  *table = larger;
  return true;
}

bool table_add(struct table *table, struct arena *arena, struct table_entry *entry, uint64_t hash)
{
  if (table->used >= table->size - table->size / FULL && !grow(table, arena)) return false;
  struct table_slot *slot = slot_of(table, hash);
  table->used += slot->hash == 0;
  *entry = (struct table_entry){slot->newest, hash};
  *slot = (struct table_slot){hash, entry};
  return true;
}

void table_remove(struct table *table, const struct table_entry *entry)
{
  struct table_entry **at = &slot_of(table, entry->hash)->newest;
  while (*at != entry) at = &(*at)->older;
  *at = entry->older;
}
