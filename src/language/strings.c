/* Strings, and the directives that print them. */
#include "language/strings.h"

#include <stdio.h>
#include <string.h>

#include "language/sources.h"
#include "language/tokens.h"

char *string_make(struct language *language, struct value *value, size_t length)
{
  value->kind = VALUE_STRING;
  value->text = "";
  value->length = 0;
  if (length > LONGEST_STRING) {
    language_limit(language, value->place, "a string has more than 65,536 bytes");
    return NULL;
  }
  char *text = language_afford(language, length) ? arena_alloc(language->arena, length + 1, 1) : NULL;
  if (!text) {
    language->ended_early = true;
    return NULL;
  }
  value->text = text;
  value->length = length;
  return text;
}

/* The character for which a \ and this letter stand; others stand for themselves. */
static char escaped(char letter)
{
  static const char letters[] = "abfnrtv0", meant[] = "\a\b\f\n\r\t\v";
  const char *at = letter == '\0' ? NULL : strchr(letters, letter);
  return at ? meant[at - letters] : letter;
}

struct value *value_of_string(struct language *language, struct span place)
{
  struct value *value = value_of(language, VALUE_STRING, place);
  const struct name quoted = sources_name(language, place);
  char *to = string_make(language, value, quoted.length < 2 ? 0 : quoted.length - 2);
  if (!to) return value;
  size_t length = 0;
  for (size_t k = 1; k + 1 < quoted.length; k++) {
    const bool escape = quoted.text[k] == '\\' && k + 2 < quoted.length;
    to[length++] = escape ? escaped(quoted.text[++k]) : quoted.text[k];
  }
  value->length = length;
  return value;
}

void string_add_number(double x, double length, double precision, char *text, size_t size, size_t *used)
{
  enum { WIDEST = 300, FINEST = 100 };
  const int digits = precision < 0 ? 6 : precision > FINEST ? FINEST : (int)precision;
  const int width = length > WIDEST ? WIDEST : length < -WIDEST ? -WIDEST : (int)length;
  char *to = text + *used;
  const size_t room = size - *used;
  const int written = width < 0 ? snprintf(to, room, "%0*.*f", -width, digits, x)
                                : snprintf(to, room, "%*.*f", width, digits, x);
  const size_t count = (size_t)written < room ? (size_t)written : room - 1;
  for (size_t k = 0; k < count; k++) /* the point of another locale */
    if (to[k] == ',') to[k] = '.';
  *used += count;
}

/* ---- messages ---- */

/* The lines that a stranger's #debug may print; a loop could fill a disk with them. */
enum { UNTRUSTED_LINES = 1000 };

/* The begun line of #debug. */
struct messages {
  char text[1000];
  size_t used, lines;
};

static void print_line(struct language *language)
{
  struct messages *messages = language->messages;
  if (!language->untrusted || messages->lines++ < UNTRUSTED_LINES)
    diagnostics_print(language->diagnostics, messages->text, messages->used);
  messages->used = 0;
}

static void debug(struct language *language, const struct value *value)
{
  if (!language->messages) language->messages = language_alloc(language, sizeof *language->messages);
  struct messages *messages = language->messages;
  if (language->ended_early) return; /* it may be the spare block */
  for (size_t k = 0; k < value->length; k++) {
    if (value->text[k] != '\n') messages->text[messages->used++] = value->text[k];
    if (value->text[k] == '\n' || messages->used == sizeof messages->text) print_line(language);
  }
}

void messages_end(struct language *language)
{
  if (language->messages && language->messages->used > 0) print_line(language);
}

void message_pass(struct language *language, int directive)
{
  const struct span place = sources_here(language);
  struct value *value = NULL;
  const bool whole = tokens_parse(language, PSCN_TOKEN_START_STRING, &value);
  if (whole && value->kind != VALUE_STRING) {
    symbol_mistaken(language, value, "a string");
  } else if (whole) {
    const int length = (int)value->length;
    if (directive == TOKEN_DEBUG) debug(language, value);
    else if (directive == TOKEN_WARNING)
      diagnostics_warning(language->diagnostics, sources_place(language, place), "%.*s", length, value->text);
    else {
      language_tell(language, place, "%.*s", length, value->text);
      language->stopped = true;
    }
  }
  value_last_of_list(language, value);
}
