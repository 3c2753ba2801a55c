/* Writes PNG through libpng. OpenImageIO's writer stands on libpng too, but brings 261 libraries, whose loading takes
 * longer than a small picture. */
#ifndef PSCN_IMAGE_PNG_FILE_H
#define PSCN_IMAGE_PNG_FILE_H

#include "image/image_file.h"

/* image_encode for PNG: the picture has one to four channels, the encoding 8 or 16 bits. */
enum status png_file_encode(const struct image *image, const struct image_encoding *encoding, unsigned char **out_bytes,
                            size_t *out_size, char *message) STATUS_MUST_CHECK;

#endif
