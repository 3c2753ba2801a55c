/* global_settings, background and light sources. */
#include <math.h>

#include "language/build.h"

/* The versions of POV-Ray's language that a scene may ask for. */
#define VERSION_LOW 3.7
#define VERSION_HIGH 3.8

/* POV-Ray's largest; here there is nothing to trace on. */
enum { MAX_TRACE_LEVEL = 256 };

void language_version(struct language *language, struct place place, const struct value *value)
{
  double unused;
  value_in_range(language, place, value, "the version", VERSION_LOW, VERSION_HIGH, false, &unused);
}

void global_gamma(struct language *language, struct place place, const struct value *value)
{
  double gamma;
  if (value_to_number(language, place, value, &gamma) && gamma != 1) {
    language_error(language, place, "assumed_gamma must be 1: colours are linear");
  }
}

void global_trace_level(struct language *language, struct place place, const struct value *value)
{
  double unused;
  value_in_range(language, place, value, "max_trace_level", 1, MAX_TRACE_LEVEL, true, &unused);
}

void global_solver(struct language *language) { language->global_solver = language->solver; }

/* ---- background ---- */

void background_begin(struct language *language, struct place place)
{
  language->background_place = place;
  language->background_values = 0;
  language->background_errors = language->diagnostics->error_count;
}

void background_value(struct language *language, struct place place, const struct value *value)
{
  if (language->background_values++ == 1 && language_sound(language, language->background_errors)) {
    language_error(language, place, "background has one colour");
  }
  value_to_opaque(language, place, value, language->background);
}

void background_end(struct language *language)
{
  if (language->background_values == 0 && language_sound(language, language->background_errors)) {
    language_error(language, language->background_place, "background needs its colour");
  }
}

/* ---- light sources ---- */

/* A light whose colour is not said is black, as in POV-Ray. */
void light_begin(struct language *language, struct place place)
{
  struct light_node *light = language_alloc(language, sizeof *light);
  light->place = place;
  light->errors = language->diagnostics->error_count;
  light->transform = transform_identity();
  *language->lights_end = light;
  language->lights_end = &light->next;
  language->light = light;
}

void light_value(struct language *language, struct place place, const struct value *value)
{
  struct light_node *light = language->light;
  light->after_comma = false;
  if (light->modified && language_sound(language, light->errors)) {
    language_error(language, place, "the position and the colour of a light_source stand before what else there is");
  }
  switch (light->values++) {
  case 0: value_to_vector(language, place, value, light->light.position); break;
  case 1: value_to_colour(language, place, value, light->light.color); break;
  default:
    if (language_sound(language, light->errors))
      language_error(language, place, "light_source has one position and one colour");
    break;
  }
}

void light_comma(struct language *language, struct place place)
{
  struct light_node *light = language->light;
  if (light->values != 1 || light->after_comma) {
    language_error(language, place, "a comma stands between a light's position and its colour only");
  }
  light->after_comma = true;
}

static void light_modified(struct language *language, struct place place)
{
  struct light_node *light = language->light;
  if (light->values == 0 && !light->modified && language_sound(language, light->errors)) {
    language_error(language, place, "light_source begins with its position");
  }
  light->modified = true;
}

void light_shadowless(struct language *language, struct place place)
{
  light_modified(language, place);
  language->light->light.shadowless = true;
}

void light_transform(struct language *language, struct place place)
{
  struct light_node *light = language->light;
  light_modified(language, place);
  light->transform = transform_then(&light->transform, &language->transform);
}

void light_end(struct language *language)
{
  struct light_node *light = language->light;
  if (light->values == 0 && language_sound(language, light->errors))
    language_error(language, light->place, "light_source needs its position");
  double *position = light->light.position;
  transform_point(&light->transform, position, position);
  if (!(isfinite(position[0]) && isfinite(position[1]) && isfinite(position[2]))) {
    language_error(language, light->place,
                   "with its transforms applied, the light's position is too large for numbers");
  }
}
