/* Functions of numbers, vectors, strings and arrays. */
#include "language/functions.h"

#include <limits.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "base/number.h"
#include "geometry/transform.h"
#include "geometry/vector.h"
#include "language/settings.h"
#include "language/sources.h"
#include "language/strings.h"

#define PI 3.14159265358979323846

/* ---- random numbers ---- */

enum { MOST_GENERATORS = 1000000 };

/* POV-Ray's generators, by the number that seed returns. */
struct randoms {
  uint32_t *state;
  size_t count, room;
};

static bool add_generator(struct language *language, uint32_t state)
{
  struct randoms *randoms = language->randoms;
  if (!randoms) randoms = language->randoms = language_alloc(language, sizeof *randoms);
  if (randoms->count == randoms->room) {
    const size_t room = randoms->room ? 2 * randoms->room : 16;
    uint32_t *state_list = language_afford(language, room * sizeof *state_list) && randoms->room < MOST_GENERATORS
                             ? arena_alloc(language->arena, room, sizeof *state_list)
                             : NULL;
    if (!state_list) return false;
    if (randoms->count > 0) memcpy(state_list, randoms->state, randoms->count * sizeof *state_list);
    randoms->state = state_list;
    randoms->room = room;
  }
  randoms->state[randoms->count++] = state;
  return true;
}

/* A C cast of the number, as on POV-Ray's machines: what is too large for an int is the least one. */
static double seed(struct language *language, double x)
{
  const uint32_t state = x > -2147483649.0 && x < 2147483648.0 ? (uint32_t)(int32_t)x : UINT32_C(0x80000000);
  if (!add_generator(language, state)) {
    language->ended_early = true;
    return 0;
  }
  return (double)(language->randoms->count - 1);
}

/* A linear congruential generator: Numerical Recipes' modulus, the constants POV-Ray's. NAN: there is none of that
 * number. */
static double draw(const struct randoms *randoms, double x)
{
  x = trunc(x);
  if (!randoms || !(x >= 0 && x < (double)randoms->count)) return (double)NAN;
  uint32_t *state = &randoms->state[(size_t)x];
  *state = UINT32_C(1812433253) * *state + 12345;
  return *state / 4294967295.0;
}

/* ---- functions of numbers ---- */

static double degrees(double x) { return x * (180 / PI); }
static double radians(double x) { return x * (PI / 180); }
static double quotient(double x, double y) { return trunc(x / y); }
static double arc(double y, double x) { return y == 0 && x == 0 ? (double)NAN : atan2(y, x); }
static double lesser(double x, double y) { return x < y ? x : y; }
static double greater(double x, double y) { return x > y ? x : y; }
/* As in C, but no number for what POV-Ray refuses. */
static double power(double x, double y) { return x == 0 && y == 0 ? (double)NAN : pow(x, y); }

/* Functions of anything else. */
enum special {
  VLENGTH,
  VDOT,
  VNORMALIZE,
  VCROSS,
  VROTATE,
  VAXIS_ROTATE,
  SELECT,
  SEED,
  RAND,
  DIMENSIONS,
  DIMENSION_SIZE,
  STR,
  VSTR,
  CONCAT,
  CHR,
  STRLEN
};

struct function {
  const char *name;
  int least, most; /* arguments */
  double (*of_one)(double);
  double (*of_two)(double, double); /* of more than two: of the first two, and so on */
  enum special special;             /* if neither */
};

#define ONE(name, f)       \
  {                        \
    name, 1, 1, f, NULL, 0 \
  }
#define TWO(name, f)       \
  {                        \
    name, 2, 2, NULL, f, 0 \
  }
#define MANY(name, f)            \
  {                              \
    name, 1, INT_MAX, NULL, f, 0 \
  }
#define SPECIAL(name, least, most, which) \
  {                                       \
    name, least, most, NULL, NULL, which  \
  }

