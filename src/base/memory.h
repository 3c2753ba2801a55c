/* Memory that a scene is made of, from libc or from whoever asked for the scene (pscn.h's struct pscn_memory).
 *
 * The hooks belong to a thread while it makes or frees a scene: memory_use sets them there and back again. Handing them
 * down to every list that grows would put them into each signature from the parser to the hierarchy. Without hooks all
 * this is calloc, realloc and free.
 */
#ifndef PSCN_BASE_MEMORY_H
#define PSCN_BASE_MEMORY_H

#include <stdbool.h>
#include <stddef.h>

struct memory_hooks {
  void *(*resize)(void *context, void *block, size_t size); /* as realloc, frees where size is 0; NULL: libc's */
  void *context;
};

/* From now on this thread's memory comes from there; returns where it came from before. */
struct memory_hooks memory_use(struct memory_hooks hooks);

/* Whether there are no hooks. */
bool memory_is_libcs(void);

/* `count` zeroed elements of `size` bytes, aligned for any type, or NULL where memory is short or the product
 * overflows. */
void *memory_alloc(size_t count, size_t size);

/* The block with room for `size` > 0 bytes, what is new in it not zeroed. NULL, the block as it was, where memory is
 * short. A NULL block is a new one. */
void *memory_resize(void *block, size_t size);

/* The block with room for `needed` elements of `size` bytes, where it has not got it for twice as many and a few more:
 * most lists are allocated once or twice. *room: how many it has room for, 0 of a NULL block. NULL, the block and *room
 * as they were, where memory is short or the product overflows. */
void *memory_grow(void *block, size_t *room, size_t needed, size_t size);

/* A list of anything that grows and is used again and again, by one thread at a time. One of zeros is empty. Owned:
 * memory_free `at`. */
struct growing {
  void *at;
  size_t count, room; /* elements, all of one size */
};

/* Room for `more` elements of `size` bytes at the end, which are counted, not zeroed, and stay where they are until the
 * next call; NULL where memory is short, and then the list is as it was. */
void *growing_add(struct growing *list, size_t more, size_t size);

/* A copy of the text, or NULL. */
char *memory_copy_text(const char *text);

/* Says of a block, or of a part of one, that it will be read here and there: that waits for the tables of where pages
 * are, and of huge pages, which the system is asked for, there are fewer. What hooks gave is left alone. */
void memory_used_anywhere(void *block, size_t size);

/* What the same hooks gave. NULL is allowed. */
void memory_free(void *block);

#endif
