/* Scenes for users of pscn.h, made from text or points and kept with the messages about them. */
#include <math.h>
#include <string.h>

#include "base/number.h"
#include "geometry/patch.h"
#include "language/language.h"
#include "library/library.h"

static const struct place NOWHERE = {NULL, 0, 0};

int pscn_version(void) { return PSCN_VERSION_NUMBER; }
const char *pscn_version_text(void) { return PSCN_VERSION; }

const char *pscn_status_text(enum pscn_status status)
{
  switch (status) {
  case PSCN_OK: return "done";
  case PSCN_USAGE: return "an argument is wrong";
  case PSCN_INPUT: return "the scene or a ray is wrong";
  case PSCN_FILE: return "a file cannot be read";
  case PSCN_LIMIT: return "out of memory or beyond a limit";
  default: return "unknown status";
  }
}

/* ---- messages ---- */

static const char *keep_text(struct arena *arena, const char *text, size_t length)
{
  char *kept = arena_alloc(arena, length + 1, 1);
  return kept ? memcpy(kept, text, length) : NULL;
}

static void add_message(struct pscn_scene *scene, struct message *message)
{
  *scene->messages_end = message;
  scene->messages_end = &message->next;
  scene->message_count++;
}

#define MEMORY_IS_SHORT "memory is short"
#define MEMORY_IS_SHORT_LINE "error: " MEMORY_IS_SHORT "\n"

/* Adds one message for all those that there was no memory for. */
static void add_spare(struct pscn_scene *scene)
{
  if (scene->spare.is.text) return;
  scene->spare = (struct message){.is = {.text = MEMORY_IS_SHORT, .file = ""}};
  add_message(scene, &scene->spare);
  text_buffer_add_text(&scene->text, MEMORY_IS_SHORT_LINE);
}

static void keep_message(void *context, const char *text, size_t length)
{
  struct pscn_scene *scene = context;
  const struct diagnostics_parts *parts = &scene->diagnostics.parts;
  struct message *message = scene->spare.is.text ? NULL : arena_alloc(scene->arena, 1, sizeof *message);
  if (message) {
    message->is.file = keep_text(scene->arena, text + parts->name_begin, parts->name_end - parts->name_begin);
    message->is.text = keep_text(scene->arena, text + parts->said_begin, parts->said_end - parts->said_begin);
    message->is.line = parts->line;
    message->is.column = parts->column;
    message->is.warning = parts->warning;
  }
  if (message && message->is.file && message->is.text) {
    add_message(scene, message);
    text_buffer_add(&scene->text, text, length);
  } else {
    add_spare(scene);
  }
}

/* Whether an error was kept. */
static bool told_error(const struct pscn_scene *scene)
{
  for (const struct message *message = scene->messages; message; message = message->next)
    if (!message->is.warning) return true;
  return false;
}

const char *pscn_scene_messages(const struct pscn_scene *scene)
{
  if (!scene || scene->text.failed) return MEMORY_IS_SHORT_LINE;
  return scene->messages ? scene->text.text : "";
}

size_t pscn_message_count(const struct pscn_scene *scene) { return scene ? scene->message_count : 0; }

enum pscn_status pscn_message(const struct pscn_scene *scene, size_t number, struct pscn_message *out)
{
  const struct message *message = scene ? scene->messages : NULL;
  if (!out) return PSCN_USAGE;
  for (; message && number > 0; number--) message = message->next;
  *out = message ? message->is : (struct pscn_message){.text = "", .file = ""};
  return message ? PSCN_OK : PSCN_USAGE;
}

/* ---- building ---- */

static enum pscn_status wrong(struct pscn_scene *scene, const char *text)
{
  diagnostics_error(&scene->diagnostics, NOWHERE, "%s", text);
  return PSCN_USAGE;
}

#define MEMORY_OF_STRANGER ((size_t)256 << 20)

/* The caller's options as this version knows them. Shorter ones, of an older version, ask for nothing more; longer
 * ones, of a newer one, must not. A size that ends within a pointer is refused. */
