/* Values and arithmetic. */
#include "language/values.h"

#include <float.h>
#include <math.h>
#include <stdio.h>

#include "base/number.h"

struct value value_of_number(double x, struct place place)
{
  return (struct value){.kind = VALUE_NUMBER, .x = {x, x, x}, .place = place};
}

struct value value_of_vector(const double x[3], struct place place)
{
  return (struct value){.kind = VALUE_VECTOR, .x = {x[0], x[1], x[2]}, .place = place};
}

struct value value_axis(int axis, struct place place)
{
  struct value value = {.kind = VALUE_VECTOR, .place = place};
  value.x[axis] = 1;
  return value;
}

struct value value_placed(struct value value, struct place place)
{
  value.place = place;
  return value;
}

static struct value unknown(struct place place)
{
  return (struct value){.kind = VALUE_UNKNOWN, .x = {1, 1, 1}, .place = place};
}

/* Names of objects and textures are told apart where the value is used: a pigment may be named where a colour may
 * stand. */
struct value value_named(struct language *language, const struct token *name)
{
  const struct symbol *symbol = symbol_find(language, name->text, name->length);
  if (symbol && (symbol->kind == SYMBOL_OBJECT || symbol->kind == SYMBOL_TEXTURE))
    return (struct value){.kind = VALUE_NAMED, .x = {1, 1, 1}, .symbol = symbol, .place = name->place};
  symbol = symbol_wanted(language, name, SYMBOL_VALUE, "a value");
  return symbol ? value_placed(symbol->value, name->place) : unknown(name->place);
}

