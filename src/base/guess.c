/* Lists of words, and the distance between words (Damerau-Levenshtein, neighbours swapped once). */
#include "base/guess.h"

#include <stdio.h>

void words_list(const char *const words[], size_t count, char *out, size_t size)
{
  size_t used = 0;
  out[0] = '\0';
  for (size_t k = 0; k < count && used < size; k++) {
    const char *before = k == 0 ? "" : k + 1 == count ? " or " : ", ";
    used += (size_t)snprintf(out + used, size - used, "%s%s", before, words[k]);
  }
}

enum { LONGEST_COMPARED = 40 };

static size_t smallest(size_t a, size_t b, size_t c)
{
  const size_t least = a < b ? a : b;
  return least < c ? least : c;
}

static size_t distance_between(const char *a, size_t m, const char *b, size_t n)
{
  size_t row[LONGEST_COMPARED + 1][LONGEST_COMPARED + 1];
  for (size_t i = 0; i <= m; i++) row[i][0] = i;
  for (size_t j = 0; j <= n; j++) row[0][j] = j;
  for (size_t i = 1; i <= m; i++) {
    for (size_t j = 1; j <= n; j++) {
      const size_t replaced = row[i - 1][j - 1] + (a[i - 1] != b[j - 1]);
      row[i][j] = smallest(row[i - 1][j] + 1, row[i][j - 1] + 1, replaced);
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
        row[i][j] = smallest(row[i][j], row[i - 2][j - 2] + 1, row[i][j]);
    }
  }
  return row[m][n];
}

struct guess guess_begin(const char *word, size_t length)
{
  return (struct guess){.word = word, .length = length, .distance = length < 6 ? 1 : length / 3};
}

void guess_consider(struct guess *guess, const char *candidate, size_t length)
{
  if (guess->length > LONGEST_COMPARED || length > LONGEST_COMPARED) return;
  if (guess->length > length + guess->distance || length > guess->length + guess->distance) return;
  const size_t d = distance_between(guess->word, guess->length, candidate, length);
  /* A word with all letters wrong is not a misspelling, nor is the word itself. */
  if (d == 0 || d >= guess->length || d > guess->distance || (guess->best && d == guess->distance)) return;
  guess->best = candidate;
  guess->best_length = length;
  guess->distance = d;
}