static bool take_options(const struct pscn_options *options, struct pscn_options *out)
{
  *out = (struct pscn_options)PSCN_OPTIONS;
  if (!options) return true;
  const size_t known = sizeof *out;
  if (options->size == 0 || options->size % _Alignof(struct pscn_options) != 0) return false;
  memcpy(out, options, options->size < known ? options->size : known);
  for (size_t k = known; k < options->size; k++)
    if (((const unsigned char *)options)[k]) return false;
  if (out->untrusted && out->max_memory == 0) out->max_memory = MEMORY_OF_STRANGER;
  return (out->untrusted == 0 || out->untrusted == 1) && (out->lenient == 0 || out->lenient == 1);
}

static enum pscn_status language_options(struct pscn_scene *scene, const struct pscn_options *options,
                                         struct language_settings *out)
{
  struct language_number *numbers = NULL;
  if (options->image_width < 0 || options->image_height < 0) return wrong(scene, "the size of the image is negative");
  if (options->number_count > 0) {
    if (!options->numbers) return wrong(scene, "numbers is NULL");
    numbers = arena_alloc(scene->arena, options->number_count, sizeof *numbers);
    if (!numbers) return PSCN_LIMIT;
  }
  for (size_t k = 0; k < options->number_count; k++) {
    const struct pscn_number *number = &options->numbers[k];
    const size_t length = number->name ? strlen(number->name) : 0;
    if (!language_is_name(number->name, length)) return wrong(scene, "a number has a name that cannot be declared");
    numbers[k] = (struct language_number){number->name, length, number->value};
    if (!number_in_range(&numbers[k].value)) return wrong(scene, "a declared number is not a number up to 1e100");
  }
  if (isnan(options->tolerance)) return wrong(scene, "the tolerance is not a number");
  double clock = options->clock;
  if (!number_in_range(&clock)) return wrong(scene, "the clock is not a number up to 1e100");
  *out = (struct language_settings){.image_width = options->image_width ? options->image_width : DEFAULT_WIDTH,
                                    .image_height = options->image_height ? options->image_height : DEFAULT_HEIGHT,
                                    .solver_text = options->solver,
                                    .tolerance = options->tolerance == 0 ? NAN : options->tolerance,
                                    .folders = options->folders,
                                    .numbers = numbers,
                                    .number_count = options->number_count,
                                    .out_parts = &scene->parts,
                                    .untrusted = options->untrusted != 0,
                                    .lenient = options->lenient != 0,
                                    .clock = clock,
                                    .max_work = options->max_work,
                                    .max_memory = options->max_memory};
  return PSCN_OK;
}

/* The control points that a scene is made from: with strides, or by indices, then `count` patches for each instance. */
struct points {
  const void *first; /* doubles, or floats; NULL: an argument is missing, unless count is 0 */
  bool floats;
  size_t count;
  ptrdiff_t patch_stride, point_stride;
  const uint32_t *index; /* or NULL */
  size_t vertex_count;
  const double *instances; /* or NULL for one, as the points are */
  size_t instance_count;
};

/* Control point k of patch n, all instances being counted. Returns false if it is none. */
static bool take_point(const struct points *points, size_t n, int k, double out[3])
{
  const size_t patch = n % points->count;
  const char *at = points->first;
  const size_t size = points->floats ? sizeof(float[3]) : sizeof(double[3]);
  if (!points->index) at += (ptrdiff_t)patch * points->patch_stride + k * points->point_stride;
  else if (points->index[16 * patch + (size_t)k] < points->vertex_count)
    at += size * points->index[16 * patch + (size_t)k];
  else return false;
  double p[3];
  float f[3];
  memcpy(points->floats ? (void *)f : (void *)p, at, size);
  for (int c = 0; c < 3 && points->floats; c++) p[c] = (double)f[c];
  const double *M = points->instances ? points->instances + 12 * (n / points->count) : NULL;
  for (int c = 0; c < 3; c++) out[c] = M ? p[0] * M[c] + p[1] * M[3 + c] + p[2] * M[6 + c] + M[9 + c] : p[c];
  bool in_range = true;
  for (int c = 0; c < 3; c++) in_range &= number_in_range(&out[c]);
  return in_range;
}

