/* A hash table of things that begin with a table_entry and are found by some bytes: names, files, textures, solvers.
 *
 * It lies in an arena, owns nothing, and grows with its contents. Several entries may be equal; the newest is met
 * first. The hash has a random key, because otherwise a text could be made whose names all get one slot. So nothing may
 * depend on the order of entries in the table.
 */
#ifndef PSCN_BASE_TABLE_H
#define PSCN_BASE_TABLE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "base/arena.h"

struct table_entry {
  struct table_entry *older; /* with the same hash; NULL behind the last */
  uint64_t hash;
};

struct table_slot {
  uint64_t hash;              /* 0: free */
  struct table_entry *newest; /* NULL: all entries of that hash were removed */
};

/* Zeroed: an empty table. */
struct table {
  struct table_slot *slots;
  size_t size, used; /* number of slots, a power of two or 0; slots not free */
  uint64_t key;      /* of its hash, once there are slots */
};

/* The newest entry with the same hash, or NULL. Whether its bytes are equal is the caller's to check. */
struct table_entry *table_find(const struct table *table, const void *bytes, size_t length);

/* False, with nothing added, if memory is short. */
bool table_add(struct table *table, struct arena *arena, struct table_entry *entry, const void *bytes, size_t length);
void table_remove(struct table *table, const struct table_entry *entry);

#endif
