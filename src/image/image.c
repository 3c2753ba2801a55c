/* A picture in memory. */
#include "image/image.h"

#include <stdint.h>
#include <stdlib.h>
#include <string.h>

enum status image_create_header(size_t width, size_t height, size_t channel_count, struct image *out)
{
  *out = (struct image){0};
  if (width != 0 && height > IMAGE_MAX_PIXELS / width) return STATUS_LIMIT;
  const size_t pixels = width * height;
  if (channel_count != 0 && pixels > SIZE_MAX / sizeof(float) / channel_count) return STATUS_LIMIT;
  struct image_channel *channel = calloc(channel_count == 0 ? 1 : channel_count, sizeof *channel);
  if (channel == NULL) return STATUS_LIMIT;
  *out = (struct image){.width = width, .height = height, .channel_count = channel_count, .channel = channel};
  return STATUS_OK;
}

enum status image_add_pixels(struct image *image)
{
  const size_t values = image->width * image->height * image->channel_count;
  image->value = calloc(values == 0 ? 1 : values, sizeof *image->value);
  return image->value == NULL ? STATUS_LIMIT : STATUS_OK;
}

enum status image_create(size_t width, size_t height, size_t channel_count, struct image *out)
{
  enum status status = image_create_header(width, height, channel_count, out);
  if (status == STATUS_OK) status = image_add_pixels(out);
  if (status != STATUS_OK) image_destroy(out);
  return status;
}

void image_destroy(struct image *image)
{
  free(image->channel);
  free(image->value);
  free(image->metadata);
  *image = (struct image){0};
}

size_t image_find_channel(const struct image *image, const char *name)
{
  size_t index = 0;
  while (index < image->channel_count && strcmp(image->channel[index].name, name) != 0) index++;
  return index;
}

const char *image_metadata(const struct image *image, const char *name, size_t *out_length)
{
  const size_t length = strlen(name);
  for (const char *line = image->metadata; line != NULL && *line != '\0'; line += strcspn(line, "\n") + 1) {
    if (strncmp(line, name, length) != 0 || line[length] != '=') continue;
    *out_length = strcspn(line + length + 1, "\n");
    return line + length + 1;
  }
  return NULL;
}
