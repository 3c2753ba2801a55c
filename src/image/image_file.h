/* Pictures to and from files, through OpenImageIO.
 *
 * A picture is encoded to memory; the bytes are then written by base/atomic_file.h, so that a full disk is noticed and
 * nothing is left half written. Failures write one line of text, without a newline, to message[IMAGE_MESSAGE_SIZE].
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
  IMAGE_PNG, /* 8 or 16 bits a channel, sRGB, one to four channels */
  IMAGE_EXR  /* half (16) or float (32), linear, any channels */
};

/* The format a file name's suffix asks for (.png or .exr, in any case); false where it is neither. */
bool image_format_of(const char *path, enum image_format *out);

/* Whether the format holds values of that many bits, and its default. */
bool image_format_has_bits(enum image_format format, int bits);
int image_format_default_bits(enum image_format format);

/* One line of metadata. A name with a colon ("pscn:solver") is a group of its own. */
struct image_attribute {
  const char *name, *text;
};

struct image_encoding {
  enum image_format format;
  int bits; /* of every channel that is not data; data channels of EXR always have 32 */
  /* EXR: in tiles of so many pixels a side, packed as fast as can be, for what is soon read again by image_read_areas;
   * 0: in rows. */
  int tile;
  bool encoded; /* the values are display codes already: PNG takes them without the sRGB curve */
  const struct image_attribute *attributes;
  size_t attribute_count;
  /* Told now and then, with its context, which part is encoded; NULL: nobody asks. Where it answers false that is the end:
   * STATUS_INTERRUPTED. */
  bool (*progress)(void *context, double part);
  void *context;
};

/* Whether picture files can be read and written at all, to be asked before long work: OpenImageIO is loaded when it is
 * first needed. STATUS_FILE where it can not be, STATUS_LIMIT where memory is short for it. Beside
 * other work: image_loading.h. */
enum status image_file_ready(char *message) STATUS_MUST_CHECK;

/* The bytes of the file, owned by the caller (free). STATUS_LIMIT where memory is short, STATUS_FILE where the format
 * can not hold the picture or the library fails. */
enum status image_encode(const struct image *image, const struct image_encoding *encoding, unsigned char **out_bytes,
                         size_t *out_size, char *message) STATUS_MUST_CHECK;

/* Reads the first picture of a file, which is known by how it begins: PNG, EXR, TIFF or JPEG. Values as they are stored
 * (integers to [0,1]). The picture is owned by the caller and has its window and its metadata. STATUS_FILE or STATUS_LIMIT;
 * then *out is zero. */
enum status image_read(const char *path, struct image *out, char *message) STATUS_MUST_CHECK;

/* Which pixels of a picture are wanted: `areas` is asked when all but the pixels is known of it. They are counted as in the
 * picture that it stands in, lie inside of its window, and stay where they are until it is read. Where there are none its
 * value is NULL; where the answer is no STATUS_OK nothing more is read. */
struct image_wanted {
  enum status (*areas)(void *context, const struct image *image, const struct rectangle **out_area, size_t *out_count,
                       char *message);
  void *context;
};

/* image_read, of these pixels only; what is in the others is not said. Takes less time where the file has tiles that are not
 * needed. */
enum status image_read_areas(const char *path, const struct image_wanted *wanted, struct image *out,
                             char *message) STATUS_MUST_CHECK;

#endif
