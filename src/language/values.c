/* Values and arithmetic, with POV-Ray's promotion: beside a vector a number stands for three of it, and what a
 * colour takes part in is a colour. */
#include <math.h>

#include "base/number.h"
#include "language/build.h"

#define PI 3.14159265358979323846

static const struct value UNKNOWN = {.kind = VALUE_UNKNOWN, .x = {1, 1, 1}};

struct value value_of_number(double x) { return (struct value){.kind = VALUE_NUMBER, .x = {x, x, x}}; }

struct value value_of_vector(const double x[3])
{
  return (struct value){.kind = VALUE_VECTOR, .x = {x[0], x[1], x[2]}};
}

struct value value_axis(int axis)
{
  struct value value = {.kind = VALUE_VECTOR};
  value.x[axis] = 1;
  return value;
}

struct value value_pi(void) { return value_of_number(PI); }

/* Names of objects and textures are told apart where the value is used: a pigment may be named where a colour may
 * stand. */
struct value value_named(struct language *language, struct place place, const struct token *name)
{
  const struct symbol *symbol = symbol_find(language, name->text, name->length);
  if (!symbol) symbol_unknown(language, place, name, "a value");
  else if (symbol->kind == SYMBOL_VALUE) return symbol->value;
  else if (symbol->kind != SYMBOL_BROKEN) return (struct value){.kind = VALUE_NAMED, .x = {1, 1, 1}, .symbol = symbol};
  return UNKNOWN;
}

/* Whether it can be reckoned with; if not, that has been told. */
static bool usable(struct language *language, struct place place, const struct value *a, const char *wanted)
{
  if (a->kind == VALUE_NAMED) symbol_mistaken(language, place, a->symbol, wanted);
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
static bool stays_opaque(struct language *language, char op, const struct value *a, struct place a_place,
                         const struct value *b, struct place b_place)
{
  const struct place both = language_span(&a_place, &b_place);
  const bool number = a->kind == VALUE_NUMBER || b->kind == VALUE_NUMBER;
  const bool colour = a->kind == VALUE_COLOUR || b->kind == VALUE_COLOUR;
  if (colour && number && (op == '+' || op == '-')) {
    language_error(language, both, "a number added to a colour makes it transparent in POV-Ray; add a vector of three");
    return false;
  }
  if (op == '/' && colour && b->kind != VALUE_NUMBER) {
    language_error(language, both, "this makes a colour infinitely transparent in POV-Ray; divide by a number");
    return false;
  }
  return true;
}

/* Vectors and other colours have no transparency, and a product with none has none. */
static bool result_transparent(char op, const struct value *a, const struct value *b)
{
  if (op == '*' && a->kind != VALUE_NUMBER && b->kind != VALUE_NUMBER) return a->transparent && b->transparent;
  return a->transparent || b->transparent;
}

struct value value_binary(struct language *language, char op, const struct value *a, struct place a_place,
                          const struct value *b, struct place b_place)
{
  const bool a_usable = usable(language, a_place, a, "a value");
  if (!usable(language, b_place, b, "a value") || !a_usable) return UNKNOWN;
  if (!stays_opaque(language, op, a, a_place, b, b_place)) return UNKNOWN;
  struct value r = {.kind = a->kind > b->kind ? a->kind : b->kind, .transparent = result_transparent(op, a, b)};
  for (int k = 0; k < 3; k++) {
    if (op == '/' && b->x[k] == 0) {
      language_error(language, b_place, "division by zero");
      return UNKNOWN;
    }
    r.x[k] = operate(op, a->x[k], b->x[k]);
    if (!isfinite(r.x[k])) {
      language_error(language, language_span(&a_place, &b_place), "the result is too large for a number");
      return UNKNOWN;
    }
  }
  return r;
}

struct value value_negative(struct language *language, struct place place, const struct value *a)
{
  if (!usable(language, place, a, "a value")) return UNKNOWN;
  return (struct value){.kind = a->kind, .x = {-a->x[0], -a->x[1], -a->x[2]}, .transparent = a->transparent};
}

/* A number's components are itself, as in POV-Ray. */
struct value value_component(struct language *language, struct place place, const struct value *a, int index)
{
  return usable(language, place, a, "a vector") ? value_of_number(a->x[index]) : UNKNOWN;
}

/* A number after rgb is three, and after color five. */
struct value value_rgb(struct language *language, struct place place, const struct value *a)
{
  if (!usable(language, place, a, "a colour")) return UNKNOWN;
  return (struct value){.kind = VALUE_COLOUR, .x = {a->x[0], a->x[1], a->x[2]}, .transparent = a->transparent};
}

struct value value_color(struct language *language, struct place place, const struct value *a)
{
  struct value colour = value_rgb(language, place, a);
  colour.transparent |= a->kind == VALUE_NUMBER && a->x[0] != 0;
  return colour;
}

struct value value_of_parts(struct language *language, const struct value *x, const struct value *y,
                            const struct value *z, const struct place places[3])
{
  struct value r = {.kind = VALUE_VECTOR};
  bool known = value_to_number(language, places[0], x, &r.x[0]);
  known &= value_to_number(language, places[1], y, &r.x[1]);
  known &= value_to_number(language, places[2], z, &r.x[2]);
  return known ? r : UNKNOWN;
}

void value_to_vector(struct language *language, struct place place, const struct value *a, double out[3])
{
  if (!usable(language, place, a, "a vector")) return;
  if (a->kind == VALUE_COLOUR) {
    language_error(language, place, "a vector is wanted here, not a colour");
    return;
  }
  for (int k = 0; k < 3; k++) out[k] = a->x[k];
}

void value_to_colour(struct language *language, struct place place, const struct value *a, double out[3])
{
  if (!usable(language, place, a, "a colour")) return;
  for (int k = 0; k < 3; k++) out[k] = a->x[k];
}

void value_to_opaque(struct language *language, struct place place, const struct value *a, double out[3])
{
  if (a->transparent || (a->kind == VALUE_NUMBER && a->x[0] != 0)) {
    language_error(language, place,
                   "a number alone or after color is a transparent colour in POV-Ray; write rgb before it");
    return;
  }
  value_to_colour(language, place, a, out);
}

bool value_to_number(struct language *language, struct place place, const struct value *a, double *out)
{
  if (!usable(language, place, a, "a number")) return false;
  if (a->kind != VALUE_NUMBER) {
    language_error(language, place, "a number is wanted here, not a %s", a->kind == VALUE_COLOUR ? "colour" : "vector");
    return false;
  }
  *out = a->x[0];
  return true;
}

bool value_in_range(struct language *language, struct place place, const struct value *a, const char *what, double low,
                    double high, bool whole, double *out)
{
  double x;
  if (!value_to_number(language, place, a, &x)) return false;
  if (x >= low && x <= high && (!whole || x == floor(x))) {
    *out = x;
    return true;
  }
  const char *number = whole ? "a whole number" : "a number";
  char from[NUMBER_TEXT_SIZE], to[NUMBER_TEXT_SIZE];
  number_write(low, from);
  number_write(high, to);
  if (isfinite(high)) language_error(language, place, "%s must be %s from %s to %s", what, number, from, to);
  else language_error(language, place, "%s must be %s of at least %s", what, number, from);
  return false;
}