static const struct function FUNCTIONS[] = {
  ONE("abs", fabs),
  ONE("acos", acos),
  ONE("acosh", acosh),
  ONE("asin", asin),
  ONE("asinh", asinh),
  ONE("atan", atan),
  TWO("atan2", arc),
  ONE("atanh", atanh),
  ONE("ceil", ceil),
  SPECIAL("chr", 1, 1, CHR),
  SPECIAL("concat", 1, INT_MAX, CONCAT),
  ONE("cos", cos),
  ONE("cosh", cosh),
  ONE("degrees", degrees),
  SPECIAL("dimension_size", 2, 2, DIMENSION_SIZE),
  SPECIAL("dimensions", 1, 1, DIMENSIONS),
  TWO("div", quotient),
  ONE("exp", exp),
  ONE("floor", floor),
  ONE("int", trunc),
  ONE("ln", log),
  ONE("log", log10),
  MANY("max", greater),
  MANY("min", lesser),
  TWO("mod", fmod),
  TWO("pow", power),
  ONE("radians", radians),
  SPECIAL("rand", 1, 1, RAND),
  SPECIAL("seed", 1, 1, SEED),
  SPECIAL("select", 3, 4, SELECT),
  ONE("sin", sin),
  ONE("sinh", sinh),
  ONE("sqrt", sqrt),
  SPECIAL("str", 3, 3, STR),
  SPECIAL("strlen", 1, 1, STRLEN),
  ONE("tan", tan),
  ONE("tanh", tanh),
  SPECIAL("vaxis_rotate", 3, 3, VAXIS_ROTATE),
  SPECIAL("vcross", 2, 2, VCROSS),
  SPECIAL("vdot", 2, 2, VDOT),
  SPECIAL("vlength", 1, 1, VLENGTH),
  SPECIAL("vnormalize", 1, 1, VNORMALIZE),
  SPECIAL("vrotate", 2, 2, VROTATE),
  SPECIAL("vstr", 5, 5, VSTR),
};

static const struct function *find(const struct language *language, struct span place)
{
  const struct name name = sources_name(language, place);
  return words_find(name.text, name.length, FUNCTIONS, sizeof FUNCTIONS / sizeof *FUNCTIONS, sizeof *FUNCTIONS);
}

bool function_draws(const struct language *language, struct span place)
{
  const struct function *function = find(language, place);
  return function && (function->special == RAND || function->special == SEED);
}

/* ---- calls ---- */

