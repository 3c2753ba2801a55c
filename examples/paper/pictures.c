/* Pictures made line by line, and maps. See pictures.h. */
#include "pictures.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "geometry/vector.h"
#include "image/image_file.h"
#include "intersect/intersect.h"
#include "language/language.h"
#include "render/camera.h"
#include "render/shade.h"

static void tell(void *context, const char *text, size_t length)
{
  (void)context;
  fwrite(text, 1, length, stderr);
}

/* Uses two tracers, for camera rays and shadow rays, each with its own roots to start from. */
static void trace_lines(const struct scene *scene, struct tracer *tracer[2], size_t width, size_t height,
                        struct picture_pixel out[])
{
  for (size_t p = 0; p < width * height; p++) {
    struct ray ray;
    struct hit hit;
    camera_ray(&scene->camera, ((double)(p % width) + 0.5) / (double)width,
               ((double)(p / width) + 0.5) / (double)height, &ray);
    measure_ray(tracer[0], &ray, &hit, &out[p].solver);
    shade_packet(scene, tracer[1], 1, &ray, &hit, &out[p].rgb);
    out[p].depth = hit.patch == HIT_NONE ? INFINITY : hit.t * vector_length(ray.direction);
  }
}

struct picture_pixel *picture_lines(const char *scene_path, size_t width, size_t height, const char *solver)
{
  const struct language_settings settings = {
    .image_width = (int)width, .image_height = (int)height, .solver_text = solver, .tolerance = NAN};
  struct diagnostics diagnostics = {.tell = tell};
  struct scene *scene = NULL;
  struct intersector *intersector = NULL;
  struct tracer *tracer[2] = {NULL, NULL};
  struct picture_pixel *out = NULL;
  if (language_load(scene_path, &settings, &diagnostics, &scene) != STATUS_OK) return NULL;
  if (intersector_create(scene, &intersector) == STATUS_OK && tracer_create(intersector, &tracer[0]) == STATUS_OK &&
      tracer_create(intersector, &tracer[1]) == STATUS_OK)
    out = malloc(width * height * sizeof *out);
  if (out != NULL) trace_lines(scene, tracer, width, height, out);
  else fputs("out of memory\n", stderr);
  for (int k = 0; k < 2; k++) tracer_destroy(tracer[k]);
  intersector_destroy(intersector);
  scene_destroy(scene);
  return out;
}

bool picture_begin(size_t width, size_t height, struct image *out)
{
  if (image_create(width, height, 3, out) != STATUS_OK) return false;
  for (size_t c = 0; c < 3; c++) snprintf(out->channel[c].name, IMAGE_NAME_SIZE, "%c", "RGB"[c]);
  return true;
}

bool picture_end(struct image *image, bool encoded, const char *name, const char *suffix)
{
  const struct image_encoding encoding = {.format = IMAGE_PNG, .bits = 8, .encoded = encoded};
  char message[IMAGE_MESSAGE_SIZE], path[4096];
  unsigned char *bytes = NULL;
  size_t size = 0;
  const enum status status = image_encode(image, &encoding, &bytes, &size, message);
  image_destroy(image);
  if (status != STATUS_OK) {
    fprintf(stderr, "%s\n", message);
    return false;
  }
  FILE *file = snprintf(path, sizeof path, "%s%s", name, suffix) < (int)sizeof path ? fopen(path, "wb") : NULL;
  const bool good = file != NULL && fwrite(bytes, 1, size, file) == size;
  free(bytes);
  return file != NULL && fclose(file) == 0 && good;
}
