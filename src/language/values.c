/* Values: arithmetic, strings, colours. */
#include "language/values.h"

#include <float.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "base/number.h"
#include "language/settings.h"
#include "language/sources.h"
#include "scene/scene.h"

struct value *value_of(struct language *language, enum value_kind kind, struct span place)
{
  struct value *value = language->unused;
  if (value) language->unused = value->next;
  else value = language_alloc(language, sizeof *value);
  *value = (struct value){.kind = kind, .place = place};
  return value;
}

/* Its memory is reused for the next value. */
struct value *value_last(struct language *language, struct value *value)
{
  value->next = language->unused;
  return language->unused = value;
}

struct value *value_before(struct value *list, struct value *value)
{
  value->next = list;
  return value;
}

struct value *value_reversed(struct value *list)
{
  struct value *reversed = NULL;
  for (struct value *next; list; list = next) next = list->next, list->next = reversed, reversed = list;
  return reversed;
}

void value_last_of_list(struct language *language, struct value *list)
{
  for (struct value *next; list; list = next) next = list->next, value_last(language, list);
}

void value_set(struct language *language, struct value *to, const struct value *value)
{
  struct array *copy = value->kind == VALUE_ARRAY ? array_copy(language, value->array) : NULL;
  *to = *value;
  to->named = to->next = NULL;
  to->lacks = span_of(0, 0);
  to->component = false;
  if (copy) to->array = copy;
}

void value_set_number(struct value *to, double x) { *to = (struct value){.kind = VALUE_NUMBER, .x = {x}}; }

struct value *value_of_number(struct language *language, double x, struct span place)
{
  struct value *value = value_of(language, VALUE_NUMBER, place);
  value->x[0] = x;
  return value;
}

struct value *value_of_vector(struct language *language, const double x[3], struct span place)
{
  struct value *value = value_of(language, VALUE_VECTOR, place);
  value->parts = 3;
  memcpy(value->x, x, 3 * sizeof *x);
  return value;
}

struct value *value_axis(struct language *language, int axis, struct span place)
{
  return value_of_vector(language, (const double[3]){axis == 0, axis == 1, axis == 2}, place);
}

double value_x(const struct value *a, int k) { return a->x[a->kind == VALUE_NUMBER ? 0 : k]; }

/* The same value at another place. */
static struct value *moved(struct value *value, struct span place)
{
  value->place = place;
  value->named = NULL;
  return value;
}

struct value *value_placed(struct value *value, struct span place)
{
  value->component = false;
  return moved(value, place);
}

/* The value made one of which any use is accepted. */
static struct value *unknown(struct value *value, struct span place)
{
  *value = (struct value){.kind = VALUE_UNKNOWN, .x = {1}, .place = place};
  return value;
}

/* Errors about a name that does not stand for what is wanted come where the value is used. */
struct value *value_named(struct language *language, struct span place)
{
  const struct name name = sources_name(language, place);
  struct value *value = value_of(language, VALUE_NONE, place);
  const struct symbol *symbol = symbol_of(language, name.text, name.length);
  if (!symbol) return value;
  *value = *symbol->value;
  value->place = place;
  value->named = symbol->value;
  value->depth = symbol->depth;
  symbol_lacks(language, value);
  return value;
}

struct value *value_element(struct language *language, struct value *array, struct value *indices, struct span place)
{
  array->next = value_reversed(indices);
  struct value *element = array_element(language, array, array);
  value_last_of_list(language, array->next);
  if (!element) return unknown(array, place);
  const int depth = array->depth;
  *array = *element;
  array->place = place;
  array->named = element;
  array->depth = depth;
  return array;
}

/* Whether the value can be computed with. If not, this has been reported. */
static bool usable(struct language *language, const struct value *a, const char *wanted)
{
  if (a->kind > VALUE_COLOUR) symbol_mistaken(language, a, wanted);
  return a->kind <= VALUE_COLOUR;
}

static bool is_true(double x) { return fabs(x) > VALUE_EQUAL; }

static double operate(char op, double p, double q)
{
  switch (op) {
  case '+': return p + q;
  case '-': return p - q;
  case '*': return p * q;
  case '/': return p / q;
  case '<': return p < q;
  case '>': return p > q;
  case '=': return !is_true(p - q);
  case '!': return is_true(p - q);
  case '[': return p < q || !is_true(p - q);
  case ']': return p > q || !is_true(p - q);
  case '&': return is_true(p) && is_true(q);
  default: return is_true(p) || is_true(q);
  }
}

char comparison_at(const struct language *language, struct span place)
{
  const char sign = sources_name(language, place).text[0];
  return sign == '<' ? '[' : sign == '>' ? ']' : sign;
}

