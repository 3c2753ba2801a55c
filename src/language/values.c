/* Values and arithmetic, with POV-Ray's promotion: beside a vector a number stands for three of it. */
#include <math.h>

#include "language/build.h"

struct value value_of_number(double x) { return (struct value){VALUE_NUMBER, {x, x, x}}; }

struct value value_of_vector(const double x[3]) { return (struct value){VALUE_VECTOR, {x[0], x[1], x[2]}}; }

struct value value_axis(int axis)
{
  struct value value = {VALUE_VECTOR, {0, 0, 0}};
  value.x[axis] = 1;
  return value;
}

struct value value_pi(void) { return value_of_number(3.14159265358979323846); }

struct value value_named(struct language *language, struct place place, const struct token *name)
{
  const struct symbol *symbol = symbol_find(language, name->text, name->length);
  if (!symbol) symbol_unknown(language, place, name, "a value");
  else if (symbol->kind != SYMBOL_VALUE)
    language_error(language, place, "'%.*s' is %s, but a value is wanted here", (int)name->length, name->text,
                   symbol->kind == SYMBOL_OBJECT ? "an object" : "a texture");
  else return symbol->value;
  return value_of_number(1);
}

struct value value_binary(struct language *language, struct place place, char op, const struct value *a, const struct value *b)
{
  struct value r = {a->kind == VALUE_VECTOR || b->kind == VALUE_VECTOR ? VALUE_VECTOR : VALUE_NUMBER, {0, 0, 0}};
  for (int k = 0; k < 3; k++) { /* a number has its value in all three */
    const double p = a->x[k], q = b->x[k];
    if (op == '/' && q == 0) {
      language_error(language, place, "division by zero");
      return *a;
    }
    r.x[k] = op == '+' ? p + q : op == '-' ? p - q : op == '*' ? p * q : p / q;
    if (!isfinite(r.x[k])) {
      language_error(language, place, "the result is too large for a number");
      return *a;
    }
  }
  return r;
}

struct value value_negative(const struct value *a) { return (struct value){a->kind, {-a->x[0], -a->x[1], -a->x[2]}}; }

struct value value_component(struct language *language, struct place place, const struct value *a, int index)
{
  if (a->kind == VALUE_NUMBER) language_error(language, place, "a number has no components");
  return value_of_number(a->x[index]);
}

struct value value_rgb(const struct value *a) { return value_of_vector(a->x); }

struct value value_vector3(struct language *language, struct place place, const struct value *x, const struct value *y,
                           const struct value *z)
{
  const double v[3] = {value_to_number(language, place, x), value_to_number(language, place, y), value_to_number(language, place, z)};
  return value_of_vector(v);
}

void value_to_vector(const struct value *a, double out[3])
{
  for (int k = 0; k < 3; k++) out[k] = a->x[k];
}

double value_to_number(struct language *language, struct place place, const struct value *a)
{
  if (a->kind == VALUE_VECTOR) language_error(language, place, "a number is wanted here, not a vector");
  return a->x[0];
}

double value_in_range(struct language *language, struct place place, const struct value *a, const char *what, double low,
                      double high, bool whole)
{
  const double x = value_to_number(language, place, a);
  if (x >= low && x <= high && (!whole || x == floor(x))) return x;
  if (a->kind == VALUE_NUMBER) {
    if (isfinite(high)) language_error(language, place, "%s must be %s from %g to %g", what, whole ? "a whole number" : "a number", low, high);
    else language_error(language, place, "%s must be %s of at least %g", what, whole ? "a whole number" : "a number", low);
  }
  return low;
}
