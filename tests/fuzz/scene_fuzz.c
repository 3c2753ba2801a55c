/* Scene text. Reading ends with a scene or with errors; a scene is finite, its dump reads back as the same dump.
 * With FUZZ_RENDER it is rendered as well, 16 x 12 pixels. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "intersect/intersect.h"
#include "language/language.h"
#include "render/render.h"
#include "scene/dump.h"
#include "target.h"

enum {
  MAX_MEMORY = 64 << 20,
  DUMPED_MOST = 2000, /* patches of a scene that is dumped */
  RENDERED_MOST = 200,
  WIDTH = 16,
  HEIGHT = 12
};

static void tell(void *context, const char *text, size_t length)
{
  assert(length > 0 && text[length - 1] == '\n' && !memchr(text, '\0', length));
  ++*(size_t *)context;
}

static struct scene *load(const char *text, size_t length)
{
  const struct language_settings settings = {
    .image_width = WIDTH, .image_height = HEIGHT, .tolerance = NAN, .max_memory = MAX_MEMORY};
  size_t told = 0;
  struct diagnostics diagnostics = {.tell = tell, .context = &told};
  struct scene *scene = NULL;
  const enum status status = language_load_text("<fuzz>", text, length, &settings, &diagnostics, &scene);
  assert((status == STATUS_OK) == (scene != NULL) && (status == STATUS_OK) == (diagnostics.error_count == 0));
  assert(status == STATUS_OK || status == STATUS_INPUT || status == STATUS_LIMIT);
  return scene;
}

#ifdef FUZZ_RENDER
static void use(const struct scene *scene)
{
  static float out[HEIGHT][WIDTH][16];
  struct intersector *intersector = NULL;
  struct render_options options = {
    .width = WIDTH, .height = HEIGHT, .samples = 1, .crop = {.width = WIDTH, .height = HEIGHT}, .threads = 1};
  const struct render_watch watch = {0};
  struct render_stats stats;
  const char *bad;
  size_t bad_length;
  if (scene->patch_count > RENDERED_MOST) return;
  assert(channel_list_parse("rgb,depth,normal,status", &options.channels, &bad, &bad_length));
  assert(options.channels.width <= 16);
  if (intersector_create(scene, &intersector) != STATUS_OK) return;
  assert(render_scene(scene, intersector, &options, &watch, &out[0][0][0], &stats) == STATUS_OK);
  intersector_destroy(intersector);
}
#else
static char *dump(const struct scene *scene, size_t *length)
{
  char *text = NULL;
  FILE *memory = open_memstream(&text, length);
  assert(memory && scene_dump(scene, memory) == STATUS_OK);
  assert(fclose(memory) == 0);
  return text;
}

static void use(const struct scene *scene)
{
  size_t length, length_again;
  for (size_t k = 0; k < scene->patch_count; k++) {
    const double *p = &scene->patches[k].P[0][0][0];
    for (int i = 0; i < 48; i++) assert(isfinite(p[i]));
    assert(scene->patches[k].texture < scene->texture_count && scene->patches[k].solver < scene->solver_count);
  }
  if (scene->patch_count > DUMPED_MOST) return;
  char *text = dump(scene, &length);
  struct scene *again = load(text, length);
  assert(again);
  char *text_again = dump(again, &length_again);
  assert(length == length_again && memcmp(text, text_again, length) == 0);
  free(text);
  free(text_again);
  scene_destroy(again);
}
#endif

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
  struct scene *scene = load((const char *)data, size);
  if (scene) use(scene);
  scene_destroy(scene);
  return 0;
}
