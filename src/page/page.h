/* Values for pages (page/fill.h), and the files of pages. */
#ifndef PSCN_PAGE_PAGE_H
#define PSCN_PAGE_PAGE_H

#include <jansson.h>
#include <stddef.h>

#include "base/listener.h"
#include "base/text_buffer.h"
#include "image/image.h"

/* Writes pages under their names in the folder, all or none (base/atomic_file.h); for an empty page, removes the file.
 * Errors go to the listener. */
enum status page_write(const struct listener *listener, const char *folder, size_t count, const char *const names[],
                       const struct text_buffer pages[]) STATUS_MUST_CHECK;

/* Values; NULL if memory is short. A number becomes null if it is NAN or infinite; a foreign text becomes printable. */
json_t *page_of_number(double value);
json_t *page_of_text(const char *text);

/* The name of a file without its folders. */
json_t *page_of_file(const char *path);

/* The values common to all pages: version, date, machine, command (the command line), and `head`, the first lines. */
json_t *page_of_head(const char *command_line);

/* A picture with display codes in [0,1] as the bytes of an 8-bit PNG; and those as a value, a data: URI. */
void page_png(const struct image *image, struct text_buffer *out);
json_t *page_of_png(const struct text_buffer *png);

#endif
