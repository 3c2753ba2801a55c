/* Reads a file or text through the grammar into a scene. */
#include "language/language.h"

#include <math.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/input.h"
#include "base/memory.h"
#include "language/objects.h"
#include "language/settings.h"
#include "language/sources.h"
#include "language/state.h"
#include "language/symbols.h"
#include "language/textures.h"
#include "language/tokens.h"

/* The most tokens that loops and macros read: a second's work. */
enum { MOST_WORK = 15 * 1000 * 1000 };

static const struct place NOWHERE = {NULL, 0, 0};

/* One reading: its state, and what that points to. */
struct reading {
  struct language language;
  struct symbols symbols;
  struct sources sources;
  struct tokens tokens;
  struct objects objects;
  struct camera_items camera;
  struct settings settings;
  struct transform_angles angles;
  struct language_parts *parts; /* or NULL */
};

static enum status reading_create(struct reading *r, const struct language_settings *settings,
                                  struct diagnostics *diagnostics)
{
  struct language *language = &r->language;
  memset(r, 0, sizeof *r);
  *language = (struct language){.diagnostics = diagnostics,
                                .arena = arena_create(),
                                .lenient = settings->lenient,
                                .clock = settings->clock,
                                .animated = settings->last_frame > 0,
                                .max_work = settings->max_work ? settings->max_work : MOST_WORK,
                                .max_memory = settings->max_memory ? settings->max_memory : SIZE_MAX,
                                .untrusted = settings->untrusted,
                                .symbols = &r->symbols,
                                .sources = &r->sources,
                                .tokens = &r->tokens,
                                .objects = &r->objects,
                                .camera = &r->camera,
                                .settings = &r->settings,
                                .texture_default = &TEXTURE_OF_POVRAY,
                                .angles = &r->angles};
  camera_default(&r->camera);
  settings_default(&r->settings);
  r->sources.folders = settings->folders;
  r->parts = settings->out_parts;
  return language->arena ? STATUS_OK : STATUS_LIMIT;
}

static void reading_destroy(struct reading *r)
{
  sources_close(&r->language);
  memory_free(r->language.randoms.at);
  arena_destroy(r->language.arena);
}

/* Reports the end of the text within a declaration that has errors of its own, which were not reported. */
static void tell_end(struct language *language)
{
  const struct tokens *tokens = language->tokens;
  if (tokens->depth > 0) language_tell(language, tokens->braces[tokens->depth - 1], "this brace is not closed");
  else language_tell(language, tokens->last.place, "the text ends within a declaration");
}

/* The names that are declared before a scene is read. */
static void declare_numbers(struct language *language, const struct language_settings *settings)
{
  const int frames = settings->last_frame - settings->first_frame;
  const struct {
    const char *name;
    double value;
  } numbers[] = {{"pscn", 1}, /* not in POV-Ray */
                 {"image_width", settings->image_width},
                 {"image_height", settings->image_height},
                 {"frame_number", settings->frame},
                 {"initial_frame", settings->first_frame},
                 {"final_frame", settings->last_frame},
                 {"initial_clock", 0},
                 {"final_clock", frames > 0},
                 {"clock_delta", frames > 0 ? 1.0 / frames : 0}};
  for (size_t k = 0; k < sizeof numbers / sizeof *numbers; k++)
    declare_number(language, numbers[k].name, strlen(numbers[k].name), numbers[k].value);
  for (size_t k = 0; k < settings->number_count; k++) {
    const struct language_number *number = &settings->numbers[k];
    declare_number(language, number->name, number->name_length, number->value);
  }
}

/* Runs the grammar over a source, which it takes over; NULL if there was no memory for one. */
static void read_source(struct reading *r, const struct language_settings *settings, struct source *source)
{
  struct language *language = &r->language;
  const size_t before = language->diagnostics->error_count;
  if (!source) language_end(language, STATUS_LIMIT);
  sources_open(language, source);
  declare_numbers(language, settings);
  r->tokens.start[0] = r->tokens.solver_only ? PSCN_TOKEN_START_SOLVER : PSCN_TOKEN_START_SCENE;
  r->tokens.start[1] = r->tokens.solver_only ? PSCN_TOKEN_SOLVER : 0;
  const bool whole = pscn_parse(language) == 0;
  language->status = whole && language->diagnostics->error_count == before ? STATUS_OK : STATUS_INPUT;
}

