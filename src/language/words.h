/* Words: the token of each, those that are POV-Ray's and not ours, and the one that a misspelt word was meant to be. */
#ifndef PSCN_LANGUAGE_WORDS_H
#define PSCN_LANGUAGE_WORDS_H

#include <stdbool.h>
#include <stddef.h>

/* The token of a word; and of a directive, given with its #. */
int words_token(const char *word, size_t length);
int words_directive_token(const char *text, size_t length);

/* Of a word of POV-Ray's that is not supported: what can be used instead, or "". */
const char *words_instead(const char *word, size_t length);

/* The name of a directive, behind its # and blanks if the text has them. *length, that of the text, becomes that of the
 * name. */
const char *words_directive(const char *text, size_t *length);

/* Whether a token begins a statement; or an item of a block, not a value. */
bool words_begin_statement(int token);
bool words_begin_item(int token);
/* Whether a token is a word: a name, or a word of the language or of POV-Ray's; no directive. */
bool words_is(int token);
/* Whether a token is a word of POV-Ray's that is not ours. */
bool words_are_foreign(int token);

/* All words of a kind, from 0 on; NULL behind the last. The kinds: those that begin a statement, other words of the
 * language, names of values, directives without their #, and POV-Ray's words that are not ours. */
enum words_kind { WORDS_STATEMENTS, WORDS_ITEMS, WORDS_VALUES, WORDS_DIRECTIVES, WORDS_FOREIGN };
const char *words_at(enum words_kind kind, size_t index);

/* Below, at or above 0 if word[0 .. length-1] comes before, equals, or comes behind `name` in byte order. */
int words_compare(const char *word, size_t length, const char *name);

/* The row of that word in a table of `count` rows of `size` bytes, sorted by the names with which they begin, or NULL. */
const void *words_find(const char *word, size_t length, const void *table, size_t count, size_t size);

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
void guess_keywords(struct guess *guess);   /* considers all words of the language */
void guess_directives(struct guess *guess); /* considers all its directives */

#endif
