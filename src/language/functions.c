/* Functions of numbers, vectors, strings and arrays. */
#include "language/values.h"

#include <limits.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "base/number.h"
#include "geometry/transform.h"
#include "geometry/vector.h"
#include "language/settings.h"
#include "language/sources.h"

#define PI 3.14159265358979323846

/* ---- functions of numbers ---- */

static double degrees(double x) { return x * (180 / PI); }
static double radians(double x) { return x * (PI / 180); }
static double quotient(double x, double y) { return trunc(x / y); }
static double arc(double y, double x) { return y == 0 && x == 0 ? (double)NAN : atan2(y, x); }
static double lesser(double x, double y) { return x < y ? x : y; }
static double greater(double x, double y) { return x > y ? x : y; }
/* As in C, but no number for what POV-Ray refuses. */
static double power(double x, double y) { return x == 0 && y == 0 ? (double)NAN : pow(x, y); }

/* ---- arguments ---- */

/* A call: what a function reads from its arguments, one after another. False once one was not what is wanted. */
struct call {
  struct language *language;
  const struct value *next;
  bool fits;
  struct value *out; /* the result, so far the number 0 */
};

static double number(struct call *call)
{
  double x = 0;
  call->fits = call->fits && value_to_number(call->language, call->next, &x);
  call->next = call->next->next;
  return x;
}

static void vector(struct call *call, double out[3])
{
  const struct value *value = call->next;
  memset(out, 0, 3 * sizeof *out);
  call->fits = call->fits && value->kind != VALUE_UNKNOWN;
  if (call->fits) value_to_vector(call->language, value, out);
  call->fits = call->fits && value->kind <= VALUE_VECTOR;
  call->next = value->next;
}

static const struct value *of_kind(struct call *call, enum value_kind kind, const char *wanted)
{
  const struct value *value = call->next;
  if (call->fits && value->kind != kind) symbol_mistaken(call->language, value, wanted);
  call->fits = call->fits && value->kind == kind;
  call->next = value->next;
  return value;
}

/* ---- functions of anything else: they return a number, NAN if there is none, or make something else of call->out ---- */

/* The most generators of random numbers. */
enum { MOST_GENERATORS = 1000000 };

/* Begins a generator, and returns its number. Its state is a C cast of the argument, as on POV-Ray's machines: what is
 * too large for an int is the least one. */
static double seed(struct call *call)
{
  struct language *language = call->language;
  struct growing *states = &language->randoms;
  const double x = number(call);
  language_afford(language, sizeof(uint32_t));
  uint32_t *state = states->count < MOST_GENERATORS ? growing_add(states, 1, sizeof *state) : NULL;
  if (!state) language_end(language, STATUS_LIMIT);
  *state = x > -2147483649.0 && x < 2147483648.0 ? (uint32_t)(int32_t)x : UINT32_C(0x80000000);
  return (double)(states->count - 1);
}

/* A linear congruential generator: Numerical Recipes' modulus, the constants POV-Ray's. */
static double draw(struct call *call)
{
  const struct growing *states = &call->language->randoms;
  const double which = trunc(number(call));
  if (!(which >= 0 && which < (double)states->count)) return (double)NAN;
  uint32_t *state = (uint32_t *)states->at + (size_t)which;
  *state = UINT32_C(1812433253) * *state + 12345;
  return *state / 4294967295.0;
}

static double select_one(struct call *call)
{
  const double x = number(call), below = number(call), zero = number(call);
  const double above = call->next ? number(call) : zero;
  return x < 0 ? below : x == 0 ? zero : above;
}

static double dimensions(struct call *call)
{
  const struct value *value = of_kind(call, VALUE_ARRAY, "an array");
  return call->fits ? value->array->dimensions : 0;
}

static double dimension_size(struct call *call)
{
  const struct value *value = of_kind(call, VALUE_ARRAY, "an array");
  const double which = number(call);
  if (!call->fits) return 0;
  const struct array *array = value->array;
  return which >= 1 && which < array->dimensions + 1.0 ? array->size[(int)which - 1] : (double)NAN;
}

static double length(struct call *call)
{
  double a[3];
  vector(call, a);
  return vector_length(a);
}

static double dot(struct call *call)
{
  double a[3], b[3];
  vector(call, a), vector(call, b);
  return vector_dot(a, b);
}

/* Makes the result a vector, and returns where its parts are. */
static double *vector_out(struct call *call)
{
  call->out->kind = VALUE_VECTOR;
  call->out->parts = 3;
  return call->out->x;
}

