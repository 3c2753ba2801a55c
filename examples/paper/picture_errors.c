/* Where a solver's picture is wrong, and how (Fig 16 and 17): a row of CSV on standard output, and a map.
 *
 *     picture_errors SCENE WIDTH HEIGHT SOLVER MAP.png
 *
 * The depth of every pixel by the solver, against the default's, which is certified. Depths are the same within a
 * fiftieth of the depths there are in the picture. Map: blue holes (darker: through to the background), red phantoms
 * (darker: in front of nothing), light grey what is right.
 */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "image/image_file.h"
#include "language/language.h"
#include "render/render.h"

#define SAME_DEPTH 0.02

enum error { RIGHT, BACKGROUND, HOLE_BACKGROUND, HOLE_FARTHER, PHANTOM_BEFORE, PHANTOM_BACKGROUND, ERRORS };

static const float colours[ERRORS][3] = {{0.8F, 0.8F, 0.8F}, {1, 1, 1},       {0, 0, 0.5F},
                                         {0.3F, 0.5F, 1},    {1, 0.4F, 0.3F}, {0.6F, 0, 0}};

static void tell(void *context, const char *text, size_t length)
{
  (void)context;
  fwrite(text, 1, length, stderr);
}

/* Depths of all pixels, owned by the caller; NULL where anything fails. */
static float *depths(const char *path, size_t width, size_t height, const char *solver)
{
  const struct language_settings settings = {
    .image_width = (int)width, .image_height = (int)height, .solver_text = solver, .tolerance = NAN};
  struct diagnostics diagnostics = {.tell = tell};
  struct scene *scene = NULL;
  struct intersector *intersector = NULL;
  if (language_load(path, &settings, &diagnostics, &scene) != STATUS_OK) return NULL;
  const struct render_options options = {.width = width,
                                         .height = height,
                                         .samples = 1,
                                         .crop = {.width = width, .height = height},
                                         .threads = 1,
                                         .channels = {.count = 1, .width = 1, .kind = {CHANNEL_DEPTH}}};
  const struct render_watch watch = {NULL, NULL, NULL};
  struct render_stats stats;
  float *out = malloc(width * height * sizeof *out);
  bool good = out != NULL && intersector_create(scene, &intersector) == STATUS_OK;
  good = good && render_scene(scene, intersector, &options, &watch, out, &stats) == STATUS_OK;
  intersector_destroy(intersector);
  scene_destroy(scene);
  if (good) return out;
  free(out);
  return NULL;
}

static enum error judge(float found, float exact, double same)
{
  if (isinf(found) && isinf(exact)) return BACKGROUND;
  if (isinf(found)) return HOLE_BACKGROUND;
  if (isinf(exact)) return PHANTOM_BACKGROUND;
  if (fabs((double)found - exact) <= same) return RIGHT;
  return found > exact ? HOLE_FARTHER : PHANTOM_BEFORE;
}

static bool write_map(const struct image *map, const char *path)
{
  const struct image_encoding encoding = {.format = IMAGE_PNG, .bits = 8, .encoded = true};
  char message[IMAGE_MESSAGE_SIZE];
  unsigned char *bytes = NULL;
  size_t size = 0;
  if (image_encode(map, &encoding, &bytes, &size, message) != STATUS_OK) {
    fprintf(stderr, "%s\n", message);
    return false;
  }
  FILE *file = fopen(path, "wb");
  const bool good = file != NULL && fwrite(bytes, 1, size, file) == size;
  free(bytes);
  return file != NULL && fclose(file) == 0 && good;
}

int main(int argc, char **argv)
{
  const int width = argc == 6 ? atoi(argv[2]) : 0, height = argc == 6 ? atoi(argv[3]) : 0;
  if (width < 1 || height < 1) {
    fputs("usage: picture_errors SCENE WIDTH HEIGHT SOLVER MAP.png\n", stderr);
    return 2;
  }
  const size_t pixels = (size_t)width * (size_t)height;
  float *exact = depths(argv[1], (size_t)width, (size_t)height, NULL);
  float *found = depths(argv[1], (size_t)width, (size_t)height, argv[4]);
  struct image map = {0};
  if (exact == NULL || found == NULL || image_create((size_t)width, (size_t)height, 3, &map) != STATUS_OK) return 3;
  double nearest = INFINITY, farthest = 0;
  for (size_t p = 0; p < pixels; p++)
    if (isfinite(exact[p])) nearest = fmin(nearest, exact[p]), farthest = fmax(farthest, exact[p]);
  size_t count[ERRORS] = {0};
  for (size_t p = 0; p < pixels; p++) {
    const enum error error = judge(found[p], exact[p], SAME_DEPTH * (farthest - nearest));
    count[error]++;
    for (int c = 0; c < 3; c++) map.value[3 * p + (size_t)c] = colours[error][c];
  }
  for (size_t c = 0; c < 3; c++) snprintf(map.channel[c].name, IMAGE_NAME_SIZE, "%c", "RGB"[c]);
  printf("%zu,%zu,%zu,%zu\n", count[HOLE_BACKGROUND], count[HOLE_FARTHER], count[PHANTOM_BEFORE],
         count[PHANTOM_BACKGROUND]);
  const bool good = write_map(&map, argv[5]);
  image_destroy(&map);
  free(exact);
  free(found);
  return good ? 0 : 4;
}
