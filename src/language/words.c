/* The words of the language, and POV-Ray's other words. */
#include "language/words.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "language/scan.h"

struct keyword {
  const char *name;
  int token;
  const char *instead; /* of one that is not supported: what can be used, or "" */
};

/* Made by CMake. WORDS, sorted: the tokens of the grammar that are words, other spellings of them, and the other words
 * that POV-Ray 3.7 reserves (grammar/povray.txt). */
#include "language/word_tables.h"

static const struct directive {
  const char *name;
  int token;
} DIRECTIVES[] = {{"break", TOKEN_BREAK},
                  {"case", TOKEN_CASE},
                  {"debug", TOKEN_DEBUG},
                  {"declare", PSCN_TOKEN_DECLARE},
                  {"default", PSCN_TOKEN_DEFAULT},
                  {"else", TOKEN_ELSE},
                  {"elseif", TOKEN_ELSEIF},
                  {"end", TOKEN_END},
                  {"error", TOKEN_ERROR},
                  {"fclose", TOKEN_FOREIGN_DIRECTIVE},
                  {"fopen", TOKEN_FOREIGN_DIRECTIVE},
                  {"for", TOKEN_FOR},
                  {"if", TOKEN_IF},
                  {"ifdef", TOKEN_IFDEF},
                  {"ifndef", TOKEN_IFNDEF},
                  {"include", TOKEN_INCLUDE},
                  {"local", PSCN_TOKEN_LOCAL},
                  {"macro", TOKEN_MACRO},
                  {"range", TOKEN_RANGE},
                  {"read", TOKEN_FOREIGN_DIRECTIVE},
                  {"render", TOKEN_DEBUG},
                  {"statistics", TOKEN_DEBUG},
                  {"switch", TOKEN_SWITCH},
                  {"undef", TOKEN_UNDEF},
                  {"version", PSCN_TOKEN_VERSION},
                  {"warning", TOKEN_WARNING},
                  {"while", TOKEN_WHILE},
                  {"write", TOKEN_FOREIGN_DIRECTIVE}};

#define COUNT(table) (sizeof(table) / sizeof *(table))

int words_compare(const char *word, size_t length, const char *name)
{
  size_t k = 0; /* most words differ in their first letters */
  while (k < length && name[k] == word[k] && name[k]) k++;
  return k < length ? (unsigned char)word[k] - (unsigned char)name[k] : name[k] ? -1 : 0;
}

struct sought {
  const char *text;
  size_t length;
};

/* Compares a word with a row of a sorted table, which begins with a name. */
static int compare_row(const void *sought, const void *row)
{
  const struct sought *w = sought;
  return words_compare(w->text, w->length, *(const char *const *)row);
}

const void *words_find(const char *word, size_t length, const void *table, size_t count, size_t size)
{
  return bsearch(&(struct sought){word, length}, table, count, size, compare_row);
}

static const struct keyword *find_word(const char *word, size_t length)
{
  if (word[0] < 'a') return NULL; /* no word of the language begins with a capital */
  return words_find(word, length, WORDS, COUNT(WORDS), sizeof *WORDS);
}

int words_token(const char *word, size_t length)
{
  const struct keyword *found = find_word(word, length);
  return found ? found->token : PSCN_TOKEN_WORD;
}

const char *words_instead(const char *word, size_t length)
{
  const struct keyword *found = find_word(word, length);
  return found ? found->instead : "";
}

const char *words_directive(const char *text, size_t *length)
{
  if (*text != '#') return text;
  do text++, --*length;
  while (strchr(" \t\r\n\f\v", *text));
  return text;
}

int words_directive_token(const char *text, size_t length)
{
  const char *name = words_directive(text, &length);
  const struct directive *found = words_find(name, length, DIRECTIVES, COUNT(DIRECTIVES), sizeof *DIRECTIVES);
  return found ? found->token : TOKEN_UNKNOWN_DIRECTIVE;
}

/* In the order of grammar/pscn.y. */
static bool is_between(int first, int token, int last) { return first <= token && token <= last; }

bool words_begin_statement(int token) { return is_between(PSCN_TOKEN_VERSION, token, PSCN_TOKEN_OBJECT); }

bool words_begin_item(int token) { return is_between(PSCN_TOKEN_VERSION, token, PSCN_TOKEN_SOLVER); }

bool words_are_foreign(int token) { return is_between(PSCN_TOKEN_FOREIGN, token, PSCN_TOKEN_IGNORED); }

bool words_is(int token)
{
  return is_between(256, token, TOKEN_FIRST_PRIVATE) && !is_between(PSCN_TOKEN_VERSION, token, PSCN_TOKEN_DEFAULT) &&
         token != PSCN_TOKEN_NUMBER && token != PSCN_TOKEN_POINT && token != PSCN_TOKEN_STRING &&
         token != PSCN_TOKEN_COMPARISON;
}

static enum words_kind kind_of(int token)
{
  if (words_are_foreign(token)) return WORDS_FOREIGN;
  if (words_begin_statement(token)) return WORDS_STATEMENTS;
  return words_begin_item(token) ? WORDS_ITEMS : WORDS_VALUES;
}

const char *words_at(enum words_kind kind, size_t index)
{
  if (kind == WORDS_DIRECTIVES) return index < COUNT(DIRECTIVES) ? DIRECTIVES[index].name : NULL;
  for (size_t k = 0; k < COUNT(WORDS); k++)
    if (kind_of(WORDS[k].token) == kind && index-- == 0) return WORDS[k].name;
  return NULL;
}

void words_list(const char *const words[], size_t count, char *out, size_t size)
{
  size_t used = 0;
  out[0] = '\0';
  for (size_t k = 0; k < count && used < size; k++) {
    const char *before = k == 0 ? "" : k + 1 == count ? " or " : ", ";
    used += (size_t)snprintf(out + used, size - used, "%s%s", before, words[k]);
  }
}

/* ---- guesses, by the distance of Damerau and Levenshtein, neighbours swapped once ---- */

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

void guess_keywords(struct guess *guess)
{
  for (size_t k = 0; k < COUNT(WORDS); k++)
    if (!words_are_foreign(WORDS[k].token)) guess_consider(guess, WORDS[k].name, strlen(WORDS[k].name));
}

void guess_directives(struct guess *guess)
{
  for (size_t k = 0; k < COUNT(DIRECTIVES); k++) guess_consider(guess, DIRECTIVES[k].name, strlen(DIRECTIVES[k].name));
}
