/* Memory of a scene, from libc or from the hooks of the scene's user (pscn.h's struct pscn_memory).
 *
 * The hooks belong to a thread while it makes or frees a scene: memory_use sets them, and sets them back. To pass them
 * to every list that grows would put them into each signature from the parser to the hierarchy. Without hooks, all this
 * is calloc, realloc and free.
 */
#ifndef PSCN_BASE_MEMORY_H
#define PSCN_BASE_MEMORY_H

#include <stdatomic.h>
#include <stdbool.h>
#include <stddef.h>

struct memory_hooks {
  void *(*resize)(void *context, void *block, size_t size); /* as realloc; frees where size is 0; NULL: libc's */
  void *context;
};

/* Sets where this thread's memory comes from; returns where it came from before. */
struct memory_hooks memory_use(struct memory_hooks hooks);

/* A limit on libc's memory of all threads that use it together. Where the system does not tell the sizes of blocks,
 * nothing is limited. */
struct memory_limit {
  size_t most; /* bytes; 0: no limit */
  atomic_size_t used;
  atomic_bool reached; /* something was refused */
};

/* Sets the limit of this thread, which is borrowed; NULL: none. Returns the one before. Blocks are counted by the thread
 * that allocates or frees them. */
struct memory_limit *memory_limit_use(struct memory_limit *limit);
struct memory_limit *memory_limit_now(void);

/* Whether this thread's limit was the reason that memory was refused to some thread. */
bool memory_limit_reached(void);

/* Whether there are no hooks. */
bool memory_is_libcs(void);

/* `count` zeroed elements of `size` bytes, aligned for any type, or NULL where memory is short or the product
 * overflows. */
void *memory_alloc(size_t count, size_t size);

/* The block resized to `size` > 0 bytes; new bytes are not zeroed. A NULL block is a new one. NULL where memory is
 * short, and the block is as it was. */
void *memory_resize(void *block, size_t size);

/* The block with room for `needed` elements of `size` bytes. If it has to grow, it gets room for twice as many and a
 * few more, so most lists are allocated once or twice. *room: how many it has room for, 0 of a NULL block. NULL where
 * memory is short or the product overflows; block and *room are then as they were. */
void *memory_grow(void *block, size_t *room, size_t needed, size_t size);

/* A growing list of anything, used again and again, by one thread at a time. One of zeros is empty. Owned: memory_free
 * `at`. */
struct growing {
  void *at;
  size_t count, room; /* elements, all of one size */
};

/* Room for `more` elements of `size` bytes at the end. They are counted, not zeroed, and stay where they are until the
 * next call. NULL where memory is short, and then the list is as it was. */
void *growing_add(struct growing *list, size_t more, size_t size);

/* A copy of the text, or NULL. */
char *memory_copy_text(const char *text);

/* Says that a block, or a part of one, will be read at scattered places. Such reads wait for page tables, and huge
 * pages, which this asks the system for, need fewer. Memory from hooks is left alone. */
void memory_used_anywhere(void *block, size_t size);

/* Frees a block that the same hooks gave. NULL is allowed. */
void memory_free(void *block);

#endif
