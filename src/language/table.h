/* A hash table of things that begin with a table_entry and are found by some bytes: names, files, textures, solvers.
 *
 * It lies in an arena, owns nothing, and grows with what is in it. Several entries may be equal; the newest is met
 * first. The hash has a random key, or a text could be made whose names all have one place: nothing may depend on the
 * order in which entries lie in the table.
 */
#ifndef PSCN_LANGUAGE_TABLE_H
#define PSCN_LANGUAGE_TABLE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "base/arena.h"

struct table_entry {
  struct table_entry *older; /* of the same hash; NULL behind the last */
  uint64_t hash;
};

struct table_slot {
  uint64_t hash;              /* 0: free */
  struct table_entry *newest; /* NULL: all of that hash were removed */
};

/* Zeroed: an empty table. */
struct table {
  struct table_slot *slots;
  size_t size, used; /* slots: a power of two, or 0; those that are not free */
  uint64_t key;      /* of its hash, since there are slots */
};

/* The newest entry whose bytes have the same hash, or NULL. What else is equal the caller sees. */
struct table_entry *table_find(const struct table *table, const void *bytes, size_t length);

/* False, and nothing added, where memory is short. */
bool table_add(struct table *table, struct arena *arena, struct table_entry *entry, const void *bytes, size_t length);
void table_remove(struct table *table, const struct table_entry *entry);

#endif