/* Whether it can be reckoned with; if not, that has been told. */
static bool usable(struct language *language, const struct value *a, const char *wanted)
{
  if (a->kind == VALUE_NAMED) symbol_mistaken(language, a->place, a->symbol, wanted);
  return a->kind != VALUE_NAMED && a->kind != VALUE_UNKNOWN;
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

/* A colour has five parts in POV-Ray: what happens to the two that say how transparent it is must leave them 0. */
static bool stays_opaque(struct language *language, char op, const struct value *a, const struct value *b)
{
  const bool number = a->kind == VALUE_NUMBER || b->kind == VALUE_NUMBER;
  const bool colour = a->kind == VALUE_COLOUR || b->kind == VALUE_COLOUR;
  if (colour && number && (op == '+' || op == '-')) {
    language_error(language, language_span(&a->place, &b->place),
                   "a number added to a colour makes it transparent in POV-Ray; add a vector of three");
    return false;
  }
  if (op == '/' && colour && b->kind != VALUE_NUMBER) {
    language_error(language, language_span(&a->place, &b->place),
                   "this makes a colour infinitely transparent in POV-Ray; divide by a number");
    return false;
  }
  return true;
}

/* Vectors and other colours have no transparency, and a product with none has none. */
static unsigned result_transparent(char op, const struct value *a, const struct value *b)
{
  const bool product = op == '*' && a->kind != VALUE_NUMBER && b->kind != VALUE_NUMBER;
  if (product && !(a->transparent && b->transparent)) return 0;
  return a->transparent | b->transparent;
}

struct value value_binary(struct language *language, char op, const struct value *a, const struct value *b)
{
  const struct place place = language_span(&a->place, &b->place);
  const bool a_usable = usable(language, a, "a value");
  if (!usable(language, b, "a value") || !a_usable) return unknown(place);
  if (!stays_opaque(language, op, a, b)) return unknown(place);
  struct value r = {
    .kind = a->kind > b->kind ? a->kind : b->kind, .transparent = result_transparent(op, a, b), .place = place};
  for (int k = 0; k < 3; k++) {
    if (op == '/' && b->x[k] == 0) {
      language_error(language, b->place, "division by zero");
      return unknown(place);
    }
    r.x[k] = operate(op, a->x[k], b->x[k]);
    if (!isfinite(r.x[k])) {
      language_error(language, place, "the result is too large for a number");
      return unknown(place);
    }
  }
  return r;
}

struct value value_negative(struct language *language, const struct value *a, struct place place)
{
  if (!usable(language, a, "a value")) return unknown(place);
  struct value r = value_placed(*a, place);
  for (int k = 0; k < 3; k++) r.x[k] = -a->x[k];
  return r;
}

/* A number's components are itself, as in POV-Ray. */
struct value value_component(struct language *language, const struct value *a, int index, struct place place)
{
  return usable(language, a, "a vector") ? value_of_number(a->x[index], place) : unknown(place);
}

/* A number after rgb is three, and after color five. */
struct value value_rgb(struct language *language, const struct value *a, struct place place)
{
  struct value colour = value_placed(*a, place);
  if (!usable(language, a, "a colour")) return unknown(place);
  colour.kind = VALUE_COLOUR;
  return colour;
}

struct value value_color(struct language *language, const struct value *a, struct place place)
{
  struct value colour = value_rgb(language, a, place);
  if (a->kind == VALUE_NUMBER && a->x[0] != 0) colour.transparent |= TRANSPARENT_NUMBER;
  return colour;
}

struct value value_rgbft(struct language *language, const struct value *a, int parts, struct place place)
{
  struct value colour = value_rgb(language, a, place);
  if (a->kind == VALUE_NUMBER && parts > 3 && a->x[0] != 0) colour.transparent |= TRANSPARENT_SAID;
  if (a->kind == VALUE_VECTOR && parts > 3)
    language_error(language, a->place, "a colour of %d parts is wanted here, this has 3", parts);
  return colour;
}

struct value value_part(struct language *language, const struct value *colour, int part, const struct value *value,
                        struct place place)
{
  const struct value black = {.kind = VALUE_COLOUR};
  double x;
  struct value r = value_rgb(language, colour ? colour : &black, place);
  if (!value_to_number(language, value, &x)) return unknown(place);
  if (part < 3) r.x[part] = x;
  else if (x != 0) r.transparent |= TRANSPARENT_SAID;
  return r;
}

struct value value_wide(struct language *language, const struct value *red, const struct value *green,
                        const struct value *blue, const struct value *filter, const struct value *transmit,
                        struct place place)
{
  struct value r = value_of_parts(language, red, green, blue, place);
  r = value_part(language, &r, 3, filter, place);
  return transmit ? value_part(language, &r, 3, transmit, place) : r;
}

struct value value_of_parts(struct language *language, const struct value *x, const struct value *y,
                            const struct value *z, struct place place)
{
  struct value r = {.kind = VALUE_VECTOR, .place = place};
  bool known = value_to_number(language, x, &r.x[0]);
  known &= value_to_number(language, y, &r.x[1]);
  known &= value_to_number(language, z, &r.x[2]);
  return known ? r : unknown(place);
}

struct value value_flat(struct language *language, struct place place)
{
  language_foreign(language, place, "vectors of two parts are POV-Ray, but pscn has those of three");
  return unknown(place);
}

void value_to_vector(struct language *language, const struct value *a, double out[3])
{
  if (!usable(language, a, "a vector")) return;
  if (a->kind == VALUE_COLOUR) {
    language_error(language, a->place, "a vector is wanted here, not a colour");
    return;
  }
  for (int k = 0; k < 3; k++) out[k] = a->x[k];
}

void value_to_colour(struct language *language, const struct value *a, double out[3])
{
  if (!usable(language, a, "a colour")) return;
  for (int k = 0; k < 3; k++) out[k] = a->x[k];
}

void value_to_opaque(struct language *language, const struct value *a, double out[3])
{
  if (a->transparent & TRANSPARENT_SAID) {
    language_foreign(language, a->place, "this colour is transparent, and what pscn renders is not");
    return;
  }
  if (a->transparent || (a->kind == VALUE_NUMBER && a->x[0] != 0)) {
    language_foreign(language, a->place,
                     "a number alone or after color is a transparent colour in POV-Ray; write rgb before it");
    return;
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
