/* Reading: from a file or text through the grammar to a scene. */
#include "language/language.h"

#include <assert.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include "language/tokens.h"

void language_error(struct language *language, struct place place, const char *format, ...)
{
  char message[400];
  va_list arguments;
  va_start(arguments, format);
  vsnprintf(message, sizeof message, format, arguments);
  va_end(arguments);
  diagnostics_error(language->diagnostics, place, "%s", message);
}

bool language_sound(const struct language *language, size_t errors)
{
  return language->diagnostics->error_count == errors;
}

void language_limit(struct language *language, struct place place, const char *text)
{
  if (!language->ended_early) language_error(language, place, "%s", text);
  language->ended_early = true;
}

bool language_afford(struct language *language, size_t bytes)
{
  language->unaffordable |= bytes > language->max_memory - language->memory_bytes;
  if (!language->unaffordable) language->memory_bytes += bytes;
  return !language->unaffordable;
}

/* Where memory is short a spare block stands in, and reading ends at the next token; the few blocks wanted until
 * then do not overlap. */
void *language_alloc(struct language *language, size_t size)
{
  void *memory = language_afford(language, size) ? arena_alloc(language->arena, 1, size) : NULL;
  if (memory) return memory;
  language->ended_early = true;
  const size_t alignment = _Alignof(max_align_t), room = (size + alignment - 1) / alignment * alignment;
  assert(room <= sizeof language->spare);
  if (room > sizeof language->spare - language->spare_used) language->spare_used = 0;
  memory = language->spare + language->spare_used;
  language->spare_used += room;
  return memset(memory, 0, size);
}

/* ---- the face ---- */

static enum status language_create(struct language *language, const struct language_settings *settings,
                                   struct diagnostics *diagnostics)
{
  *language = (struct language){.diagnostics = diagnostics,
                                .width = settings->image_width, .height = settings->image_height};
  language->lights_end = &language->lights;
  for (int k = 0; k < 3; k++) language->ambient_light[k] = 1;
  camera_default(&language->camera);
  method_default(solver_at(0), &language->global_solver);
  language->arena = arena_create();
  language->max_memory = settings->max_memory ? settings->max_memory : SIZE_MAX;
  return language->arena && symbols_create(language) ? STATUS_OK : STATUS_LIMIT;
}

static void language_destroy(struct language *language)
{
  sources_close(language);
  arena_destroy(language->arena);
}

static enum status add_lights(struct language *language, struct scene *scene)
{
  size_t count = 0;
  for (const struct light_node *light = language->lights; light; light = light->next) count++;
  scene->lights = arena_alloc(scene->arena, count, sizeof *scene->lights);
  if (!scene->lights) return STATUS_LIMIT;
  for (const struct light_node *light = language->lights; light; light = light->next) {
    scene->lights[scene->light_count++] = light->light;
  }
  return STATUS_OK;
}

static enum status make_scene(struct language *language, struct scene **out_scene)
{
  struct arena *arena = arena_create();
  struct scene *scene = arena ? arena_alloc(arena, 1, sizeof *scene) : NULL;
  if (!scene) {
    arena_destroy(arena);
    return STATUS_LIMIT;
  }
  scene->arena = arena;
  memcpy(scene->background, language->background, sizeof scene->background);
  memcpy(scene->ambient_light, language->ambient_light, sizeof scene->ambient_light);
  enum status status = camera_fold(language, &language->camera, &scene->camera) ? add_lights(language, scene)
                                                                                : STATUS_INPUT;
  if (status == STATUS_OK) status = objects_expand(language, scene);
  if (status == STATUS_OK && !sources_list(language, scene)) status = STATUS_LIMIT;
  if (status == STATUS_OK) *out_scene = scene;
  else scene_destroy(scene);
  return status;
}

