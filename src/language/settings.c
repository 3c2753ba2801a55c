/* global_settings, background, light sources and the solver statement. */
#include "language/settings.h"

#include <float.h>
#include <math.h>
#include <string.h>

#include "base/number.h"
#include "language/language.h"
#include "language/sources.h"
#include "scene/scene.h"

/* The versions of POV-Ray's language that a scene may ask for. Each is read as 3.7, except for its gamma. */
#define VERSION_LOW 1.5 /* older ones had no binary operators */
#define VERSION_READ 3.7
#define VERSION_HIGH 3.8

/* Beyond it, no colour but white is left of a picture. */
#define GAMMA_HIGH 1000

void settings_default(struct settings *out)
{
  *out = (struct settings){.ambient_light = {1, 1, 1}, .version = VERSION_READ};
  method_default(solver_at(0), &out->method);
  out->lights_end = &out->lights;
}

void language_version(struct language *language, const struct value *value)
{
  struct settings *settings = language->settings;
  settings->version_said |= value_in_range(language, value, "the version", VERSION_LOW, VERSION_HIGH, false,
                                           &settings->version);
  settings->version = floor(100 * settings->version + 0.5) / 100; /* POV-Ray keeps two decimals */
}

/* As in POV-Ray, the first one counts. */
void global_gamma(struct language *language, struct span place, const struct value *value)
{
  struct settings *settings = language->settings;
  double gamma = GAMMA_SRGB;
  if (!value && sources_name(language, place).text[0] != 's')
    language_error(language, place, "assumed_gamma is a number or srgb");
  if (value && !value_in_range(language, value, "assumed_gamma", DBL_MIN, GAMMA_HIGH, false, &gamma)) return;
  if (settings->gamma_said)
    diagnostics_warning(language->diagnostics, sources_place(language, place),
                        "this is ignored, as in POV-Ray: the first assumed_gamma counts");
  else settings->gamma = gamma;
  settings->gamma_said = true;
}

/* Before version 3.7, POV-Ray put the parts of colours into the picture as they are: in a file that means sRGB. */
double settings_gamma(const struct settings *settings)
{
  if (settings->gamma_said) return settings->gamma;
  return settings->version_said && settings->version >= VERSION_READ ? 1 : GAMMA_SRGB;
}

void global_ambient(struct language *language, const struct value *value)
{
  value_to_colour(language, value, language->settings->ambient_light);
}

void global_solver(struct language *language) { language->settings->method = *language->method; }

/* ---- background ---- */

void background_begin(struct language *language, struct span place)
{
  language->settings->block = language_block(language, place);
  language->settings->background_values = 0;
}

void background_value(struct language *language, const struct value *value)
{
  struct settings *settings = language->settings;
  if (settings->background_values++ == 1)
    language_error_in(language, &settings->block, value->place, "background has one colour");
  value_to_opaque(language, value, settings->background);
}

void background_end(struct language *language)
{
  const struct settings *settings = language->settings;
  if (settings->background_values == 0)
    language_error_in(language, &settings->block, settings->block.place, "background needs its colour");
}

/* ---- light sources ---- */

/* A light without a colour is black, as in POV-Ray. */
void light_begin(struct language *language, struct span place)
{
  struct settings *settings = language->settings;
  struct light_node *light = language_alloc(language, sizeof *light);
  light->block = language_block(language, place);
  light->transform = transform_identity();
  *settings->lights_end = settings->light = light;
  settings->lights_end = &light->next;
  if (++settings->light_count > UNTRUSTED_LIGHTS && language->untrusted)
    language_limit(language, place, "the scene has more than 64 lights (--untrusted)");
}

void light_value(struct language *language, const struct value *value)
{
  struct light_node *light = language->settings->light;
  if (light->modified) {
    language_error_in(language, &light->block, value->place,
                      "the position and the colour of a light_source must come before its other items");
  }
  switch (light->values++) {
  case 0: value_to_vector(language, value, light->light.position); break;
  case 1: value_to_colour(language, value, light->light.color); break;
  default:
    language_error_in(language, &light->block, value->place, "light_source has one position and one colour");
    break;
  }
}

static struct light_node *modified_light(struct language *language, struct span place)
{
  struct light_node *light = language->settings->light;
  if (light->values == 0)
    language_error_in(language, &light->block, place, "light_source must begin with its position");
  light->modified = true;
  return light;
}

void light_shadowless(struct language *language, struct span place)
{
  modified_light(language, place)->light.shadowless = true;
}

void light_transform(struct language *language, const struct transform *transform)
{
  struct light_node *light = modified_light(language, language->transform_place);
  light->transform = transform_then(&light->transform, transform);
}

void light_end(struct language *language)
{
  struct light_node *light = language->settings->light;
  if (light->values == 0)
    language_error_in(language, &light->block, light->block.place, "light_source needs its position");
  double *position = light->light.position;
  transform_point(&light->transform, position, position);
  bool in_range = true;
  for (int k = 0; k < 3; k++) in_range &= number_in_range(&position[k]);
  if (!in_range)
    language_error(language, light->block.place,
                   "with its transforms applied, the light's position is larger than 1e100");
}