static void unit(const double a[3], double out[3])
{
  const double size = vector_length(a);
  for (int k = 0; k < 3; k++) out[k] = size > 0 ? a[k] / size : 0;
}

static double normalize(struct call *call)
{
  double a[3];
  vector(call, a);
  unit(a, vector_out(call));
  return 0;
}

static double cross(struct call *call)
{
  double a[3], b[3];
  vector(call, a), vector(call, b);
  vector_cross(a, b, vector_out(call));
  return 0;
}

static double rotate(struct call *call)
{
  double a[3], angles[3];
  struct transform rotation;
  vector(call, a), vector(call, angles);
  transform_rotation(angles, call->language->angles, &rotation);
  transform_point(&rotation, a, vector_out(call));
  return 0;
}

/* A turn about an axis by POV-Ray's left hand. */
static double axis_rotate(struct call *call)
{
  double v[3], along[3], axis[3], across[3];
  vector(call, v), vector(call, along);
  const double angle = number(call), s = sin(radians(angle)), c = cos(radians(angle));
  double *out = vector_out(call);
  unit(along, axis);
  vector_cross(axis, v, across);
  const double ahead = vector_dot(axis, v);
  for (int k = 0; k < 3; k++) out[k] = v[k] * c + across[k] * s + axis[k] * ahead * (1 - c);
  return 0;
}

static double string_length(struct call *call)
{
  const struct value *value = of_kind(call, VALUE_STRING, "a string");
  return call->fits ? (double)value->length : 0;
}

/* Makes the result a string of these bytes. */
static double string_out(struct call *call, const char *text, size_t size)
{
  char *to = call->fits ? string_make(call->language, call->out, size) : NULL;
  if (to) memcpy(to, text, size);
  return 0;
}

static double character(struct call *call)
{
  const char letter = (char)number(call);
  return string_out(call, &letter, 1);
}

/* str(x, length, precision): at least `length` characters, filled by zeros if that is negative; a negative precision is
 * one of 6. Appends to text[0 .. *used-1] as far as `size` allows. */
static void add_number(double x, double length, double precision, char *text, size_t size, size_t *used)
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

static double number_string(struct call *call)
{
  char text[1024];
  size_t used = 0;
  const double x = number(call), width = number(call);
  add_number(x, width, number(call), text, sizeof text, &used);
  return string_out(call, text, used);
}

static double vector_string(struct call *call)
{
  char text[1024];
  size_t used = 0;
  const int parts = (int)lesser(MAX_PARTS, number(call));
  const struct value *value = call->next;
  if (value->kind > VALUE_COLOUR) symbol_mistaken(call->language, value, "a vector"), call->fits = false;
  call->next = value->next;
  const struct value *between = of_kind(call, VALUE_STRING, "a string");
  const double width = number(call), precision = number(call);
  for (int k = 0; call->fits && k < parts; k++) {
    if (k > 0) used += (size_t)snprintf(text + used, 100, "%.*s", (int)between->length, between->text);
    if (used > sizeof text / 2) break;
    add_number(value_x(value, k), width, precision, text, sizeof text - 100, &used);
  }
  return string_out(call, text, used);
}

static double concatenate(struct call *call)
{
  size_t size = 0;
  const struct value *const first = call->next;
  while (call->next && call->fits) {
    const struct value *part = of_kind(call, VALUE_STRING, "a string");
    size += call->fits ? part->length : 0;
  }
  char *to = call->fits ? string_make(call->language, call->out, size) : NULL;
  for (const struct value *part = first; to && part; part = part->next)
    memcpy(to, part->text, part->length), to += part->length;
  return 0;
}

/* ---- all of them ---- */

