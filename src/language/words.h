/* Words: which are POV-Ray's and not ours, and which word a misspelt one was meant to be. */
#ifndef PSCN_LANGUAGE_WORDS_H
#define PSCN_LANGUAGE_WORDS_H

#include <stdbool.h>
#include <stddef.h>

/* Whether POV-Ray 3.7 reserves the word and the language has no use for it. */
bool words_foreign(const char *word, size_t length);

/* Whether it names one of POV-Ray's shapes. */
bool words_foreign_shape(const char *word, size_t length);

/* Below, at or above 0 as word[0 .. length-1] stands before, is, or stands behind `name` in the order of bytes. */
int words_compare(const char *word, size_t length, const char *name);

/* Offers a candidate to a search for the nearest word. `best` starts as NULL with *distance = words_reach(length); a
 * candidate within it and nearer than the best one becomes the best. */
void words_consider(const char *word, size_t length, const char *candidate, size_t candidate_length, const char **best,
                    size_t *best_length, size_t *distance);

/* How many letters may be wrong in a word of that length for it to be taken for another: a third, at least one. The
 * distance counted is that of insertions, deletions, replacements and swaps of neighbours. */
size_t words_reach(size_t length);

#endif