/* --solver and --tolerance. */
static enum status override(struct scene *scene, const struct language_settings *settings,
                            struct diagnostics *diagnostics)
{
  struct method method;
  if (settings->solver_text) {
    const enum status status = language_parse_solver(settings->solver_text, diagnostics, &method);
    if (status != STATUS_OK) return status;
    scene_override_solver(scene, &method);
  }
  if (isnan(settings->tolerance)) return STATUS_OK;
  const struct method_item *item = method_item_find("tolerance");
  if (!(settings->tolerance >= item->minimum && settings->tolerance <= item->maximum)) {
    diagnostics_error(diagnostics, (struct place){NULL, 0, 0}, "the tolerance is a number from %g to %g",
                      item->minimum, item->maximum);
    return STATUS_USAGE;
  }
  for (size_t s = 0; s < scene->solver_count; s++) item->set(&scene->solvers[s], settings->tolerance);
  return STATUS_OK;
}

/* Runs the grammar over the open source. */
static enum status parse(struct language *language)
{
  const size_t before = language->diagnostics->error_count;
  const int result = pscn_parse(language);
  if (language->ended_early || result == 2) return STATUS_LIMIT;
  return result != 0 || language->diagnostics->error_count > before ? STATUS_INPUT : STATUS_OK;
}

/* A reading that ended for want of memory has not said so itself. */
static void tell_limit(const struct language *language, enum status status, size_t errors_before)
{
  if (status != STATUS_LIMIT || language->diagnostics->error_count > errors_before) return;
  diagnostics_error(language->diagnostics, (struct place){NULL, 0, 0}, "%s",
                    language->unaffordable ? "reading takes more memory than is allowed; --max-memory allows more"
                                           : "memory is short");
}

static enum status load(struct source *source, const struct language_settings *settings,
                        struct diagnostics *diagnostics, struct scene **out_scene)
{
  struct language language;
  const size_t before = diagnostics->error_count;
  enum status status = language_create(&language, settings, diagnostics);
  if (status != STATUS_OK) source_destroy(source);
  else status = sources_open(&language, source) ? parse(&language) : STATUS_LIMIT;
  if (status == STATUS_OK) status = make_scene(&language, out_scene);
  tell_limit(&language, status, before);
  language_destroy(&language);
  if (status == STATUS_OK) status = override(*out_scene, settings, diagnostics);
  if (status == STATUS_OK) return STATUS_OK;
  scene_destroy(*out_scene);
  *out_scene = NULL;
  return status;
}

enum status language_load(const char *path, const struct language_settings *settings, struct diagnostics *diagnostics,
                          struct scene **out_scene)
{
  *out_scene = NULL;
  struct source *source;
  const char *reason;
  const enum status status = source_read(path, INPUT_FILE_OR_PIPE, &source, &reason);
  if (status == STATUS_OK) return load(source, settings, diagnostics, out_scene);
  diagnostics_error(diagnostics, (struct place){NULL, 0, 0}, "%s: %s", path, reason);
  return status;
}

enum status language_load_text(const char *name, const char *text, size_t length,
                               const struct language_settings *settings, struct diagnostics *diagnostics,
                               struct scene **out_scene)
{
  *out_scene = NULL;
  struct source *source = source_from_text(name, text, length);
  if (source) return load(source, settings, diagnostics, out_scene);
  diagnostics_error(diagnostics, (struct place){NULL, 0, 0}, "memory is short");
  return STATUS_LIMIT;
}

enum status language_parse_solver(const char *text, struct diagnostics *diagnostics, struct method *out_method)
{
  const struct language_settings settings = {.image_width = 1, .image_height = 1, .tolerance = NAN};
  struct language language;
  const size_t before = diagnostics->error_count;
  enum status status = language_create(&language, &settings, diagnostics);
  if (status == STATUS_OK) {
    language.solver_only = true;
    struct source *source = source_from_text("<--solver>", text, strlen(text));
    status = source && sources_open(&language, source) ? parse(&language) : STATUS_LIMIT;
  }
  if (status == STATUS_OK) *out_method = language.solver;
  if (status == STATUS_INPUT) status = STATUS_USAGE;
  tell_limit(&language, status, before);
  language_destroy(&language);
  return status;
}