static enum status parse(struct reading *r, const struct language_settings *settings, struct source *source)
{
  struct language *language = &r->language;
  const size_t before = language->diagnostics->error_count;
  language->status = STATUS_LIMIT; /* if the scanner breaks */
  if (setjmp(language->ended) == 0) read_source(r, settings, source);
  language_tell_left_out(language);
  messages_end(language);
  if (language->status == STATUS_INPUT && language->diagnostics->error_count == before) tell_end(language);
  return language->status;
}

/* Makes the scene in *out_scene, which is the caller's also if reading ends before it is whole. */
static void fill_scene(struct reading *r, struct scene **out_scene)
{
  struct language *language = &r->language;
  const struct settings *settings = &r->settings;
  struct arena *arena = arena_create();
  struct scene *scene = arena ? arena_alloc(arena, 1, sizeof *scene) : NULL;
  if (!scene) {
    arena_destroy(arena);
    language_end(language, STATUS_LIMIT);
  }
  *out_scene = scene;
  scene->arena = arena;
  scene->has_camera = r->camera.said;
  scene->gamma = settings_gamma(settings);
  scene->gamma_assumed = !settings->version_said && !settings->gamma_said;
  memcpy(scene->background, settings->background, sizeof scene->background);
  memcpy(scene->ambient_light, settings->ambient_light, sizeof scene->ambient_light);
  scene->camera = r->camera.folded;
  scene->lights = language_alloc_in(language, arena, settings->light_count, sizeof *scene->lights);
  for (const struct light_node *light = settings->lights; light; light = light->next)
    scene->lights[scene->light_count++] = light->light;
  objects_expand(language, &settings->method, scene, r->parts);
  sources_list(language, scene);
}

static enum status make_scene(struct reading *r, struct scene **out_scene)
{
  if (setjmp(r->language.ended) == 0) fill_scene(r, out_scene);
  return r->language.status;
}

enum status language_set_tolerance(double tolerance, size_t count, struct method methods[],
                                   struct diagnostics *diagnostics)
{
  if (isnan(tolerance)) return STATUS_OK;
  const struct method_item *item = method_item_find("tolerance");
  if (!(tolerance >= item->minimum && tolerance <= item->maximum)) {
    diagnostics_error(diagnostics, NOWHERE, "the tolerance must be a number from %g to %g", item->minimum,
                      item->maximum);
    return STATUS_USAGE;
  }
  for (size_t k = 0; k < count; k++) item->set(&methods[k], tolerance);
  return STATUS_OK;
}

/* Applies --solver and --tolerance. */
static enum status override(struct scene *scene, const struct language_settings *settings,
                            struct diagnostics *diagnostics)
{
  struct method method;
  if (settings->solver_text) {
    const enum status status = language_parse_solver(settings->solver_text, diagnostics, &method);
    if (status != STATUS_OK) return status;
    scene_override_solver(scene, &method);
  }
  return language_set_tolerance(settings->tolerance, scene->solver_count, scene->solvers, diagnostics);
}

/* Ends a reading. If it ran out of memory, this has not been reported yet. */
static void finish(struct reading *r, enum status status)
{
  struct diagnostics *diagnostics = r->language.diagnostics;
  if (status == STATUS_LIMIT && !r->language.limit_told) {
    diagnostics_error(diagnostics, NOWHERE, "%s",
                      r->language.unaffordable || memory_limit_reached() ? MORE_THAN_ALLOWED : "memory is short");
  }
  reading_destroy(r);
}