static enum pscn_status add_points(struct pscn_scene *scene, const struct points *points, size_t max_memory)
{
  struct scene *to = scene->scene;
  const size_t times = points->instances ? points->instance_count : 1;
  if (times > 0 && points->count > (max_memory > 0 ? max_memory : SIZE_MAX) / sizeof *to->patches / times) {
    diagnostics_error(&scene->diagnostics, NOWHERE, "%zu patches take more memory than max_memory allows",
                      points->count);
    return PSCN_LIMIT;
  }
  to->textures = arena_alloc(to->arena, 1, sizeof *to->textures);
  to->patches = arena_alloc(to->arena, times * points->count, sizeof *to->patches);
  if (!to->textures || !to->patches) return PSCN_LIMIT;
  to->texture_count = 1;
  to->patch_count = times * points->count;
  for (size_t n = 0; n < to->patch_count; n++) {
    for (int k = 0; k < 16; k++) {
      if (take_point(points, n, k, to->patches[n].P[k / 4][k % 4])) continue;
      diagnostics_error(&scene->diagnostics, NOWHERE, "patch %zu: control point [%d][%d] is not a %s", n, k / 4, k % 4,
                        points->index ? "vertex, or not a number up to 1e100" : "number up to 1e100");
      return PSCN_INPUT;
    }
  }
  return PSCN_OK;
}

/* What a scene is built from: the text at `text`, or if that is NULL the file `name`; then `points`, or NULL. */
struct origin {
  const char *name, *text;
  size_t length;
  const struct points *points;
};

static enum pscn_status build(struct pscn_scene *scene, const struct origin *origin, const struct pscn_options *given)
{
  struct pscn_options options;
  struct language_settings settings;
  if (!take_options(given, &options)) return wrong(scene, "these options are not of this version of pscn");
  enum pscn_status status = language_options(scene, &options, &settings);
  if (status != PSCN_OK) return status;
  struct diagnostics *diagnostics = &scene->diagnostics;
  if (origin->points)
    settings.max_memory = 0; /* add_points counts; what reading an empty text takes is not asked for */
  status = (enum pscn_status)(
    origin->text ? language_load_text(origin->name, origin->text, origin->length, &settings, diagnostics, &scene->scene)
                 : language_load(origin->name, &settings, diagnostics, &scene->scene));
  if (status == PSCN_OK && origin->points) status = add_points(scene, origin->points, options.max_memory);
  if (status != PSCN_OK) return status;
  status = (enum pscn_status)intersector_create(scene->scene, &scene->intersector);
  if (status == PSCN_LIMIT && memory_limit_reached())
    diagnostics_error(diagnostics, NOWHERE, "the scene takes more memory than max_memory allows");
  if (status == PSCN_OK && intersector_cut_less(scene->intersector))
    diagnostics_warning(diagnostics, NOWHERE,
                        "memory is short, so patches are cut into fewer leaves than 'split' requests");
  return status == PSCN_USAGE ? wrong(scene, "PSCN_KERNEL names instructions that this processor does not have")
                              : status;
}

static enum pscn_status create(const struct origin *origin, const struct pscn_options *options, struct pscn_scene **out)
{
  struct memory_hooks hooks = {NULL, NULL};
  struct pscn_options known = {.max_memory = 0};
  if (!out) return PSCN_USAGE;
  if (take_options(options, &known)) hooks = (struct memory_hooks){known.memory.resize, known.memory.context};
  const struct memory_hooks before = memory_use(hooks);
  struct memory_limit limit = {.most = known.max_memory}, *const limit_before = memory_limit_use(&limit);
  struct calm calm;
  calm_begin(&calm);
  struct pscn_scene *scene = memory_alloc(1, sizeof *scene);
  if (scene && !(scene->arena = arena_create())) {
    memory_free(scene);
    scene = NULL;
  }
  if (scene) {
    scene->hooks = hooks;
    scene->messages_end = &scene->messages;
    scene->diagnostics = (struct diagnostics){.tell = keep_message, .context = scene};
    scene->status = origin->name ? build(scene, origin, options) : wrong(scene, "an argument is NULL");
    if (scene->status != PSCN_OK && !told_error(scene)) add_spare(scene);
  }
  calm_end(&calm);
  (void)memory_limit_use(limit_before);
  (void)memory_use(before);
  *out = scene;
  return scene ? scene->status : PSCN_LIMIT;
}