struct value *value_binary(struct language *language, char op, struct value *a, struct value *b)
{
  const bool arithmetic = op == '+' || op == '-' || op == '*' || op == '/';
  const char *wanted = arithmetic ? "a value" : "a number";
  const struct span place = span_join(a->place, b->place);
  value_last(language, b);
  const bool a_usable = usable(language, a, wanted);
  if (!usable(language, b, wanted) || !a_usable) return unknown(a, place);
  const int parts = a->parts > b->parts ? a->parts : b->parts;
  double x[MAX_PARTS] = {0};
  for (int k = 0; k < parts || k == 0; k++) {
    const bool by_zero = op == '/' && value_x(b, k) == 0;
    if (!by_zero) x[k] = operate(op, value_x(a, k), value_x(b, k));
    if (by_zero || !number_in_range(&x[k])) {
      language_error(language, by_zero ? b->place : place,
                     by_zero ? "division by zero" : "the result is larger than 1e100");
      return unknown(a, place);
    }
  }
  memcpy(a->x, x, sizeof x);
  a->component &= b->kind == VALUE_NUMBER;
  a->parts = parts;
  if (b->kind > a->kind) a->kind = b->kind;
  return moved(a, place);
}

struct value *value_unary(struct language *language, char op, struct value *a, struct span place)
{
  if (!usable(language, a, op == '!' ? "a number" : "a value")) return unknown(a, place);
  for (int k = 0; k < MAX_PARTS && op == '-'; k++) a->x[k] = -a->x[k];
  for (int k = 0; k < MAX_PARTS && op == '!'; k++) a->x[k] = !is_true(a->x[k]);
  a->component &= op == '-' || op == '+';
  return moved(a, place);
}

static bool is_chosen(const struct value *condition) { return is_true(condition->x[0]); }

void choice_begin(struct language *language, const struct value *condition)
{
  double x;
  if (!value_to_number(language, condition, &x)) unknown((struct value *)condition, condition->place);
  language->idle += !is_chosen(condition);
}

void choice_else(struct language *language, const struct value *condition)
{
  language->idle += is_chosen(condition) ? 1 : -1;
}

struct value *choice_end(struct language *language, struct value *condition, struct value *a, struct value *b)
{
  const bool first = is_chosen(condition);
  language->idle -= first;
  struct value *chosen = first ? a : b;
  const struct span place = span_join(condition->place, b->place);
  value_last(language, first ? b : a);
  value_last(language, condition);
  return moved(chosen, place);
}

/* The part that x, u, red and so on name, from 0 on. */
static int part_named(const struct language *language, struct span place)
{
  const struct name name = sources_name(language, place);
  switch (name.text[0]) {
  case 'y':
  case 'v':
  case 'g': return 1;
  case 'z':
  case 'b': return 2;
  case 'f': return 3;
  case 't': return name.length == 1 ? 3 : 4;
  default: return 0;
  }
}

int value_numbers(struct language *language, const struct value *list, int most, double out[], bool *out_all)
{
  int count = 0;
  double unused;
  *out_all = true;
  for (; list; list = list->next, count++)
    *out_all &= value_to_number(language, list, count < most ? &out[count] : &unused);
  return count;
}

/* As in POV-Ray, a number's first component is itself, and it has no others; a component has none. */
struct value *value_component(struct language *language, struct value *a, struct span name)
{
  const struct span place = span_join(a->place, name);
  const int part = part_named(language, name);
  if (!usable(language, a, "a vector")) return unknown(a, place);
  if (a->component || (part > 0 && part >= a->parts)) {
    const char *has = a->component ? "a component has none of its own" : "this has no such component";
    language_error(language, place, "%s", has);
    return unknown(a, place);
  }
  const double x = value_x(a, part);
  value_set_number(a, x);
  a->place = place;
  a->component = true;
  return a;
}

struct value *value_of_parts(struct language *language, struct value *list, struct span place)
{
  double x[MAX_PARTS] = {0};
  bool known;
  struct value *parts = value_reversed(list), *vector = value_of(language, VALUE_VECTOR, place);
  const int count = value_numbers(language, parts, MAX_PARTS, x, &known);
  value_last_of_list(language, parts);
  if (count < 2 || count > MAX_PARTS) {
    language_error(language, place, "a vector has two to five parts, but this has %d", count);
    known = false;
  }
  if (!known) return unknown(vector, place);
  memcpy(vector->x, x, sizeof x);
  vector->parts = count;
  return vector;
}

/* ---- strings ---- */

/* The longest string, in bytes. */
enum { LONGEST_STRING = 65536 };

char *string_make(struct language *language, struct value *value, size_t length)
{
  value->kind = VALUE_STRING;
  if (length > LONGEST_STRING) language_limit(language, value->place, "a string has more than 65,536 bytes");
  value->length = length;
  char *text = language_alloc(language, length + 1);
  value->text = text;
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
  size_t length = 0;
  for (size_t k = 1; k + 1 < quoted.length; k++) {
    const bool escape = quoted.text[k] == '\\' && k + 2 < quoted.length;
    to[length++] = escape ? escaped(quoted.text[++k]) : quoted.text[k];
  }
  value->length = length;
  return value;
}

/* ---- colours ---- */

