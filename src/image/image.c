/* A picture in memory. */
#include "image/image.h"

#include <stdint.h>
#include <stdlib.h>
#include <string.h>

enum status image_create(size_t width, size_t height, size_t channel_count, struct image *out)
{
  *out = (struct image){0};
  if (width != 0 && height > IMAGE_MAX_PIXELS / width) return STATUS_LIMIT;
  const size_t pixels = width * height;
  if (channel_count != 0 && pixels > SIZE_MAX / sizeof(float) / channel_count) return STATUS_LIMIT;
  const size_t values = pixels * channel_count;
  struct image image = {.width = width, .height = height, .channel_count = channel_count};
  image.channel = calloc(channel_count == 0 ? 1 : channel_count, sizeof *image.channel);
  image.value = calloc(values == 0 ? 1 : values, sizeof *image.value);
  if (image.channel == NULL || image.value == NULL) {
    image_destroy(&image);
    return STATUS_LIMIT;
  }
  *out = image;
  return STATUS_OK;
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
