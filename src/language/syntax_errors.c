/* The text of syntax errors. */
#include "language/syntax_errors.h"

#include <stdio.h>
#include <string.h>

#include "language/solver_statement.h"
#include "language/tokens.h"

enum { LONGEST_SHOWN = 40 };

#define COUNT(list) ((int)(sizeof(list) / sizeof *(list)))

static bool contains(const char *const names[], int count, const char *wanted)
{
  for (int k = 0; k < count; k++)
    if (strcmp(names[k], wanted) == 0) return true;
  return false;
}

/* Lists briefly what could have stood there: a value, instead of all that may begin one; no operators, commas and
 * directives, which may stand nearly anywhere. Empty if what remains is still too much to help. */
static void list_expected(const char *const expected[], int count, char *out, size_t size)
{
  enum { MOST_LISTED = 10 };
  static const char *const in_values[] = {
    "a number", "a vector", "x",     "y",   "z",     "a constant", "a string", "'!'",  "'('",   "'<'",    "'+'",
    "'-'",      "defined",  "array", "rgb", "color", "rgbf",       "rgbft",    "srgb", "srgbf", "srgbft", "a function"};
  static const char *const parts[] = {"red", "green", "blue", "filter"}; /* which may follow any colour */
  static const char *const anywhere[] = {"'+'",
                                         "'-'",
                                         "'*'",
                                         "'/'",
                                         "'.'",
                                         "','",
                                         "'['",
                                         "'<'",
                                         "'>'",
                                         "'='",
                                         "'?'",
                                         "'&'",
                                         "'|'",
                                         "a comparison",
                                         "#declare",
                                         "#local",
                                         "#version",
                                         "#default",
                                         "the end of the text",
                                         "deprecated",
                                         "a word of POV-Ray's",
                                         "a shape",
                                         "a word without effect"};
  const char *list[MOST_LISTED];
  int listed = 0;
  const bool value = contains(expected, count, "a constant"), objects = contains(expected, count, "object");
  const bool part = contains(expected, count, "filter"), compared = contains(expected, count, "a comparison");
  if (value) list[listed++] = "a value";
  for (int k = 0; k < count; k++) {
    if (value && (contains(in_values, COUNT(in_values), expected[k]) || strcmp(expected[k], "a name") == 0)) continue;
    if (strcmp(expected[k], "'='") == 0 && !compared) {
      list[listed++] = expected[k];
      continue;
    }
    if (count > 1 && contains(anywhere, COUNT(anywhere), expected[k])) continue;
    if (part && contains(parts, COUNT(parts), expected[k])) continue;
    if (objects && strcmp(expected[k], "solver") == 0) continue; /* parsed there, but never right */
    if (listed == MOST_LISTED) return;
    list[listed++] = expected[k];
  }
  if (listed == 0) return;
  const int used = snprintf(out, size, ", expected ");
  words_list(list, (size_t)listed, out + used, size - (size_t)used);
}

/* Guesses the nearest word that the grammar expected, or else the nearest of all words and names. */
static struct guess guess_meant(struct language *language, const char *word, size_t length,
                                const char *const expected[], int count)
{
  struct guess guess = guess_begin(word, length);
  for (int k = 0; k < count; k++) {
    if (expected[k][0] == '\'' || strncmp(expected[k], "a ", 2) == 0) continue;
    guess_consider(&guess, expected[k], strlen(expected[k]));
  }
  if (guess.best) return guess;
  guess_keywords(&guess);
  guess_symbols(&guess, language);
  return guess;
}

/* How many of its characters are shown. */
static int shown(const struct name *name) { return name->length < LONGEST_SHOWN ? (int)name->length : LONGEST_SHOWN; }

/* Reports a declared name where none may stand, such as that of an object without `object` around it. */
static void tell_declared(struct language *language, const struct name *name, const struct value *named, bool objects,
                          const char *list)
{
  struct value value = *named;
  value.place = name->place;
  value.named = symbol_find(language, name->text, name->length);
  if (objects && value.kind == VALUE_OBJECT)
    language_error(language, name->place, "a declared object stands in object { %.*s }", shown(name), name->text);
  else if (objects || value.kind == VALUE_FOREIGN) symbol_mistaken(language, &value, "an object");
  else language_error(language, name->place, "unexpected name '%.*s'%s", shown(name), name->text, list);
}

/* The message for a statement's word within a block, instead of a list of what was expected: mostly, the block's brace
 * is missing. */
static const char *misplaced(const struct tokens *tokens, const char *text)
{
  const int token = tokens->last.token;
  if (tokens->last.depth == 0 || text[0] == '#' || !words_begin_statement(token)) return NULL;
  const bool object = token == PSCN_TOKEN_BICUBIC_PATCH || token == PSCN_TOKEN_UNION || token == PSCN_TOKEN_OBJECT;
  return object ? "; is a } missing before it?" : ", which stands in no other block; is a } missing before it?";
}

static bool same_place(struct span a, struct span b) { return span_begin(a) > 0 && span_begin(a) == span_begin(b); }

/* Whether a declaration begins with something that POV-Ray can declare and pscn cannot. */
static bool begins_undeclarable(const struct language *language)
{
  const int token = language->tokens->last.token;
  return language->declaration && (token == PSCN_TOKEN_CAMERA || token == PSCN_TOKEN_LIGHT_SOURCE);
}

