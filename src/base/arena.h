/* Memory of one lifetime, freed all at once.
 *
 * An arena hands out zeroed blocks aligned for any object type. No block is freed by itself; arena_destroy frees all.
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

/* Gives the arena all blocks that `other` has handed out, and frees `other`. The memory of both comes from the same
 * hooks (memory.h). NULL is allowed. */
void arena_join(struct arena *arena, struct arena *other);

/* Frees the arena and all its blocks. NULL is allowed. */
void arena_destroy(struct arena *arena);

#endif
