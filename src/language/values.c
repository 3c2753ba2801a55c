/* Values and arithmetic. */
#include "language/values.h"

#include <float.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "base/number.h"
#include "language/settings.h"
#include "language/arrays.h"
#include "language/sources.h"
#include "scene/gamma.h"

/* POV-Ray's, absolute: numbers nearer than that are equal. */
#define EQUAL 1e-10

struct value *value_of(struct language *language, enum value_kind kind, struct span place)
{
  struct value *value = language->unused;
  if (value) language->unused = value->next;
  else value = language_alloc(language, sizeof *value);
  *value = (struct value){.kind = kind, .place = place};
  return value;
}

/* Its memory is reused for the next value, unless it is the spare block. */
struct value *value_last(struct language *language, struct value *value)
{
  if (language->ended_early) return value;
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
  to->component = to->wide = to->bare = false;
  to->open = to->kind == VALUE_VECTOR;
  if (copy) to->array = copy;
}

static struct value *set(struct value *value, double x, double y, double z)
{
  value->x[0] = x, value->x[1] = y, value->x[2] = z;
  return value;
}

struct value *value_of_number(struct language *language, double x, struct span place)
{
  return set(value_of(language, VALUE_NUMBER, place), x, x, x);
}

struct value *value_of_vector(struct language *language, const double x[3], struct span place)
{
  return set(value_of(language, VALUE_VECTOR, place), x[0], x[1], x[2]);
}

struct value *value_axis(struct language *language, int axis, struct span place)
{
  struct value *value = set(value_of(language, VALUE_VECTOR, place), axis == 0, axis == 1, axis == 2);
  value->open = true;
  return value;
}

/* The same value at another place. */
static struct value *value_moved(struct value *value, struct span place)
{
  value->place = place;
  value->named = NULL;
  return value;
}

struct value *value_placed(struct value *value, struct span place)
{
  value->component = value->open = value->wide = false;
  return value_moved(value, place);
}

static struct value *become_unknown(struct value *value, struct span place)
{
  *value = (struct value){.kind = VALUE_UNKNOWN, .x = {1, 1, 1}, .place = place};
  return value;
}

/* Errors about a name that does not stand for what is wanted come where the value is used. */
struct value *value_named(struct language *language, struct span place)
{
  const struct name name = sources_name(language, place);
  struct value *value = value_of(language, VALUE_NONE, place);
  const struct symbol *symbol = symbol_of(language, name.text, name.length);
  const bool told = language->letters.ends == place.ends; /* for its letters */
  if (!symbol) return told ? become_unknown(value, place) : value;
  *value = *symbol->value;
  value->place = place;
  value->named = symbol->value;
  value->depth = symbol->depth;
  if (value->kind != VALUE_FOREIGN && span_begin(value->lacks) > 0) language_left_out(language, value->lacks);
  return value;
}

