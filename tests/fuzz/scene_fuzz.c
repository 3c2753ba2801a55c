/* Scene text. It finds files to include and declared numbers; if its first line is a comment "//: TEXT", TEXT is a text
 * of --solver. Reading ends with a scene or with errors. A scene is finite, and its dump reads back as the same dump.
 * With FUZZ_RENDER it is also rendered, 16 x 12 pixels, by every kernel of the processor. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "intersect/intersect.h"
#include "language/language.h"
#include "render/render.h"
#include "scene/scene.h"
#include "target.h"

enum {
  MAX_MEMORY = 64 << 20,
  MAX_WORK = 5000,    /* tokens that loops and macros read */
  SOLVER_TEXT = 200,  /* bytes */
  DUMPED_MOST = 2000, /* patches of a scene that is dumped */
  RENDERED_MOST = 200,
  WIDTH = 16,
  HEIGHT = 12
};

static void tell(void *context, const char *text, size_t length)
{
  assert(length > 0 && text[length - 1] == '\n' && !memchr(text, '\0', length) && !memchr(text, '\x1b', length));
  ++*(size_t *)context;
}

/* The text after "//: " in the first line, or NULL. */
static const char *solver_text(const char *text, size_t length, char out[SOLVER_TEXT])
{
  static const char MARK[] = "//: ";
  const size_t mark = sizeof MARK - 1;
  if (length <= mark || memcmp(text, MARK, mark) != 0) return NULL;
  size_t size = 0;
  while (size < SOLVER_TEXT - 1 && mark + size < length && text[mark + size] != '\n' && text[mark + size] != '\0') {
    out[size] = text[mark + size];
    size++;
  }
  out[size] = '\0';
  return out;
}

static struct scene *load(const char *text, size_t length)
{
  static const char *const folders[] = {PSCN_SOURCE_DIR "/scenes", PSCN_SOURCE_DIR "/tests/language/ok", NULL};
  static const struct language_number numbers[] = {{"Given", 5, 0.5}, {"N", 1, 3}};
  char solver[SOLVER_TEXT];
  const struct language_settings settings = {.image_width = WIDTH,
                                             .image_height = HEIGHT,
                                             .solver_text = solver_text(text, length, solver),
                                             .tolerance = NAN,
                                             .folders = folders,
                                             .numbers = numbers,
                                             .number_count = sizeof numbers / sizeof *numbers,
                                             .max_work = MAX_WORK,
                                             .lenient = length % 4 == 1,
                                             .max_memory = MAX_MEMORY};
  size_t told = 0;
  struct diagnostics diagnostics = {.tell = tell, .context = &told};
  struct scene *scene = NULL;
  const enum status status = language_load_text("<fuzz>", text, length, &settings, &diagnostics, &scene);
  assert((status == STATUS_OK) == (scene != NULL) && (status == STATUS_OK) == (diagnostics.error_count == 0));
  assert(status == STATUS_OK || told > 0);
  assert(status == STATUS_OK || status == STATUS_INPUT || status == STATUS_LIMIT ||
         (status == STATUS_USAGE && settings.solver_text != NULL));
  return scene;
}

#ifdef FUZZ_RENDER
/* The channels of each pixel, in this order. */
static const char CHANNELS[] = "depth,u,v,patch,normal,status,rgb";
enum { STATUS_CHANNEL = 7, DATA_CHANNELS, CHANNEL_COUNT = DATA_CHANNELS + 3 };
typedef float picture[HEIGHT][WIDTH][CHANNEL_COUNT];

static void render(const struct scene *scene, picture out)
{
  struct intersector *intersector = NULL;
  struct render_options options = {
    .width = WIDTH, .height = HEIGHT, .samples = 1, .crop = {.width = WIDTH, .height = HEIGHT}, .threads = 1};
  const struct render_watch watch = {0};
  struct render_stats stats;
  const char *bad;
  size_t bad_length;
  assert(channel_list_parse(CHANNELS, &options.channels, &bad, &bad_length));
  assert(options.channels.width == CHANNEL_COUNT);
  assert(intersector_create(scene, &intersector) == STATUS_OK);
  assert(render_scene(scene, intersector, &options, &watch, &out[0][0][0], &stats) == STATUS_OK);
  intersector_destroy(intersector);
}

/* No value of a pixel is NaN, and two kernels agree on what both call certain. */
static void expect(const float pixel[CHANNEL_COUNT], const float first[CHANNEL_COUNT])
{
  for (int c = 0; c < DATA_CHANNELS; c++) assert(!isnan(pixel[c]));
  const float status = pixel[STATUS_CHANNEL], other = first[STATUS_CHANNEL];
  assert(status > 1 || other > 1 || status == other); /* channels.c: 0 and 1 are certain */
}

static void use(const struct scene *scene)
{
  static const char *const kernels[] = {"baseline", "avx2", "avx512"};
  static picture out[sizeof kernels / sizeof *kernels];
  if (scene->patch_count > RENDERED_MOST) return;
  for (size_t k = 0; k < sizeof kernels / sizeof *kernels; k++) {
    assert(setenv("PSCN_KERNEL", kernels[k], 1) == 0);
    if (!intersector_kernel_here()) continue;
    render(scene, out[k]);
    for (int y = 0; y < HEIGHT; y++)
      for (int x = 0; x < WIDTH; x++) expect(out[k][y][x], out[0][y][x]);
  }
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
