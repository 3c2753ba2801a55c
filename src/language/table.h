/* A hash table of things that begin with a table_entry: names, files, textures, solvers.
 *
 * It lies in an arena, owns nothing, and grows with what is in it. Several entries may be equal; the newest is met
 * first.
 */
#ifndef PSCN_LANGUAGE_TABLE_H
#define PSCN_LANGUAGE_TABLE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "base/arena.h"

struct table_entry {
  struct table_entry *next;
  uint64_t hash;
};

/* Zeroed: an empty table. */
struct table {
  struct table_entry **heads;
  size_t size, count;
};

uint64_t table_hash(const void *bytes, size_t length);

/* The newest entry of that hash, and the next older one; NULL behind the last. What else is equal the caller sees. */
struct table_entry *table_find(const struct table *table, uint64_t hash);
struct table_entry *table_next(const struct table_entry *entry);

/* False, and nothing added, where memory is short. */
bool table_add(struct table *table, struct arena *arena, struct table_entry *entry, uint64_t hash);
void table_remove(struct table *table, const struct table_entry *entry);

#endif
