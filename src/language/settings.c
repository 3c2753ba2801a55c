/* global_settings, background and light sources. */
#include "language/settings.h"

#include <float.h>
#include <math.h>

#include "base/number.h"
#include "language/language.h"
#include "language/sources.h"
#include "scene/gamma.h"

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