static enum status load(struct source *source, const struct language_settings *settings,
                        struct diagnostics *diagnostics, struct scene **out_scene)
{
  struct reading r;
  enum status status = reading_create(&r, settings, diagnostics);
  if (status != STATUS_OK) source_destroy(source);
  else status = parse(&r, settings, source);
  if (status == STATUS_OK) status = make_scene(&r, out_scene);
  finish(&r, status);
  if (status == STATUS_OK) status = override(*out_scene, settings, diagnostics);
  if (status == STATUS_OK) return STATUS_OK;
  scene_destroy(*out_scene);
  *out_scene = NULL;
  return status;
}

bool language_is_name(const char *name, size_t length)
{
  static const char letters[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz_0123456789";
  return length > 0 && strspn(name, letters) >= length && !(name[0] >= '0' && name[0] <= '9') &&
         words_token(name, length) == PSCN_TOKEN_WORD;
}

/* The link to another folder's file that a stranger may have uploaded is no scene. */
static enum status read_scene(const char *path, bool untrusted, struct source **out, const char **out_reason)
{
  struct stat info;
  const char *slash = strrchr(path, '/');
  const int file = input_open(path, INPUT_FILE_OR_PIPE, out_reason);
  if (file < 0) return STATUS_FILE;
  if (untrusted && fstat(file, &info) == 0 && S_ISREG(info.st_mode) &&
      !input_is_below(file, path, slash == NULL ? 0 : (size_t)(slash - path) + 1)) {
    *out_reason = "it is a link to a file elsewhere, which --untrusted forbids";
    (void)close(file);
    return STATUS_FILE;
  }
  return source_read_open(path, file, out, out_reason);
}

enum status language_load(const char *path, const struct language_settings *settings, struct diagnostics *diagnostics,
                          struct scene **out_scene)
{
  *out_scene = NULL;
  struct source *source;
  const char *reason;
  const enum status status = read_scene(path, settings->untrusted, &source, &reason);
  if (status == STATUS_OK) return load(source, settings, diagnostics, out_scene);
  if (status == STATUS_LIMIT && memory_limit_reached()) diagnostics_error(diagnostics, NOWHERE, MORE_THAN_ALLOWED);
  else diagnostics_error(diagnostics, NOWHERE, "%s: %s", path, reason);
  return status;
}

enum status language_load_text(const char *name, const char *text, size_t length,
                               const struct language_settings *settings, struct diagnostics *diagnostics,
                               struct scene **out_scene)
{
  *out_scene = NULL;
  return load(source_from_text(name, text, length), settings, diagnostics, out_scene);
}

enum status language_parse_solver(const char *text, struct diagnostics *diagnostics, struct method *out_method)
{
  const struct language_settings settings = {.image_width = 1, .image_height = 1, .tolerance = NAN};
  struct reading r;
  enum status status = reading_create(&r, &settings, diagnostics);
  r.tokens.solver_only = true;
  if (status == STATUS_OK) status = parse(&r, &settings, source_from_text("<--solver>", text, strlen(text)));
  if (status == STATUS_OK) *out_method = *r.language.method;
  if (status == STATUS_INPUT) status = STATUS_USAGE;
  finish(&r, status);
  return status;
}

/* ---- memory ---- */

void language_end(struct language *language, enum status status)
{
  language->status = status;
  longjmp(language->ended, 1);
}

void language_afford(struct language *language, size_t bytes)
{
  language->unaffordable = bytes > language->max_memory - language->memory_bytes;
  if (language->unaffordable) language_end(language, STATUS_LIMIT);
  language->memory_bytes += bytes;
}

void *language_alloc(struct language *language, size_t size)
{
  language_afford(language, size);
  return language_alloc_in(language, language->arena, 1, size);
}

void *language_alloc_in(struct language *language, struct arena *arena, size_t count, size_t size)
{
  void *memory = arena_alloc(arena, count, size);
  if (!memory) language_end(language, STATUS_LIMIT);
  return memory;
}

const char *language_keep(struct language *language, const char *text, size_t length)
{
  return memcpy(language_alloc(language, length), text, length);
}