static const struct function {
  const char *name;
  int least, most; /* arguments */
  double (*of_one)(double);
  double (*of_two)(double, double); /* of more than two: of the first two, and so on */
  double (*of_any)(struct call *call);
} FUNCTIONS[] = {
  {"abs", 1, 1, .of_one = fabs},
  {"acos", 1, 1, .of_one = acos},
  {"acosh", 1, 1, .of_one = acosh},
  {"asin", 1, 1, .of_one = asin},
  {"asinh", 1, 1, .of_one = asinh},
  {"atan", 1, 1, .of_one = atan},
  {"atan2", 2, 2, .of_two = arc},
  {"atanh", 1, 1, .of_one = atanh},
  {"ceil", 1, 1, .of_one = ceil},
  {"chr", 1, 1, .of_any = character},
  {"concat", 1, INT_MAX, .of_any = concatenate},
  {"cos", 1, 1, .of_one = cos},
  {"cosh", 1, 1, .of_one = cosh},
  {"degrees", 1, 1, .of_one = degrees},
  {"dimension_size", 2, 2, .of_any = dimension_size},
  {"dimensions", 1, 1, .of_any = dimensions},
  {"div", 2, 2, .of_two = quotient},
  {"exp", 1, 1, .of_one = exp},
  {"floor", 1, 1, .of_one = floor},
  {"int", 1, 1, .of_one = trunc},
  {"ln", 1, 1, .of_one = log},
  {"log", 1, 1, .of_one = log10},
  {"max", 1, INT_MAX, .of_two = greater},
  {"min", 1, INT_MAX, .of_two = lesser},
  {"mod", 2, 2, .of_two = fmod},
  {"pow", 2, 2, .of_two = power},
  {"radians", 1, 1, .of_one = radians},
  {"rand", 1, 1, .of_any = draw},
  {"seed", 1, 1, .of_any = seed},
  {"select", 3, 4, .of_any = select_one},
  {"sin", 1, 1, .of_one = sin},
  {"sinh", 1, 1, .of_one = sinh},
  {"sqrt", 1, 1, .of_one = sqrt},
  {"str", 3, 3, .of_any = number_string},
  {"strlen", 1, 1, .of_any = string_length},
  {"tan", 1, 1, .of_one = tan},
  {"tanh", 1, 1, .of_one = tanh},
  {"vaxis_rotate", 3, 3, .of_any = axis_rotate},
  {"vcross", 2, 2, .of_any = cross},
  {"vdot", 2, 2, .of_any = dot},
  {"vlength", 1, 1, .of_any = length},
  {"vnormalize", 1, 1, .of_any = normalize},
  {"vrotate", 2, 2, .of_any = rotate},
  {"vstr", 5, 5, .of_any = vector_string},
};

static const struct function *find(const struct language *language, struct span place)
{
  const struct name name = sources_name(language, place);
  return words_find(name.text, name.length, FUNCTIONS, sizeof FUNCTIONS / sizeof *FUNCTIONS, sizeof *FUNCTIONS);
}

bool function_draws(const struct language *language, struct span place)
{
  const struct function *function = find(language, place);
  return function && (function->of_any == draw || function->of_any == seed);
}

/* ---- calls ---- */

static double of_numbers(struct call *call, const struct function *function)
{
  double x = number(call);
  if (function->of_one) return function->of_one(x);
  while (call->next && call->fits) x = function->of_two(x, number(call));
  return x;
}

struct value *value_function(struct language *language, struct value *arguments, struct span place, struct span whole)
{
  const struct function *function = find(language, place);
  const struct name name = sources_name(language, place);
  struct value *list = value_reversed(arguments), *out = value_of(language, VALUE_NUMBER, whole);
  struct call call = {language, list, true, out};
  int count = 0;
  for (const struct value *a = list; a; a = a->next) count++;
  if (count < function->least || count > function->most) {
    language_error(language, whole, "%s has %d argument%s, but %d %s given", function->name, function->least,
                   function->least == 1 ? "" : "s", count, count == 1 ? "is" : "are");
    call.fits = false;
  } else {
    const double x = function->of_any ? function->of_any(&call) : of_numbers(&call, function);
    if (out->kind == VALUE_NUMBER) out->x[0] = x;
  }
  for (int k = 0; call.fits && out->kind <= VALUE_VECTOR && k < 3; k++) {
    if (number_in_range(&out->x[k])) continue;
    language_error(language, whole, "%.*s has no value for these arguments", (int)name.length, name.text);
    call.fits = false;
  }
  value_last_of_list(language, list);
  if (!call.fits) out->kind = VALUE_UNKNOWN;
  return out;
}

struct value *value_defined(struct language *language, struct span place, struct span whole)
{
  const struct name name = sources_name(language, place);
  return value_of_number(language, symbol_known(language, &name), whole);
}

struct value *value_constant(struct language *language, struct span place)
{
  const struct name name = sources_name(language, place);
  const char first = name.text[0], second = name.text[1];
  double x = 0; /* false, no, off */
  if (first == 'p') x = PI;
  else if (first == 'c') x = name.length == 5 ? language->clock : language->animated; /* clock, clock_on */
  else if (first == 'v') x = language->settings->version;
  else if (first == 't' || first == 'y' || (first == 'o' && second == 'n')) x = 1;
  return value_of_number(language, x, place);
}
