/* The words of the language, and POV-Ray's other words. */
#include "language/words.h"

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

static bool is_one_of(int token, const int tokens[], size_t count)
{
  for (size_t k = 0; k < count; k++)
    if (tokens[k] == token) return true;
  return false;
}

bool words_begin_statement(int token)
{
  static const int statements[] = {PSCN_TOKEN_VERSION,         PSCN_TOKEN_DECLARE,    PSCN_TOKEN_LOCAL,
                                   PSCN_TOKEN_GLOBAL_SETTINGS, PSCN_TOKEN_DEFAULT,    PSCN_TOKEN_CAMERA,
                                   PSCN_TOKEN_LIGHT_SOURCE,    PSCN_TOKEN_BACKGROUND, PSCN_TOKEN_BICUBIC_PATCH,
                                   PSCN_TOKEN_UNION,           PSCN_TOKEN_OBJECT};
  return is_one_of(token, statements, COUNT(statements));
}

bool words_is(int token)
{
  return token > 255 && token < TOKEN_FIRST_PRIVATE && token != PSCN_TOKEN_NUMBER && token != PSCN_TOKEN_POINT &&
         token != PSCN_TOKEN_STRING && token != PSCN_TOKEN_VERSION && token != PSCN_TOKEN_DECLARE &&
         token != PSCN_TOKEN_LOCAL && token != PSCN_TOKEN_DEFAULT && token != PSCN_TOKEN_COMPARISON;
}

bool words_are_foreign(int token)
{
  return token == PSCN_TOKEN_FOREIGN || token == PSCN_TOKEN_SHAPE || token == PSCN_TOKEN_REFUSED ||
         token == PSCN_TOKEN_IGNORED;
}

bool words_begin_item(int token)
{
  static const int in_values[] = {
    PSCN_TOKEN_WORD,      PSCN_TOKEN_NUMBER,  PSCN_TOKEN_POINT,  PSCN_TOKEN_STRING,     PSCN_TOKEN_COLOR,
    PSCN_TOKEN_RGB,       PSCN_TOKEN_RED,     PSCN_TOKEN_GREEN,  PSCN_TOKEN_BLUE,       PSCN_TOKEN_X,
    PSCN_TOKEN_Y,         PSCN_TOKEN_Z,       PSCN_TOKEN_FILTER, PSCN_TOKEN_COMPONENT,  PSCN_TOKEN_CONSTANT,
    PSCN_TOKEN_FUNCTION,  PSCN_TOKEN_DEFINED, PSCN_TOKEN_ARRAY,  PSCN_TOKEN_DEPRECATED, PSCN_TOKEN_ONCE,
    PSCN_TOKEN_COMPARISON};
  return token > 255 && !words_are_foreign(token) && !is_one_of(token, in_values, COUNT(in_values));
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

/* ---- guesses ---- */

void guess_keywords(struct guess *guess)
{
  for (size_t k = 0; k < COUNT(WORDS); k++)
    if (!words_are_foreign(WORDS[k].token)) guess_consider(guess, WORDS[k].name, strlen(WORDS[k].name));
}

void guess_directives(struct guess *guess)
{
  for (size_t k = 0; k < COUNT(DIRECTIVES); k++) guess_consider(guess, DIRECTIVES[k].name, strlen(DIRECTIVES[k].name));
}
