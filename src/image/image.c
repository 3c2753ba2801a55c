/* A picture in memory. */
#include "image/image.h"

#include <stdarg.h>
#include <stdint.h>
#include <stdio.h>
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
  free(image->texts);
  *image = (struct image){0};
}

size_t image_find_channel(const struct image *image, const char *name)
{
  size_t index = 0;
  while (index < image->channel_count && strcmp(image->channel[index].name, name) != 0) index++;
  return index;
}

bool image_add_text(struct image *image, const char *name, const char *format, ...)
{
  va_list arguments, again;
  va_start(arguments, format);
  va_copy(again, arguments);
  const size_t name_size = strlen(name) + 1, text_size = (size_t)vsnprintf(NULL, 0, format, arguments) + 1;
  char *texts = realloc(image->texts, image->texts_size + name_size + text_size);
  if (texts != NULL) {
    memcpy(texts + image->texts_size, name, name_size);
    char *text = texts + image->texts_size + name_size;
    vsnprintf(text, text_size, format, again);
    while ((text = strchr(text, '\n')) != NULL) *text = ' ';
    image->texts = texts;
    image->texts_size += name_size + text_size;
  }
  va_end(again);
  va_end(arguments);
  return texts != NULL;
}

const char *image_next_text(const struct image *image, const char *name)
{
  const char *next = image->texts;
  if (name != NULL) next = name + strlen(name) + 1, next += strlen(next) + 1;
  return next == NULL || next == image->texts + image->texts_size ? NULL : next;
}

const char *image_text(const struct image *image, const char *name)
{
  const char *line = NULL;
  while ((line = image_next_text(image, line)) != NULL && strcmp(line, name) != 0) continue;
  return line == NULL ? "" : line + strlen(line) + 1;
}
