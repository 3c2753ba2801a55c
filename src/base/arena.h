/* Memory of one lifetime, freed once.
 *
 * An arena hands out zeroed blocks aligned for any object type. Nothing is freed one by one; arena_destroy frees all.
 * An arena is used by one thread at a time.
 */
#ifndef PSCN_BASE_ARENA_H
#define PSCN_BASE_ARENA_H

#include <stddef.h>

struct arena;

/* A new empty arena, or NULL where memory is short. The caller owns it. */
struct arena *arena_create(void);

/* `count` zeroed elements of `size` bytes each, or NULL where memory is short or the product overflows. */
void *arena_alloc(struct arena *arena, size_t count, size_t size);

/* Gives all that `other`, whose memory comes from the same hooks (memory.h), has handed out to the arena, and frees `other`.
 * NULL is allowed. */
void arena_join(struct arena *arena, struct arena *other);

/* Frees the arena and all it handed out. NULL is allowed. */
void arena_destroy(struct arena *arena);

#endif
