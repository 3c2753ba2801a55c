/* Lists of words, and the word that a misspelt one was meant to be. */
#ifndef PSCN_BASE_GUESS_H
#define PSCN_BASE_GUESS_H

#include <stddef.h>

/* "a, b or c", cut off at `size` bytes. */
void words_list(const char *const words[], size_t count, char *out, size_t size);

/* A search for the word that was meant by another. A third of its letters may be wrong, and at least one; insertions,
 * deletions, replacements and swaps of neighbours count. Of equally near candidates the first is taken. */
struct guess {
  const char *word;
  size_t length;
  const char *best; /* NULL if none is near enough */
  size_t best_length, distance;
};

struct guess guess_begin(const char *word, size_t length);
void guess_consider(struct guess *guess, const char *candidate, size_t length);

#endif
