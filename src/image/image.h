/* A picture in memory: float values, named channels.
 *
 * Layout: value[(y * width + x) * channel_count + c], rows from the top, pixels from the left.
 */
#ifndef PSCN_IMAGE_IMAGE_H
#define PSCN_IMAGE_IMAGE_H

#include <stdbool.h>
#include <stddef.h>

#include "base/status.h"

enum {
  IMAGE_NAME_SIZE = 64,      /* of a channel name, with its NUL */
  IMAGE_MAX_CHANNELS = 256,  /* of a picture read or written */
  IMAGE_MAX_PIXELS = 1 << 28 /* 3 GiB of colours; more is a typing error, or an attack on our memory */
};

struct image_channel {
  char name[IMAGE_NAME_SIZE]; /* "R", "G", "B", or the channel's content */
  bool data;                  /* numbers, not light: always stored with 32 bits */
};

struct image {
  size_t width, height, channel_count;
  size_t x, y, full_width, full_height; /* its place in a larger picture; full 0 x 0: it is the whole */
  struct image_channel *channel;        /* channel_count of them */
  float *value;
  char *texts; /* metadata: NAME, NUL, TEXT, NUL, again and again. Of a picture that was read, those named "pscn:..." */
  size_t texts_size;
};

/* Makes a black picture with unnamed channels, owned by the caller. Returns STATUS_LIMIT if memory is short or there
 * are more than IMAGE_MAX_PIXELS; then *out is zero. */
enum status image_create(size_t width, size_t height, size_t channel_count, struct image *out) STATUS_MUST_CHECK;

/* image_create_header makes a picture without pixels: its value is NULL and takes no memory. image_add_pixels adds
 * them; if it returns STATUS_LIMIT, the picture is unchanged. */
enum status image_create_header(size_t width, size_t height, size_t channel_count, struct image *out) STATUS_MUST_CHECK;
enum status image_add_pixels(struct image *image) STATUS_MUST_CHECK;

/* Frees what image_create made, and zeroes *image, which may be zero already. */
void image_destroy(struct image *image);

/* The index of the channel of that name, or channel_count if there is none. */
size_t image_find_channel(const struct image *image, const char *name);

/* Adds a line of metadata, formatted as by printf; line ends in it become blanks. A name with a colon ("pscn:solver")
 * is a group of its own. Returns false if memory is short. */
bool image_add_text(struct image *image, const char *name, const char *format, ...)
  __attribute__((format(printf, 3, 4)));

/* The text of that name; "" if there is none, because files do not keep empty texts. */
const char *image_text(const struct image *image, const char *name);

/* The name of the next line of metadata, of the first for NULL, and NULL after the last. Its text follows its NUL. */
const char *image_next_text(const struct image *image, const char *name);

/* The channel_count values of one pixel. */
static inline float *image_pixel(const struct image *image, size_t x, size_t y)
{
  return image->value + (y * image->width + x) * image->channel_count;
}

#endif