struct value *value_element(struct language *language, struct value *array, struct value *indices, struct span place)
{
  array->next = value_reversed(indices);
  struct value *element = array_element(language, array, array);
  value_last_of_list(language, array->next);
  if (!element) return become_unknown(array, place);
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

static double operate(char op, double p, double q)
{
  switch (op) {
  case '+': return p + q;
  case '-': return p - q;
  case '*': return p * q;
  default: return p / q;
  }
}

/* A colour has five parts in POV-Ray. An operation must leave the two that say how transparent it is 0. */
static bool stays_opaque(struct language *language, char op, const struct value *a, const struct value *b)
{
  const bool number = a->kind == VALUE_NUMBER || b->kind == VALUE_NUMBER;
  const bool colour = a->kind == VALUE_COLOUR || b->kind == VALUE_COLOUR;
  if (colour && number && (op == '+' || op == '-')) {
    language_error(language, span_join(a->place, b->place),
                   "a number added to a colour makes it transparent in POV-Ray; add a vector of three");
    return false;
  }
  if (op == '/' && colour && b->kind != VALUE_NUMBER) {
    language_error(language, span_join(a->place, b->place),
                   "this makes a colour infinitely transparent in POV-Ray; divide by a number");
    return false;
  }
  if (a->kind == VALUE_COLOUR && b->wide && (op == '+' || op == '-')) {
    language_error(language, b->place, "behind a colour this makes it transparent in POV-Ray; put it in parentheses");
    return false;
  }
  return true;
}

/* Behind a colour, POV-Ray wants five parts of all that follows. A number has five. An axis, or a named vector, is
 * taken for five although it has three; the other two are left over from the numbers before it. Those of other vectors
 * are 0, by which nothing may be divided. */
static bool result_wide(char op, const struct value *a, const struct value *b)
{
  if (op == '+' || op == '-') return false;
  return a->wide || (op == '/' ? b->kind == VALUE_VECTOR : a->kind == VALUE_NUMBER && b->open);
}

/* Vectors and opaque colours have no transparency, nor has a product with one of them. */
static unsigned result_transparent(char op, const struct value *a, const struct value *b)
{
  const bool product = op == '*' && a->kind != VALUE_NUMBER && b->kind != VALUE_NUMBER;
  if (product && !(a->transparent && b->transparent)) return 0;
  return a->transparent | b->transparent;
}

struct value *value_binary(struct language *language, char op, struct value *a, struct value *b)
{
  const struct span place = span_join(a->place, b->place);
  value_last(language, b);
  if (a->kind == VALUE_NUMBER && b->kind == VALUE_NUMBER) { /* the usual case */
    double x = operate(op, a->x[0], b->x[0]);
    if (number_in_range(&x)) return value_moved(set(a, x, x, x), place);
  }
  const bool a_usable = usable(language, a, "a value");
  if (!usable(language, b, "a value") || !a_usable || !stays_opaque(language, op, a, b))
    return become_unknown(a, place);
  const bool wide = result_wide(op, a, b);
  a->transparent = result_transparent(op, a, b);
  if (b->kind > a->kind) a->kind = b->kind;
  for (int k = 0; k < 3; k++) {
    if (op == '/' && b->x[k] == 0) {
      language_error(language, b->place, "division by zero");
      return become_unknown(a, place);
    }
    a->x[k] = operate(op, a->x[k], b->x[k]);
    if (!number_in_range(&a->x[k])) {
      language_error(language, place, "the result is larger than 1e100");
      return become_unknown(a, place);
    }
  }
  value_placed(a, place);
  a->wide = wide;
  return a;
}

static bool is_true(double x) { return fabs(x) > EQUAL; }

static double compare(int op, double p, double q)
{
  switch (op) {
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

int comparison_at(const struct language *language, struct span place)
{
  const char sign = sources_name(language, place).text[0];
  return sign == '<' ? '[' : sign == '>' ? ']' : sign;
}

struct value *value_compared(struct language *language, int op, struct value *a, struct value *b)
{
  const struct span place = span_join(a->place, b->place);
  value_last(language, b);
  const bool a_usable = usable(language, a, "a number");
  if (!usable(language, b, "a number") || !a_usable) return become_unknown(a, place);
  if (b->kind > a->kind) a->kind = b->kind;
  for (int k = 0; k < 3; k++) a->x[k] = compare(op, a->x[k], b->x[k]);
  return value_placed(a, place);
}

struct value *value_not(struct language *language, struct value *a, struct span place)
{
  if (!usable(language, a, "a number")) return become_unknown(a, place);
  return value_placed(set(a, !is_true(a->x[0]), !is_true(a->x[1]), !is_true(a->x[2])), place);
}

static bool is_chosen(const struct value *condition) { return is_true(condition->x[0]); }

void choice_begin(struct language *language, const struct value *condition)
{
  double x;
  if (!value_to_number(language, condition, &x)) become_unknown((struct value *)condition, condition->place);
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
  chosen->place = place;
  chosen->named = NULL;
  return chosen;
}

struct value *value_negative(struct language *language, struct value *a, struct span place)
{
  if (!usable(language, a, "a value")) return become_unknown(a, place);
  return value_moved(set(a, -a->x[0], -a->x[1], -a->x[2]), place);
}

struct value *value_positive(struct language *language, struct value *a, struct span place)
{
  return usable(language, a, "a value") ? value_moved(a, place) : become_unknown(a, place);
}

struct value *value_alone(struct language *language, struct value *a, struct span place)
{
  return usable(language, a, "a value") ? value_placed(a, place) : become_unknown(a, place);
}

/* As in POV-Ray, a number's first component is itself, and it has no others; a component has none. */
struct value *value_component(struct language *language, struct value *a, int index, struct span name)
{
  const struct span place = span_join(a->place, name);
  if (!usable(language, a, "a vector")) return become_unknown(a, place);
  if (a->component || (a->kind == VALUE_NUMBER && index > 0)) {
    const char *has = a->component ? "a component has none of its own" : "a number has no such component";
    language_error(language, place, "%s", has);
    return become_unknown(a, place);
  }
  a->kind = VALUE_NUMBER;
  a->transparent = 0;
  value_placed(set(a, a->x[index], a->x[index], a->x[index]), place);
  a->component = true;
  return a;
}

/* A number after rgb stands for three parts, and after color for five. */
struct value *value_rgb(struct language *language, struct value *a, struct span place)
{
  if (!usable(language, a, "a colour")) return become_unknown(a, place);
  a->kind = VALUE_COLOUR;
  return value_placed(a, place);
}

struct value *value_color(struct language *language, struct value *a, struct span place)
{
  if (a->kind == VALUE_NUMBER && a->x[0] != 0) a->transparent |= TRANSPARENT_NUMBER;
  return value_rgb(language, a, place);
}

struct value *value_rgbft(struct language *language, struct value *a, int parts, struct span place)
{
  if (a->kind == VALUE_NUMBER && a->x[0] != 0) a->transparent |= TRANSPARENT_SAID;
  if (a->kind == VALUE_VECTOR)
    language_error(language, a->place, "a colour of %d parts is wanted here, this has 3", parts);
  return value_rgb(language, a, place);
}

/* As in POV-Ray, parts below 0 become 0, and the scene's space must be known. */
struct value *value_srgb(struct language *language, struct span word, struct value *colour)
{
  const struct settings *settings = language->settings;
  value_placed(colour, span_join(word, colour->place));
  if (colour->kind == VALUE_UNKNOWN) return colour;
  if (!settings->gamma_said) {
    language_error(language, colour->place, "srgb wants assumed_gamma before it, in global_settings");
    return become_unknown(colour, colour->place);
  }
  for (int k = 0; k < 3; k++) colour->x[k] = gamma_of_srgb(settings->gamma, fmax(colour->x[k], 0));
  return colour;
}

struct value *value_part(struct language *language, struct value *colour, int part, struct value *value,
                         struct span place)
{
  double x;
  if (!colour) colour = value_of(language, VALUE_COLOUR, place);
  value_last(language, value);
  if (colour->kind == VALUE_NUMBER || colour->kind == VALUE_VECTOR) {
    language_error(
      language, colour->place,
      "red, green, blue, filter and transmit follow a colour: write rgb before this, or a comma behind it");
    return become_unknown(colour, place);
  }
  value_rgb(language, colour, place);
  if (!value_to_number(language, value, &x)) return become_unknown(colour, place);
  if (part < 3) colour->x[part] = x;
  else if (x != 0) colour->transparent |= TRANSPARENT_SAID;
  return colour;
}

struct value *value_bare_part(struct language *language, struct value *colour, int part, struct value *value,
                              struct span place)
{
  colour = value_part(language, colour, part, value, place);
  colour->bare = colour->kind == VALUE_COLOUR;
  return colour;
}

struct value *value_wide(struct language *language, struct value *red, struct value *green, struct value *blue,
                         struct value *filter, struct value *transmit, struct span place)
{
  struct value *value = value_rgb(language, value_of_parts(language, red, green, blue, place), place);
  value = value_part(language, value, 3, filter, place);
  return transmit ? value_part(language, value, 3, transmit, place) : value;
}

struct value *value_of_parts(struct language *language, struct value *x, struct value *y, struct value *z,
                             struct span place)
{
  bool known = value_to_number(language, x, &x->x[0]);
  known &= value_to_number(language, y, &x->x[1]);
  known &= value_to_number(language, z, &x->x[2]);
  value_last(language, y);
  value_last(language, z);
  if (!known) return become_unknown(x, place);
  x->kind = VALUE_VECTOR;
  return value_placed(x, place);
}

struct value *value_flat(struct language *language, struct value *x, struct value *y, struct span place)
{
  language_refuses(language, place);
  value_last(language, y);
  return become_unknown(x, place);
}

void value_to_vector(struct language *language, const struct value *a, double out[3])
{
  if (!usable(language, a, "a vector")) return;
  if (a->kind == VALUE_COLOUR) {
    language_error(language, a->place, "a vector is wanted here, not a colour");
    return;
  }
  if (a->kind == VALUE_NUMBER && a->component) { /* in POV-Ray the other parts are those of the value that it is a
                                                    component of */
    language_error(language, a->place,
                   "POV-Ray makes another vector of a component than of a number; put this in parentheses");
    return;
  }
  for (int k = 0; k < 3; k++) out[k] = a->x[k];
}

bool value_is_float(double x) { return fabs(x) <= (double)FLT_MAX; }

void value_to_colour(struct language *language, const struct value *a, double out[3])
{
  if (!usable(language, a, "a colour")) return;
  for (int k = 0; k < 3; k++) {
    if (!value_is_float(a->x[k])) {
      language_error(language, a->place, "a colour's parts must be from -3.4e38 to 3.4e38");
      return;
    }
  }
  memcpy(out, a->x, sizeof a->x);
}

void value_to_opaque(struct language *language, const struct value *a, double out[3])
{
  const bool number = !(a->transparent & TRANSPARENT_SAID) && a->kind == VALUE_NUMBER && a->x[0] != 0;
  if (a->transparent || number) {
    static const char what[] = "a transparent colour";
    language_lacks(language, a->place, &(struct name){a->place, what, sizeof what - 1},
                   a->transparent & TRANSPARENT_SAID
                     ? "what is rendered is opaque"
                     : "a number alone or after color is one in POV-Ray, write rgb before it");
  }
  value_to_colour(language, a, out);
}

bool value_to_number(struct language *language, const struct value *a, double *out)
{
  if (!usable(language, a, "a number")) return false;
  if (a->kind != VALUE_NUMBER) {
    const char *is = a->kind == VALUE_COLOUR ? "colour" : "vector";
    language_error(language, a->place, "a number is wanted here, not a %s", is);
    return false;
  }
  *out = a->x[0];
  return true;
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
