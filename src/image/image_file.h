/* Reads and writes picture files. PNG is written by libpng, all else is done by OpenImageIO, loaded when first needed.
 *
 * A picture is encoded to memory; base/atomic_file.h then writes the bytes, so that a full disk is noticed and no file
 * is left half written. Failures write one line of text, without a newline, to message[IMAGE_MESSAGE_SIZE].
 */
#ifndef PSCN_IMAGE_IMAGE_FILE_H
#define PSCN_IMAGE_IMAGE_FILE_H

#include <stdbool.h>
#include <stddef.h>

#include "base/rectangle.h"
#include "base/status.h"
#include "image/image.h"

enum { IMAGE_MESSAGE_SIZE = 512 };

enum image_format {
  IMAGE_PNG, /* 8 or 16 bits per channel, sRGB, one to four channels */
  IMAGE_EXR  /* half (16) or float (32), linear, any channels */
};

/* The format that a file name's suffix asks for (.png or .exr, in any case); false if it is neither. */
bool image_format_of(const char *path, enum image_format *out);

/* Whether the format can hold values of `bits` bits, and its default. */
bool image_format_has_bits(enum image_format format, int bits);
int image_format_default_bits(enum image_format format);

struct image_encoding {
  enum image_format format;
  int bits; /* of all channels other than data, which always have 32 in an EXR */
  /* EXR: pixels per side of the tiles, which are then packed as fast as possible, to be read again soon by
   * image_read_areas; 0: in rows. */
  int tile;
  bool encoded; /* the values are display codes already: PNG stores them without the sRGB curve */
  /* Called now and then with `context` and the part that is encoded; may be NULL. If it returns false, encoding ends
   * with STATUS_INTERRUPTED. */
  bool (*progress)(void *context, double part);
  void *context;
};

/* Whether picture files can be read and EXR be written. Ask before long work: OpenImageIO is loaded when it is first
 * needed. Returns STATUS_FILE if it cannot be loaded, STATUS_LIMIT if memory is too short for it. In parallel with
 * other work: image_loading.h. */
enum status image_file_ready(char *message) STATUS_MUST_CHECK;

/* Encodes a file's bytes, which the caller frees. Returns STATUS_LIMIT if memory is short, STATUS_FILE if the format
 * cannot hold the picture or the library fails. */
enum status image_encode(const struct image *image, const struct image_encoding *encoding, unsigned char **out_bytes,
                         size_t *out_size, char *message) STATUS_MUST_CHECK;

/* Reads the only picture of a PNG, EXR, TIFF or JPEG file, recognized by its first bytes. Values are as stored
 * (integers scaled to [0,1]). The caller owns the picture, which has its window and its metadata. Returns STATUS_FILE
 * or STATUS_LIMIT; then *out is zero. */
enum status image_read(const char *path, struct image *out, char *message) STATUS_MUST_CHECK;

/* The pixels that are wanted of a picture. `areas` is called when everything but the pixels is known. Its areas are in
 * the coordinates of the full picture, lie inside this picture's window, and must stay valid until it is read. If there
 * are none, the picture's value is NULL. A status other than STATUS_OK ends the reading. */
struct image_wanted {
  enum status (*areas)(void *context, const struct image *image, const struct rectangle **out_area, size_t *out_count,
                       char *message);
  void *context;
};

/* image_read of only these pixels; the others are unspecified. Faster if the file has tiles that are not needed. */
enum status image_read_areas(const char *path, const struct image_wanted *wanted, struct image *out,
                             char *message) STATUS_MUST_CHECK;

#endif
