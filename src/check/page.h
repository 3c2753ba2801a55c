/* What pages are filled with (check/fill.h), and the files they become. */
#ifndef PSCN_CHECK_PAGE_H
#define PSCN_CHECK_PAGE_H

#include <jansson.h>
#include <stddef.h>

#include "base/listener.h"
#include "base/text_buffer.h"
#include "image/image.h"

/* Writes pages under their names, all of them or none (base/atomic_file.h); of an empty one there is to be no file.
 * Errors are told. */
enum { PAGE_PATH_SIZE = 4096 };
enum status page_write(const struct listener *listener, size_t count, char (*paths)[PAGE_PATH_SIZE],
                       const struct text_buffer pages[]) STATUS_MUST_CHECK;

/* Values, NULL where memory is short: a number, or null for NAN and infinities; foreign text, printable. */
json_t *page_of_number(double value);
json_t *page_of_text(const char *text);

/* What every page tells of itself: version, date, machine, command (the command line); and `head`, its first lines. */
json_t *page_of_head(const char *command_line);

/* The bytes of a PNG with 8 bits of a picture, whose values are display codes in [0,1]; as a value, a data: URI. */
void page_png(const struct image *image, struct text_buffer *out);
json_t *page_of_png(const struct text_buffer *png);

#endif
