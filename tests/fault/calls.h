/* Calls that fail: the linker (CMakeLists.txt) passes every call of these kinds in commands and library to calls.c.
 * What jansson and OpenImageIO allocate is not included. */
#ifndef PSCN_TESTS_FAULT_CALLS_H
#define PSCN_TESTS_FAULT_CALLS_H

#include <stdatomic.h>
#include <stdbool.h>

enum call {
  ALLOCATE,
  THREAD,
  MMAP,
  OPEN,
  WRITE,
  FSYNC,
  FCHMOD,
  LINK,
  RENAME,
  CLOSE,
  FOPEN,
  FCLOSE,
  MKDIR,
  MKDTEMP,
  DUP,
  FORK,
  PIPE,
  ALLOCATE_AT /* the first one of each place in the sources, instead of the nth */
};

/* Of one kind of call: how many succeed before one fails, or for ALLOCATE_AT the number of the place, of `place_count`
 * that have been met; negative: all do. `armed` only while a command runs. A child of ours, before it becomes another
 * program, counts on: `left` is shared memory, which main maps. */
extern enum call failing;
extern atomic_long *left;
extern bool armed;
extern long place_count;

#endif
