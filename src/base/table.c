/* Open addressing with linear probing (Knuth, The Art of Computer Programming 3, 6.4, algorithm L). There is one slot
 * for each hash; the entries of that hash hang from it. So a lookup meets neighbours in memory, and mostly no entry. */
#include "base/table.h"

#include <string.h>
#include <sys/random.h>

enum { FIRST_SIZE = 64, FULL = 4 /* grows if less than 1 slot in this many is free; a miss then examines 8.5 */ };

__extension__ typedef unsigned __int128 product;

/* A Mersenne prime. */
#define PRIME ((UINT64_C(1) << 61) - 1)

/* If there are no random numbers, uses a key that is as good for texts not made to be slow. */
static uint64_t choose_key(void)
{
  uint64_t key;
  if (getrandom(&key, sizeof key, 0) != (ssize_t)sizeof key) key = UINT64_C(0x9e3779b97f4a7c15);
  return key % (PRIME - 1) + 1;
}

/* The bytes, seven at once, and their number are the coefficients of a polynomial; its value at the key is the hash
 * (Carter and Wegman, Universal classes of hash functions, 1979). Any two texts of up to n bytes have the same hash for
 * at most n / 7 + 1 of the 2^61 keys. Never 0. */
static uint64_t hash_of(uint64_t key, const void *bytes, size_t length)
{
  const unsigned char *byte = bytes;
  uint64_t hash = 0;
  for (size_t left = length; left > 0;) {
    const size_t count = left < 7 ? left : 7;
    uint64_t part = 0;
    if (left > 7) memcpy(&part, byte, sizeof part), part &= (UINT64_C(1) << 56) - 1;
    else
      for (size_t k = 0; k < left; k++) part |= (uint64_t)byte[k] << 8 * k;
    const product p = (product)(hash + part) * key;
    const uint64_t folded = (uint64_t)(p & PRIME) + (uint64_t)(p >> 61);
    hash = (folded & PRIME) + (folded >> 61);
    byte += count;
    left -= count;
  }
  return hash + length + 1;
}

/* The slot of that hash, or the free one for it. */
static struct table_slot *slot_of(const struct table *table, uint64_t hash)
{
  size_t k = hash & (table->size - 1);
  while (table->slots[k].hash != hash && table->slots[k].hash != 0) k = (k + 1) & (table->size - 1);
  return &table->slots[k];
}

struct table_entry *table_find(const struct table *table, const void *bytes, size_t length)
{
  return table->size ? slot_of(table, hash_of(table->key, bytes, length))->newest : NULL;
}

static bool grow(struct table *table, struct arena *arena)
{
  struct table larger = {.size = table->size ? 2 * table->size : FIRST_SIZE,
                         .key = table->size ? table->key : choose_key()};
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

bool table_add(struct table *table, struct arena *arena, struct table_entry *entry, const void *bytes, size_t length)
{
  if (table->used >= table->size - table->size / FULL && !grow(table, arena)) return false;
  const uint64_t hash = hash_of(table->key, bytes, length);
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
