/* What image_file.c has others do: a module that reads picture files and writes EXR, and png_file.c.
 *
 * OpenImageIO brings along some 250 shared libraries, which would cost every start of a program an eighth of a second
 * and 130 MB. The code that uses it is therefore a module of its own, IMAGE_MODULE_FILE, loaded for the first such
 * file. It exports one object, `image_module`. The functions are those of image_file.h after the arguments have been
 * checked; `format` is OpenImageIO's name of the file's format.
 */
#ifndef PSCN_IMAGE_IMAGE_MODULE_H
#define PSCN_IMAGE_IMAGE_MODULE_H

#include "image/image_file.h"

#define IMAGE_MODULE_FILE "pscn_openimageio.so"
#define IMAGE_MODULE_SYMBOL "image_module"

struct image_module {
  size_t image_size, encoding_size;    /* of the structures passed: a module with others is of another build */
  enum status (*begin)(char *message); /* starts the threads it needs, which may not be available later */
  enum status (*encode)(const struct image *image, const struct image_encoding *encoding, unsigned char **out_bytes,
                        size_t *out_size, char *message);
  /* `wanted` NULL: all pixels. */
  enum status (*read)(const char *path, const char *format, const struct image_wanted *wanted, struct image *out,
                      char *message);
};

extern const struct image_module image_module __attribute__((visibility("default")));

/* image_encode for PNG: the picture has one to four channels, the encoding 8 or 16 bits. By libpng, on which
 * OpenImageIO's writer stands too. */
enum status png_file_encode(const struct image *image, const struct image_encoding *encoding, unsigned char **out_bytes,
                            size_t *out_size, char *message) STATUS_MUST_CHECK;

#endif
