/* Words: which are POV-Ray's and not ours, and which of ours a misspelt one was meant to be. */
#ifndef PSCN_LANGUAGE_WORDS_H
#define PSCN_LANGUAGE_WORDS_H

#include <stdbool.h>
#include <stddef.h>

/* Whether POV-Ray 3.7 reserves the word and the language has no use for it. */
bool words_foreign(const char *word, size_t length);

/* Whether it names one of POV-Ray's shapes. */
bool words_foreign_shape(const char *word, size_t length);

/* Offers a candidate to a search for the nearest word; `best` starts as NULL with *distance = words_reach(length). */
void words_consider(const char *word, size_t length, const char *candidate, const char **best, size_t *distance);

/* How many letters may be wrong in a word of that length for it to be taken for another: a third, at least one. The distance
 * counted is that of insertions, deletions, replacements and swaps of neighbours. */
size_t words_reach(size_t length);

#endif