/* Whether the token before it is a name that is unknown; or, before an opening parenthesis, no macro. Reports that. */
static bool tell_previous(struct language *language)
{
  const struct tokens *tokens = language->tokens;
  if (!same_place(tokens->previous, tokens->word)) return false;
  const struct name name = sources_name(language, tokens->previous);
  const struct value *named = symbol_find(language, name.text, name.length);
  if (named && tokens->last.token != '(') return false;
  struct value value = named ? *named : (struct value){.kind = VALUE_NONE};
  value.place = name.place;
  value.named = named ? symbol_find(language, name.text, name.length) : NULL;
  symbol_mistaken(language, &value, tokens->last.token == '(' ? "a macro" : "a value");
  return true;
}

/* Reports a word that may not stand here, or that is unknown. */
static void tell_word(struct language *language, const struct name *word, const char *const expected[], int count,
                      const char *list)
{
  const struct value *named = symbol_find(language, word->text, word->length);
  if (named) {
    tell_declared(language, word, named, contains(expected, count, "object"), list);
    return;
  }
  const struct guess guess = guess_meant(language, word->text, word->length, expected, count);
  if (guess.best)
    language_error(language, word->place, "unknown word '%.*s'; did you mean '%.*s'?", shown(word), word->text,
                   (int)guess.best_length, guess.best);
  else language_error(language, word->place, "unknown word '%.*s'%s", shown(word), word->text, list);
}

/* Reports a sign, a number or a string that may not stand here, or the end of the text. */
static void tell_unexpected(struct language *language, const struct name *text, const char *list)
{
  const bool outlives = language->tokens->last.token == PSCN_TOKEN_DEFAULT; /* outlives its declaration, used or not */
  if (text->length == 0) language_tell(language, text->place, "the text ends here%s", list);
  else
    (outlives ? language_tell : language_error)(language, text->place, "unexpected '%.*s'%s", shown(text), text->text,
                                                list);
}

/* Writes how the character at `text` is known, if it cannot be seen or typed everywhere; else nothing. */
static void name_character(const char *text, size_t length, char *out, size_t size)
{
  static const struct {
    unsigned code;
    const char *name;
  } unseen[] = {{0xA0, ", a no-break space"},          {0xAD, ", a soft hyphen"},
                {0x200B, ", a zero-width space"},      {0x2028, ", a line separator"},
                {0x202F, ", a narrow no-break space"}, {0xFEFF, ", a byte order mark"},
                {0xFFFC, ", in place of an object"},   {0xFFFD, ", in place of a lost character"}};
  const size_t bytes = source_character(text, length);
  const unsigned first = (unsigned char)text[0];
  unsigned code = bytes < 2 ? first : first & (0x7Fu >> bytes);
  const char *name = "";
  for (size_t k = 1; k < bytes; k++) code = code << 6 | ((unsigned char)text[k] & 0x3F);
  for (int k = 0; k < COUNT(unseen); k++)
    if (unseen[k].code == code) name = unseen[k].name;
  if (bytes == 0) snprintf(out, size, "the byte %02X, which is not UTF-8", first);
  else if (code > ' ' && code < 0x7F) out[0] = '\0';
  else snprintf(out, size, "the character U+%04X%s", code, name);
}

void character_error(struct language *language)
{
  const struct name name = sources_name(language, sources_here(language));
  char character[80];
  name_character(name.text, name.length, character, sizeof character);
  if (character[0] == '\0') language_error(language, name.place, "this means nothing here");
  else language_error(language, name.place, "%s: this means nothing here", character);
}

void letters_error(struct language *language, struct span place)
{
  const struct name name = sources_name(language, place);
  char character[80];
  size_t k = 0;
  while (!((unsigned char)name.text[k] & 0x80)) k++;
  name_character(name.text + k, name.length - k, character, sizeof character);
  language_error(language, place, "%s: names have the letters a to z, A to Z, digits and _", character);
  language->unknown = language->letters = place;
}

void syntax_error(struct language *language, bool is_word, const char *const expected[], int count)
{
  struct tokens *tokens = language->tokens;
  const struct span place = tokens->last.place;
  /* What follows a word just reported as unknown fits the word that was meant. */
  const bool follows = same_place(tokens->previous, language->unknown);
  if (same_place(place, tokens->told) || follows || language_ended(language)) return;
  tokens->told = place;
  const struct name name = sources_name(language, place);
  if (name.length == 0 && tokens->depth > 0) {
    language_tell(language, tokens->braces[tokens->depth - 1], "this brace is not closed");
    return;
  }
  if (same_place(tokens->previous, language->method_name) && solver_item_find(&name)) {
    language_error(language, place, "the items of a solver stand in braces: { %.*s ... }", shown(&name), name.text);
    return;
  }
  language->idle = 0;
  if (words_are_foreign(tokens->last.token)) {
    language_refuses(language, place);
    return;
  }
  if (begins_undeclarable(language)) {
    language_refuses(language, place);
    tokens->recovered = place; /* it does not begin a statement of its own */
    return;
  }
  if (tell_previous(language)) return;
  if (language->lenient && tokens->depth > 0 &&
      span_begin(language->left_out_last) > span_begin(tokens->braces[tokens->depth - 1]))
    return; /* of what was left out in this block, such as the parts of a pattern */
  char list[300] = "";
  const char *misplacement = misplaced(tokens, name.text);
  if (misplacement) snprintf(list, sizeof list, "%s", misplacement);
  else list_expected(expected, count, list, sizeof list);
  if (is_word) tell_word(language, &name, expected, count, list);
  else tell_unexpected(language, &name, list);
}
