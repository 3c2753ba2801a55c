/* A picture in memory: float values, channels by name.
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
  IMAGE_MAX_PIXELS = 1 << 28 /* 3 GiB of colours; more are a typing error, or a file that wants our memory */
};

struct image_channel {
  char name[IMAGE_NAME_SIZE]; /* "R", "G", "B", or what the channel holds */
  bool data;                  /* numbers rather than light: always stored with 32 bits */
};

struct image {
  size_t width, height, channel_count;
  size_t x, y, full_width, full_height; /* where it stands in a larger picture; full 0 x 0: it is the whole */
  struct image_channel *channel;        /* channel_count of them */
  float *value;
  /* Of a picture that was read: its texts named "pscn:...", a line "NAME=TEXT" each, where a line end in it is a
   * blank. */
  char *metadata;
};

/* A black picture with unnamed channels, owned by the caller. STATUS_LIMIT where memory is short or they
 * are more than IMAGE_MAX_PIXELS; then *out is zero. */
enum status image_create(size_t width, size_t height, size_t channel_count, struct image *out) STATUS_MUST_CHECK;

/* The same of all but its pixels, whose value is NULL, and which take no memory; and these, later: STATUS_LIMIT leaves the
 * picture as it is. */
enum status image_create_header(size_t width, size_t height, size_t channel_count, struct image *out) STATUS_MUST_CHECK;
enum status image_add_pixels(struct image *image) STATUS_MUST_CHECK;

/* Frees what image_create made and zeroes *image; a zero image is allowed. */
void image_destroy(struct image *image);

/* The index of the channel of that name, or channel_count where there is none. */
size_t image_find_channel(const struct image *image, const char *name);

/* The text of that name in the metadata, without its line's end; NULL where there is none. */
const char *image_metadata(const struct image *image, const char *name, size_t *out_length);

/* The channel_count values of one pixel. */
static inline float *image_pixel(const struct image *image, size_t x, size_t y)
{
  return image->value + (y * image->width + x) * image->channel_count;
}

#endif