/* ---- the solver statement ---- */

enum { MOST_NAMES = 64, MOST_LISTED = 8 };

/* Reports an unknown word, with a guess, or with a list of the names there are unless they are many. */
static void tell_unknown(struct language *language, const char *what, const struct name *word,
                         const char *const names[], size_t count)
{
  struct guess guess = guess_begin(word->text, word->length);
  for (size_t k = 0; k < count; k++) guess_consider(&guess, names[k], strlen(names[k]));
  char list[300] = "";
  if (count <= MOST_LISTED) words_list(names, count, list, sizeof list);
  if (guess.best) {
    language_error(language, word->place, "there is no %s '%.*s'; did you mean '%s'?", what, (int)word->length,
                   word->text, guess.best);
  } else {
    language_error(language, word->place, "there is no %s '%.*s'%s%s", what, (int)word->length, word->text,
                   list[0] ? "; use " : "", list);
  }
}

void solver_begin(struct language *language, struct span place)
{
  const struct name name = sources_name(language, place);
  if (language->untrusted) language_error(language, place, "a scene may not choose a solver (--untrusted)");
  const struct solver *solver = solver_find(name.text, name.length);
  if (!solver) {
    const char *names[MOST_NAMES];
    size_t count = 0;
    for (; count < solver_count() && count < MOST_NAMES; count++) names[count] = solver_at(count)->name;
    tell_unknown(language, "solver", &name, names, count);
    solver = solver_at(0);
  }
  language->method = language_alloc(language, sizeof *language->method);
  method_default(solver, language->method);
  language->method_name = place, language->method_items = 0;
}

const struct method_item *solver_item_find(const struct name *word)
{
  const struct method_item *item;
  for (size_t k = 0; (item = method_item_at(k)) != NULL; k++)
    if (words_compare(word->text, word->length, item->name) == 0) break;
  return item;
}

static const struct method_item *item_named(struct language *language, struct span place)
{
  const struct name name = sources_name(language, place);
  const struct method_item *item = solver_item_find(&name);
  const char *names[MOST_NAMES];
  size_t count = 0;
  for (; method_item_at(count) && count < MOST_NAMES; count++) names[count] = method_item_at(count)->name;
  if (!item) tell_unknown(language, "solver item", &name, names, count);
  return item;
}

static void tell_wanted(struct language *language, struct span place, const struct method_item *item)
{
  char words[200], range[RANGE_TEXT_SIZE] = "";
  size_t count = 0;
  while (item->keywords && item->keywords[count]) count++;
  words_list(item->keywords, count, words, sizeof words);
  if (item->kind != METHOD_ITEM_KEYWORD)
    range_text(item->minimum, item->maximum, item->kind == METHOD_ITEM_INTEGER, range);
  language_error(language, place, "%s must be %s%s%s", item->name, words, words[0] && range[0] ? " or " : "", range);
}

/* Sets an item. Those behind it in the table that it sets as well (`form paper` does) must not stand before it. */
static void set_item(struct language *language, const struct method_item *item, struct span place, double value)
{
  const struct method before = *language->method;
  item->set(language->method, value);
  const size_t index = (size_t)(item - method_item_at(0));
  for (size_t k = index + 1; k < method_item_count(); k++) {
    const struct method_item *other = method_item_at(k);
    if ((language->method_items >> k & 1) && other->get(&before) != other->get(language->method))
      language_error(language, place, "%s sets %s as well; write it before %s", item->name, other->name, other->name);
  }
  language->method_items |= 1u << index;
}

static void set_number(struct language *language, const struct method_item *item, struct span place, double value)
{
  const bool whole = item->kind != METHOD_ITEM_INTEGER || value == floor(value);
  if (item->kind == METHOD_ITEM_KEYWORD || !whole || !(value >= item->minimum && value <= item->maximum))
    tell_wanted(language, place, item);
  else set_item(language, item, place, value);
}

void solver_quantity(struct language *language, struct span name, const struct value *value)
{
  const struct method_item *item = item_named(language, name);
  double number;
  if (item && value_to_number(language, value, &number)) set_number(language, item, value->place, number);
}

void solver_word(struct language *language, struct span name, struct span place)
{
  const struct name value = sources_name(language, place);
  const struct method_item *item = item_named(language, name);
  if (!item) return;
  for (size_t k = 0; item->keywords && item->keywords[k]; k++) {
    if (words_compare(value.text, value.length, item->keywords[k]) != 0) continue;
    set_item(language, item, name, (double)k);
    return;
  }
  const struct value *named = symbol_find(language, value.text, value.length);
  if (named && named->kind == VALUE_NUMBER) set_number(language, item, place, named->x[0]);
  else if (!named || named->kind != VALUE_UNKNOWN) tell_wanted(language, place, item);
}

void solver_misplaced(struct language *language, struct span place)
{
  language_error(language, place, "solver must be in global_settings or in a bicubic_patch");
}
