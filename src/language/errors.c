/* Errors of one reading, what it leaves out, and the text of syntax errors. */
#include "language/state.h"

#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include "language/scan.h"
#include "language/settings.h"
#include "language/sources.h"
#include "language/tokens.h"
#include "language/words.h"

enum { MOST_AROUND = 8 };

static void tell(struct language *language, struct span place, const char *format, va_list arguments)
{
  char message[400];
  struct diagnostics_around around[MOST_AROUND];
  struct diagnostics *diagnostics = language->diagnostics;
  vsnprintf(message, sizeof message, format, arguments);
  const size_t count = language->sources->again > 0 ? sources_around(language, around, MOST_AROUND) : 0;
  const size_t shown = count < MOST_AROUND ? count : MOST_AROUND;
  diagnostics->around = around + MOST_AROUND - shown;
  diagnostics->around_count = shown;
  diagnostics_error(diagnostics, sources_place(language, place), "%s", message);
  diagnostics->around_count = 0;
}

void language_tell(struct language *language, struct span place, const char *format, ...)
{
  va_list arguments;
  va_start(arguments, format);
  tell(language, place, format, arguments);
  va_end(arguments);
}

void language_error(struct language *language, struct span place, const char *format, ...)
{
  va_list arguments;
  if (language->idle > 0) return;
  va_start(arguments, format);
  tell(language, place, format, arguments);
  va_end(arguments);
}

/* ---- what is not supported ---- */

struct left_out {
  struct left_out *before;
  char word[40]; /* POV-Ray's are shorter */
  struct span place;
  size_t times;
};

/* Counts it. Returns how often it has been left out before. */
static size_t leave_out(struct language *language, struct span place, const struct name *name)
{
  struct left_out *left = language->left_out;
  while (left && words_compare(name->text, name->length, left->word) != 0) left = left->before;
  if (!left) {
    left = language_alloc(language, sizeof *left);
    *left = (struct left_out){.before = language->left_out, .place = place};
    snprintf(left->word, sizeof left->word, "%.*s", (int)name->length, name->text);
    language->left_out = left;
  }
  return left->times++;
}

void language_lacks(struct language *language, struct span place, struct span what)
{
  static const char colour[] = "a transparent colour";
  char where[300] = "";
  if (language->idle > 0) return;
  language->left_out_last = place;
  if (language->declaration) {
    if (span_begin(language->declaration->lacks) == 0) language->declaration->lacks = what;
    return;
  }
  if (place.ends != what.ends) {
    const struct place declared = sources_place(language, what);
    const size_t line = source_locate(declared.source, declared.begin).line; /* recalls the text */
    snprintf(where, sizeof where, " (%s:%zu)", declared.source->name, line);
  }
  struct name name = sources_name(language, what);
  const int token = words_token(name.text, name.length);
  const bool is_word = token != PSCN_TOKEN_WORD, refused = token == PSCN_TOKEN_REFUSED;
  const bool own = token == PSCN_TOKEN_CAMERA || token == PSCN_TOKEN_LIGHT_SOURCE;
  const char *instead = is_word ? words_instead(name.text, name.length) : "rgb <R, G, B>";
  if (!is_word) name.text = colour, name.length = sizeof colour - 1;
  if (leave_out(language, place, &name) > 0 || (language->lenient && !refused)) return;
  language_error(language, place, "%s%.*s%s is not supported%s%s%s",
                 own       ? "a declared "
                 : is_word ? "POV-Ray's "
                           : "",
                 (int)name.length, name.text, where, *instead ? "; use " : "", instead,
                 refused    ? ""
                 : *instead ? ", or --lenient to leave it out"
                            : "; use --lenient to leave it out");
}

void language_tell_left_out(struct language *language)
{
  struct left_out *first = NULL;
  if (!language->lenient) return;
  for (struct left_out *left = language->left_out, *before; left; left = before)
    before = left->before, left->before = first, first = left;
  for (const struct left_out *left = first; left; left = left->before) {
    char times[40] = "";
    if (left->times > 1) snprintf(times, sizeof times, ", in %zu places", left->times);
    diagnostics_warning(language->diagnostics, sources_place(language, left->place), "%s is left out%s", left->word,
                        times);
  }
}

struct block language_block(const struct language *language, struct span place)
{
  return (struct block){place, language->diagnostics->error_count};
}

bool language_sound(const struct language *language, const struct block *block)
{
  return language->diagnostics->error_count == block->errors;
}

void language_error_in(struct language *language, const struct block *block, struct span place, const char *text)
{
  if (language_sound(language, block)) language_error(language, place, "%s", text);
}

void language_limit(struct language *language, struct span place, const char *text)
{
  language_tell(language, place, "%s", text);
  language->limit_told = true;
  language_end(language, STATUS_LIMIT);
}

