/* Colours. */
#include <float.h>
#include <math.h>
#include <string.h>

#include "language/settings.h"
#include "language/sources.h"
#include "scene/gamma.h"

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
  return value_usable(language, a, "a colour") ? become_colour(a, MAX_PARTS, place) : value_unknown(a, place);
}

/* As in POV-Ray, parts below 0 of an sRGB colour become 0, and the scene's space must be known. */
struct value *value_rgb(struct language *language, struct span word, struct value *a)
{
  const struct span place = span_join(word, a->place);
  const struct name name = sources_name(language, word);
  const bool srgb = name.text[0] == 's';
  if (!value_usable(language, a, "a colour")) return value_unknown(a, place);
  const bool no_filter = a->kind != VALUE_COLOUR && memcmp(name.text + name.length - 2, "bt", 2) == 0;
  become_colour(a, (int)name.length - srgb, place);
  if (no_filter) a->x[4] = a->x[3], a->x[3] = 0;
  if (!srgb) return a;
  const struct settings *settings = language->settings;
  if (!settings->gamma_said) {
    language_error(language, place, "srgb needs assumed_gamma before it, in global_settings");
    return value_unknown(a, place);
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
    return value_unknown(colour, place);
  }
  if (!value_usable(language, colour, "a colour") || !value_to_number(language, value, &x))
    return value_unknown(colour, place);
  colour->x[value_part_named(language, part)] = x;
  return become_colour(colour, 0, place);
}

bool value_is_float(double x) { return fabs(x) <= (double)FLT_MAX; }

void value_to_colour(struct language *language, const struct value *a, double out[3])
{
  if (!value_usable(language, a, "a colour")) return;
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