enum pscn_status pscn_scene_from_file(const char *path, const struct pscn_options *options, struct pscn_scene **out)
{
  return create(&(struct origin){.name = path}, options, out);
}

enum pscn_status pscn_scene_from_text(const char *name, const char *text, size_t length,
                                      const struct pscn_options *options, struct pscn_scene **out)
{
  return create(&(struct origin){text || length == 0 ? name : NULL, text ? text : "", length, NULL}, options, out);
}

static enum pscn_status from_points(const struct points *all, const struct pscn_options *options,
                                    struct pscn_scene **out)
{
  const bool given = (all->first || all->count == 0) && (all->instances || all->instance_count == 0);
  return create(&(struct origin){given ? "<points>" : NULL, "", 0, all}, options, out);
}

enum pscn_status pscn_scene_from_points(const double *points, size_t count, ptrdiff_t patch_stride,
                                        ptrdiff_t point_stride, const struct pscn_options *options,
                                        struct pscn_scene **out)
{
  const struct points all = {points, false, count, patch_stride, point_stride, NULL, 0, NULL, 0};
  return from_points(&all, options, out);
}

enum pscn_status pscn_scene_from_float_points(const float *points, size_t count, ptrdiff_t patch_stride,
                                              ptrdiff_t point_stride, const struct pscn_options *options,
                                              struct pscn_scene **out)
{
  const struct points all = {points, true, count, patch_stride, point_stride, NULL, 0, NULL, 0};
  return from_points(&all, options, out);
}

enum pscn_status pscn_scene_from_indexed(const double *vertices, size_t vertex_count, const uint32_t *patches,
                                         size_t count, const double *instances, size_t instance_count,
                                         const struct pscn_options *options, struct pscn_scene **out)
{
  const struct points all = {
    patches ? vertices : NULL, false, count, 0, 0, patches, vertex_count, instances, instance_count};
  return from_points(&all, options, out);
}

enum pscn_status pscn_scene_from_float_indexed(const float *vertices, size_t vertex_count, const uint32_t *patches,
                                               size_t count, const double *instances, size_t instance_count,
                                               const struct pscn_options *options, struct pscn_scene **out)
{
  const struct points all = {
    patches ? vertices : NULL, true, count, 0, 0, patches, vertex_count, instances, instance_count};
  return from_points(&all, options, out);
}

void pscn_scene_free(struct pscn_scene *scene)
{
  if (!scene) return;
  const struct memory_hooks before = memory_use(scene->hooks);
  intersector_destroy(scene->intersector);
  scene_destroy(scene->scene);
  text_buffer_free(&scene->text);
  arena_destroy(scene->arena);
  memory_free(scene);
  (void)memory_use(before);
}

/* ---- what a scene is ---- */

enum pscn_status pscn_scene_status(const struct pscn_scene *scene) { return scene ? scene->status : PSCN_LIMIT; }

size_t pscn_patch_count(const struct pscn_scene *scene)
{
  return pscn_scene_status(scene) == PSCN_OK ? scene->scene->patch_count : 0;
}

enum pscn_status pscn_patch(const struct pscn_scene *scene, size_t number, double out[4][4][3])
{
  const double(*P)[4][3] = number < pscn_patch_count(scene) ? scene->scene->patches[number].P : NULL;
  if (!out) return PSCN_USAGE;
  for (int k = 0; k < 48; k++) out[k / 12][k / 3 % 4][k % 3] = P ? P[k / 12][k / 3 % 4][k % 3] : 0;
  return P ? PSCN_OK : PSCN_USAGE;
}