/* ---- the text of syntax errors ---- */

enum { LONGEST_SHOWN = 40 };

static bool contains(const char *const names[], int count, const char *wanted)
{
  for (int k = 0; k < count; k++)
    if (strcmp(names[k], wanted) == 0) return true;
  return false;
}

/* Whether an error names it among what could have stood there: it is no word or sign that may stand nearly anywhere, nor
 * a value's if "a value" stands for all of them. */
static bool is_listed(const char *name, bool value, bool compared)
{
  if (name[0] == '\'')
    return strchr("(){}];:=", name[1]) && !(value && name[1] == '(') && !(compared && name[1] == '=');
  if (name[0] == 'a' && name[1] == ' ') return !value;
  return name[0] >= 'a' && words_begin_item(words_token(name, strlen(name)));
}

/* Lists what could have stood there. Empty if that is too much to help. */
static void list_expected(const char *const expected[], int count, char *out, size_t size)
{
  enum { MOST_LISTED = 10 };
  const char *list[MOST_LISTED];
  int listed = 0;
  const bool value = contains(expected, count, "a constant"), objects = contains(expected, count, "object");
  const bool compared = contains(expected, count, "'&'");
  if (value) list[listed++] = "a value";
  for (int k = 0; k < count; k++) {
    if (count > 1 && !is_listed(expected[k], value, compared)) continue;
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
    if (expected[k][0] < 'a' || expected[k][1] == ' ') continue;
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
    language_error(language, name->place, "a declared object must be in object { %.*s }", shown(name), name->text);
  else if (objects || value.kind == VALUE_UNKNOWN) symbol_mistaken(language, &value, "an object");
  else language_error(language, name->place, "unexpected name '%.*s'%s", shown(name), name->text, list);
}

/* The message for a statement's word within a block, instead of a list of what was expected: mostly, the block's brace
 * is missing. */
static const char *misplaced(const struct tokens *tokens, const char *text)
{
  const int token = tokens->last.token;
  if (tokens->last.depth == 0 || text[0] == '#' || !words_begin_statement(token)) return NULL;
  const bool object = token == PSCN_TOKEN_BICUBIC_PATCH || token == PSCN_TOKEN_UNION || token == PSCN_TOKEN_OBJECT;
  return object ? "; is a } missing before it?" : ", which must be outside all blocks; is a } missing before it?";
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

void character_error(struct language *language)
{
  const struct name name = sources_name(language, sources_here(language));
  const size_t bytes = source_character(name.text, name.length);
  const unsigned first = (unsigned char)name.text[0];
  unsigned code = bytes < 2 ? first : first & (0x7Fu >> bytes);
  for (size_t k = 1; k < bytes; k++) code = code << 6 | ((unsigned char)name.text[k] & 0x3F);
  if (bytes == 0) language_error(language, name.place, "unexpected byte %02X, which is not UTF-8", first);
  else if (code > ' ' && code < 0x7F) language_error(language, name.place, "unexpected character");
  else language_error(language, name.place, "unexpected character U+%04X", code);
}

void syntax_error(struct language *language, bool is_word, const char *const expected[], int count)
{
  struct tokens *tokens = language->tokens;
  const struct span place = tokens->last.place;
  /* What follows a word just reported as unknown fits the word that was meant. */
  const bool follows = same_place(tokens->previous, language->unknown);
  if (same_place(place, tokens->told) || follows) return;
  tokens->told = place;
  const struct name name = sources_name(language, place);
  if (name.length == 0 && tokens->depth > 0) {
    language_tell(language, tokens->braces[tokens->depth - 1], "this brace is not closed");
    return;
  }
  if (same_place(tokens->previous, language->method_name) && solver_item_find(&name)) {
    language_error(language, place, "the items of a solver must be in braces: { %.*s ... }", shown(&name), name.text);
    return;
  }
  language->idle = 0;
  const bool undeclarable = begins_undeclarable(language);
  if (undeclarable) tokens->recovered = place; /* it does not begin a statement of its own */
  if (undeclarable || words_are_foreign(tokens->last.token)) {
    language_lacks(language, place, place);
    return;
  }
  if (tell_previous(language)) return;
  if (tokens->depth > 0 && span_begin(language->left_out_last) > span_begin(tokens->braces[tokens->depth - 1]))
    return; /* of what was left out in this block, such as the parts of a pattern */
  char list[300] = "";
  const char *misplacement = misplaced(tokens, name.text);
  if (misplacement) snprintf(list, sizeof list, "%s", misplacement);
  else list_expected(expected, count, list, sizeof list);
  if (is_word) tell_word(language, &name, expected, count, list);
  else tell_unexpected(language, &name, list);
}