/* A call: what a function reads from its arguments, one after another. False once one was not what is wanted. */
struct call {
  struct language *language;
  const struct value *next;
  bool fits;
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

static double of_numbers(struct call *call, const struct function *function)
{
  double x = number(call);
  if (function->of_one) return function->of_one(x);
  while (call->next && call->fits) x = function->of_two(x, number(call));
  return x;
}

static double dimension_size(struct call *call)
{
  const struct value *value = of_kind(call, VALUE_ARRAY, "an array");
  const double which = number(call);
  if (!call->fits) return 0;
  const struct array *array = value->array;
  return which >= 1 && which < array->dimensions + 1.0 ? array->size[(int)which - 1] : (double)NAN;
}

static double dimensions(struct call *call)
{
  const struct value *value = of_kind(call, VALUE_ARRAY, "an array");
  return call->fits ? value->array->dimensions : 0;
}

static double select_one(struct call *call)
{
  const double x = number(call), below = number(call), zero = number(call);
  const double above = call->next ? number(call) : zero;
  return x < 0 ? below : x == 0 ? zero : above;
}

/* A turn about an axis by POV-Ray's left hand. */
static void turn(const double v[3], const double along[3], double angle, double out[3])
{
  double axis[3], across[3];
  const double length = vector_length(along), s = sin(radians(angle)), c = cos(radians(angle));
  for (int k = 0; k < 3; k++) axis[k] = length > 0 ? along[k] / length : 0;
  vector_cross(axis, v, across);
  const double ahead = vector_dot(axis, v);
  for (int k = 0; k < 3; k++) out[k] = v[k] * c + across[k] * s + axis[k] * ahead * (1 - c);
}

static void vector_function(struct call *call, enum special which, double out[3])
{
  double a[3], b[3];
  struct transform rotation;
  vector(call, a);
  if (which != VNORMALIZE) vector(call, b);
  const double angle = which == VAXIS_ROTATE ? number(call) : 0, length = vector_length(a);
  memcpy(out, a, sizeof a);
  if (!call->fits) return;
  switch (which) {
  case VNORMALIZE:
    for (int k = 0; k < 3; k++) out[k] = length > 0 ? a[k] / length : 0;
    break;
  case VCROSS: vector_cross(a, b, out); break;
  case VROTATE:
    transform_rotation(b, call->language->angles, &rotation);
    transform_point(&rotation, a, out);
    break;
  default: turn(a, b, angle, out); break;
  }
}

static double string_length(struct call *call)
{
  const struct value *value = of_kind(call, VALUE_STRING, "a string");
  return call->fits ? (double)value->length : 0;
}

static void string_function(struct call *call, enum special which, struct value *out)
{
  char text[1024];
  size_t used = 0;
  if (which == CHR) {
    text[used++] = (char)number(call);
  } else if (which == STR) {
    const double x = number(call), length = number(call);
    string_add_number(x, length, number(call), text, sizeof text, &used);
  } else {
    const int parts = (int)lesser(MAX_PARTS, number(call));
    const struct value *value = call->next;
    if (value->kind > VALUE_COLOUR) symbol_mistaken(call->language, value, "a vector"), call->fits = false;
    call->next = value->next;
    const struct value *between = of_kind(call, VALUE_STRING, "a string");
    const double length = number(call), precision = number(call);
    for (int k = 0; call->fits && k < parts; k++) {
      if (k > 0) used += (size_t)snprintf(text + used, 100, "%.*s", (int)between->length, between->text);
      if (used > sizeof text / 2) break;
      string_add_number(value_x(value, k), length, precision, text, sizeof text - 100, &used);
    }
  }
  char *to = call->fits ? string_make(call->language, out, used) : NULL;
  if (to) memcpy(to, text, used);
}

static void concatenate(struct call *call, struct value *out)
{
  size_t length = 0;
  const struct value *const first = call->next;
  while (call->next && call->fits) {
    const struct value *part = of_kind(call, VALUE_STRING, "a string");
    length += call->fits ? part->length : 0;
  }
  char *to = call->fits ? string_make(call->language, out, length) : NULL;
  for (const struct value *part = first; to && part; part = part->next)
    memcpy(to, part->text, part->length), to += part->length;
}

/* Writes a string or a vector to `out`, or returns a number. NAN: it has none. */
static double special(struct call *call, enum special which, struct value *out)
{
  double a[3], b[3];
  switch (which) {
  case VLENGTH: return vector(call, a), vector_length(a);
  case VDOT: return vector(call, a), vector(call, b), vector_dot(a, b);
  case SELECT: return select_one(call);
  case SEED: return seed(call->language, number(call));
  case RAND: return draw(call->language->randoms, number(call));
  case DIMENSIONS: return dimensions(call);
  case DIMENSION_SIZE: return dimension_size(call);
  case STRLEN: return string_length(call);
  case CONCAT: concatenate(call, out); return 0;
  case CHR:
  case STR:
  case VSTR: string_function(call, which, out); return 0;
  default:
    out->kind = VALUE_VECTOR;
    out->parts = 3;
    vector_function(call, which, out->x);
    return 0;
  }
}

struct value *value_function(struct language *language, struct value *arguments, struct span place, struct span whole)
{
  const struct function *function = find(language, place);
  const struct name name = sources_name(language, place);
  struct value *list = value_reversed(arguments), *out = value_of(language, VALUE_NUMBER, whole);
  struct call call = {language, list, true};
  int count = 0;
  for (const struct value *a = list; a; a = a->next) count++;
  if (count < function->least || count > function->most) {
    language_error(language, whole, "%s has %d argument%s, but %d %s given", function->name, function->least,
                   function->least == 1 ? "" : "s", count, count == 1 ? "is" : "are");
    call.fits = false;
  } else {
    const double x = function->of_one || function->of_two ? of_numbers(&call, function)
                                                          : special(&call, function->special, out);
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