void pscn_scene_camera(const struct pscn_scene *scene, struct pscn_camera *out)
{
  if (!out) return;
  *out = (struct pscn_camera){{0}, {0}, {0}, {0}};
  if (pscn_scene_status(scene) != PSCN_OK) return;
  const struct scene_camera *camera = &scene->scene->camera;
  for (int k = 0; k < 3; k++) {
    out->location[k] = camera->location[k];
    out->direction[k] = camera->direction[k];
    out->right[k] = camera->right[k];
    out->up[k] = camera->up[k];
  }
}

enum pscn_status pscn_object(const struct pscn_scene *scene, size_t patch, struct pscn_object *out)
{
  if (!out) return PSCN_USAGE;
  *out = (struct pscn_object){.name = ""};
  if (patch >= pscn_patch_count(scene) || scene->parts.count == 0) return PSCN_USAGE;
  const struct language_part *at = scene->parts.at;
  size_t number = 0, end = scene->parts.count; /* the last one that begins at or before the patch */
  while (end - number > 1) {
    const size_t middle = number + (end - number) / 2;
    if (at[middle].first_patch <= patch) number = middle;
    else end = middle;
  }
  const size_t first = at[number].first_patch;
  const size_t after = end < scene->parts.count ? at[end].first_patch : scene->scene->patch_count;
  *out = (struct pscn_object){at[number].name ? at[number].name : "", number, first, after - first};
  return PSCN_OK;
}

enum pscn_status pscn_bounds(const struct pscn_scene *scene, size_t number, double out[2][3])
{
  const size_t count = pscn_patch_count(scene), first = number == PSCN_ALL_PATCHES ? 0 : number;
  if (!out) return PSCN_USAGE;
  memset(out, 0, 2 * sizeof *out);
  if (first >= count) return PSCN_USAGE;
  const size_t end = number == PSCN_ALL_PATCHES ? count : first + 1;
  for (int c = 0; c < 3; c++) out[0][c] = INFINITY, out[1][c] = -INFINITY;
  for (size_t n = first; n < end; n++) {
    double lo[3], hi[3];
    points_range((const double(*)[4][3])scene->scene->patches[n].P, lo, hi);
    for (int c = 0; c < 3; c++) out[0][c] = fmin(out[0][c], lo[c]), out[1][c] = fmax(out[1][c], hi[c]);
  }
  return PSCN_OK;
}

/* Computed from differences to the first control point, so that a patch far away loses nothing. */
static void surface_at(double P[4][4][3], double u, double v, struct pscn_surface *out)
{
  double x[3][4][4];
  for (int n = 0; n < 48; n++) x[n % 3][n / 12][n / 3 % 4] = P[n / 12][n / 3 % 4][n % 3] - P[0][0][n % 3];
  for (int c = 0; c < 3; c++) out->point[c] = P[0][0][c] + patch_evaluate(x[c], u, v).value;
  points_tangents((const double(*)[4][3])P, u, v, out->du, out->dv);
  (void)patch_normal(x, u, v, 0, out->normal);
}

enum pscn_status pscn_surface(const struct pscn_scene *scene, size_t count, const struct pscn_place *places,
                              ptrdiff_t place_stride, struct pscn_surface *out, ptrdiff_t out_stride)
{
  const double none[12] = {NAN, NAN, NAN, NAN, NAN, NAN, NAN, NAN, NAN, NAN, NAN, NAN};
  enum pscn_status status = PSCN_OK;
  if (pscn_scene_status(scene) != PSCN_OK || (count > 0 && (!places || !out))) return PSCN_USAGE;
  struct calm calm;
  calm_begin(&calm);
  for (size_t n = 0; n < count; n++) {
    struct pscn_place at;
    struct pscn_surface surface;
    memcpy(&at, (const char *)places + (ptrdiff_t)n * place_stride, sizeof at);
    const bool valid = at.patch < scene->scene->patch_count && at.u >= 0 && at.u <= 1 && at.v >= 0 && at.v <= 1;
    if (valid) surface_at(scene->scene->patches[at.patch].P, at.u, at.v, &surface);
    else memcpy(&surface, none, sizeof surface), status = PSCN_INPUT;
    memcpy((char *)out + (ptrdiff_t)n * out_stride, &surface, sizeof surface);
  }
  calm_end(&calm);
  return status;
}
