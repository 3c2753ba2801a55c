/* Pictures rendered into memory, and maps written. See pictures.h. */
#include "pictures.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "image/image_file.h"
#include "language/language.h"
#include "render/render.h"

static void tell(void *context, const char *text, size_t length)
{
  (void)context;
  fwrite(text, 1, length, stderr);
}

float *picture_channels(const char *scene_path, size_t width, size_t height, const char *solver, const char *channels)
{
  const struct language_settings settings = {
    .image_width = (int)width, .image_height = (int)height, .solver_text = solver, .tolerance = NAN};
  struct diagnostics diagnostics = {.tell = tell};
  struct scene *scene = NULL;
  struct intersector *intersector = NULL;
  struct render_options options = {
    .width = width, .height = height, .samples = 1, .crop = {.width = width, .height = height}, .threads = 1};
  const char *bad;
  size_t bad_length;
  if (!channel_list_parse(channels, &options.channels, &bad, &bad_length)) return NULL;
  if (language_load(scene_path, &settings, &diagnostics, &scene) != STATUS_OK) return NULL;
  const struct render_watch watch = {0};
  struct render_stats stats;
  float *out = malloc(width * height * options.channels.width * sizeof *out);
  bool good = out != NULL && intersector_create(scene, &intersector) == STATUS_OK;
  good = good && render_scene(scene, intersector, &options, &watch, out, &stats) == STATUS_OK;
  intersector_destroy(intersector);
  scene_destroy(scene);
  if (good) return out;
  free(out);
  return NULL;
}

bool picture_begin(size_t width, size_t height, struct image *out)
{
  if (image_create(width, height, 3, out) != STATUS_OK) return false;
  for (size_t c = 0; c < 3; c++) snprintf(out->channel[c].name, IMAGE_NAME_SIZE, "%c", "RGB"[c]);
  return true;
}

bool picture_end(struct image *image, const char *path)
{
  const struct image_encoding encoding = {.format = IMAGE_PNG, .bits = 8, .encoded = true};
  char message[IMAGE_MESSAGE_SIZE];
  unsigned char *bytes = NULL;
  size_t size = 0;
  const enum status status = image_encode(image, &encoding, &bytes, &size, message);
  image_destroy(image);
  if (status != STATUS_OK) {
    fprintf(stderr, "%s\n", message);
    return false;
  }
  FILE *file = fopen(path, "wb");
  const bool good = file != NULL && fwrite(bytes, 1, size, file) == size;
  free(bytes);
  return file != NULL && fclose(file) == 0 && good;
}

void picture_scale(double x, float out_rgb[3])
{
  static const double colours[5][3] = {
    {0.20, 0.10, 0.35}, {0.20, 0.35, 0.60}, {0.15, 0.60, 0.55}, {0.50, 0.80, 0.30}, {0.98, 0.90, 0.20}};
  const double at = fmin(fmax(x, 0), 1) * 4;
  const int k = at < 3 ? (int)at : 3;
  for (int c = 0; c < 3; c++) out_rgb[c] = (float)(colours[k][c] + (at - k) * (colours[k + 1][c] - colours[k][c]));
}