static struct value *become_colour(struct value *a, int parts, struct span place)
{
  if (a->kind == VALUE_NUMBER)
    for (int k = MAX_PARTS - 1; k >= 0; k--) a->x[k] = k < parts ? a->x[0] : 0;
  a->kind = VALUE_COLOUR;
  a->parts = MAX_PARTS;
  return value_placed(a, place);
}

struct value *value_color(struct language *language, struct value *a, struct span place)
{
  return usable(language, a, "a colour") ? become_colour(a, MAX_PARTS, place) : unknown(a, place);
}

/* As in POV-Ray, parts below 0 of an sRGB colour become 0, and the scene's space must be known. */
struct value *value_rgb(struct language *language, struct span word, struct value *a)
{
  const struct span place = span_join(word, a->place);
  const struct name name = sources_name(language, word);
  const bool srgb = name.text[0] == 's';
  if (!usable(language, a, "a colour")) return unknown(a, place);
  const bool no_filter = a->kind != VALUE_COLOUR && memcmp(name.text + name.length - 2, "bt", 2) == 0;
  become_colour(a, (int)name.length - srgb, place);
  if (no_filter) a->x[4] = a->x[3], a->x[3] = 0;
  if (!srgb) return a;
  const struct settings *settings = language->settings;
  if (!settings->gamma_said) {
    language_error(language, place, "srgb needs assumed_gamma before it, in global_settings");
    return unknown(a, place);
  }
  for (int k = 0; k < 3; k++) a->x[k] = gamma_of_srgb(settings->gamma, fmax(a->x[k], 0));
  return a;
}

struct value *value_part(struct language *language, struct value *colour, struct span part, struct value *value)
{
  double x;
  if (!colour) colour = value_of(language, VALUE_COLOUR, part);
  const struct span place = span_join(colour->place, value->place);
  value_last(language, value);
  if (colour->kind == VALUE_NUMBER || colour->kind == VALUE_VECTOR) {
    language_error(language, colour->place,
                   "red, green, blue, filter and transmit follow a colour: write rgb before this, or a comma after it");
    return unknown(colour, place);
  }
  if (!usable(language, colour, "a colour") || !value_to_number(language, value, &x)) return unknown(colour, place);
  colour->x[part_named(language, part)] = x;
  return become_colour(colour, 0, place);
}

/* ---- conversions ---- */

void value_to_vector(struct language *language, const struct value *a, double out[3])
{
  if (a->kind > VALUE_VECTOR) symbol_mistaken(language, a, "a vector");
  else if (a->parts > 3) language_error(language, a->place, "expected a vector of three parts, not of %d", a->parts);
  else if (a->component) /* in POV-Ray the other parts are those of the value that it is a component of */
    language_error(language, a->place,
                   "POV-Ray does not use a component for all parts of a vector; put this in parentheses");
  else
    for (int k = 0; k < 3; k++) out[k] = value_x(a, k);
}

bool value_to_number(struct language *language, const struct value *a, double *out)
{
  if (a->kind == VALUE_NUMBER) {
    *out = a->x[0];
    return true;
  }
  symbol_mistaken(language, a, "a number");
  return false;
}

bool value_is_float(double x) { return fabs(x) <= (double)FLT_MAX; }

void value_to_colour(struct language *language, const struct value *a, double out[3])
{
  if (!usable(language, a, "a colour")) return;
  for (int k = 0; k < 3; k++) {
    if (!value_is_float(value_x(a, k))) {
      language_error(language, a->place, "a colour's parts must be from -3.4e38 to 3.4e38");
      return;
    }
  }
  for (int k = 0; k < 3; k++) out[k] = value_x(a, k);
}

void value_to_opaque(struct language *language, const struct value *a, double out[3])
{
  if (a->kind <= VALUE_COLOUR && (value_x(a, 3) != 0 || value_x(a, 4) != 0))
    language_lacks(language, a->place, a->place);
  value_to_colour(language, a, out);
}

bool value_in_range(struct language *language, const struct value *a, const char *what, double low, double high,
                    bool whole, double *out)
{
  double x;
  char range[RANGE_TEXT_SIZE];
  if (!value_to_number(language, a, &x)) return false;
  if (x >= low && x <= high && (!whole || x == floor(x))) {
    *out = x;
    return true;
  }
  range_text(low, high, whole, range);
  language_error(language, a->place, "%s must be %s", what, range);
  return false;
}

void range_text(double low, double high, bool whole, char out[RANGE_TEXT_SIZE])
{
  const char *number = whole ? "a whole number" : "a number";
  char from[NUMBER_TEXT_SIZE], to[NUMBER_TEXT_SIZE];
  number_write(low, from);
  number_write(high, to);
  if (low == DBL_MIN) snprintf(out, RANGE_TEXT_SIZE, "%s above 0 and up to %s", number, to);
  else if (isfinite(high)) snprintf(out, RANGE_TEXT_SIZE, "%s from %s to %s", number, from, to);
  else snprintf(out, RANGE_TEXT_SIZE, "%s of at least %s", number, from);
}
