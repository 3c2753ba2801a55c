/* An arena: a list of chunks, each filled from its beginning. Blocks too large for a chunk get their own. */
#include "base/arena.h"

#include <stdalign.h>
#include <stdint.h>

#include "base/memory.h"

enum {
  FIRST_CHUNK_BYTES = 4096,
  LAST_CHUNK_BYTES = 1 << 24, /* chunks double up to this size, so small scenes stay small */
  BLOCK_ALIGNMENT = alignof(max_align_t)
};

struct chunk {
  struct chunk *next;
  alignas(max_align_t) unsigned char bytes[];
};

struct arena {
  struct chunk *chunks; /* the first is the one being filled */
  size_t used, size;    /* bytes of the first chunk */
  size_t next_size;
};

struct arena *arena_create(void)
{
  struct arena *arena = memory_alloc(1, sizeof *arena);
  if (arena) arena->next_size = FIRST_CHUNK_BYTES;
  return arena;
}

static struct chunk *chunk_create(size_t bytes)
{
  if (bytes > SIZE_MAX - sizeof(struct chunk)) return NULL;
  struct chunk *chunk = memory_alloc(1, sizeof(struct chunk) + bytes);
  if (chunk) memory_used_anywhere(chunk, sizeof(struct chunk) + bytes);
  return chunk;
}

void *arena_alloc(struct arena *arena, size_t count, size_t size)
{
  size_t bytes;
  if (__builtin_mul_overflow(count, size, &bytes) || bytes > SIZE_MAX - BLOCK_ALIGNMENT) return NULL;
  bytes = (bytes + BLOCK_ALIGNMENT - 1) / BLOCK_ALIGNMENT * BLOCK_ALIGNMENT;
  if (bytes == 0) bytes = BLOCK_ALIGNMENT;
  if (arena->chunks && bytes <= arena->size - arena->used) {
    void *block = arena->chunks->bytes + arena->used;
    arena->used += bytes;
    return block;
  }
  if (arena->chunks && bytes > arena->next_size / 4) {
    /* a block of its own, behind the chunk being filled */
    struct chunk *own = chunk_create(bytes);
    if (!own) return NULL;
    own->next = arena->chunks->next;
    arena->chunks->next = own;
    return own->bytes;
  }
  size_t chunk_bytes = bytes > arena->next_size ? bytes : arena->next_size;
  struct chunk *chunk = chunk_create(chunk_bytes);
  if (!chunk) return NULL;
  if (arena->next_size < LAST_CHUNK_BYTES) arena->next_size *= 2;
  chunk->next = arena->chunks;
  arena->chunks = chunk;
  arena->size = chunk_bytes;
  arena->used = bytes;
  return chunk->bytes;
}

void arena_join(struct arena *arena, struct arena *other)
{
  if (!other) return;
  if (!arena->chunks) {
    arena->chunks = other->chunks, arena->used = other->used, arena->size = other->size;
  } else { /* behind the chunk being filled */
    struct chunk **end = &arena->chunks->next, *rest = *end;
    *end = other->chunks;
    while (*end) end = &(*end)->next;
    *end = rest;
  }
  memory_free(other);
}

void arena_destroy(struct arena *arena)
{
  if (!arena) return;
  for (struct chunk *chunk = arena->chunks; chunk;) {
    struct chunk *next = chunk->next;
    memory_free(chunk);
    chunk = next;
  }
  memory_free(arena);
}
