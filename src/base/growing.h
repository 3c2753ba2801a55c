/* A list of anything that grows and is used again and again.
 *
 * One thread at a time; its memory is that of the thread's hooks (base/memory.h).
 */
#ifndef PSCN_BASE_GROWING_H
#define PSCN_BASE_GROWING_H

#include <stddef.h>

/* One of zeros is empty. Owned: memory_free `at`. */
struct growing {
  void *at;
  size_t count, room; /* elements, all of one size */
};

/* Room for `more` elements of `size` bytes at the end, which are counted, not zeroed, and stay where they are until the
 * next call; NULL where memory is short, and then the list is as it was. */
void *growing_add(struct growing *list, size_t more, size_t size);

#endif
