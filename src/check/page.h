/* Text that grows, templates filled in, and the values they take.
 *
 * A template is a file of text (HTML, a script of gnuplot) that is built into the program. In it stand
 *
 *     {{name}}          the value of that name: text with what HTML reserves escaped, a whole number, a number
 *     {{name:9.3f}}     a number as printf writes it, with %f, %e or %g; {{name:9d}} and {{name:-9s}} in that width;
 *                       {{name:6}} with so many significant digits at most
 *     {{&name}}         text as it is
 *     {{#name}}...{{/name}}   once for each value of a list, the names of its objects going before those outside;
 *                       once for an object, a text, a number, true; not at all for null, false, what there is not
 *     {{^name}}...{{/name}}   once where {{#name}} writes nothing
 *
 * A section holds no other one of its own name. The values are a tree of jansson's. Numbers are written the same in
 * every locale. What cannot be kept for lack of memory is dropped and remembered in `failed`.
 */
#ifndef PSCN_CHECK_PAGE_H
#define PSCN_CHECK_PAGE_H

#include <jansson.h>
#include <stdbool.h>
#include <stddef.h>

#include "base/listener.h"
#include "image/image.h"

struct page {
  char *text; /* owned; length bytes, then a NUL; NULL while it is empty */
  size_t length, size;
  bool failed;
};

/* A page of zeros is empty and may be freed. */
void page_free(struct page *page);

/* Adds bytes, and text formatted as by printf. */
void page_bytes(struct page *page, const void *bytes, size_t length);
void page_format(struct page *page, const char *format, ...) __attribute__((format(printf, 2, 3)));

/* Foreign text that no terminal obeys: control characters but for the newline, and what is no UTF-8, as \xNN. */
void page_printable(struct page *page, const char *text, size_t length);

/* Fills a template in. `values` may be NULL, for which memory was short. */
void page_fill(struct page *page, const char *template, const json_t *values);

/* Writes pages under their names, all of them or none (base/atomic_file.h); of an empty one there is to be no file.
 * Errors are told. */
enum { PAGE_PATH_SIZE = 4096 };
enum status page_write(const struct listener *listener, size_t count, char (*paths)[PAGE_PATH_SIZE],
                       const struct page pages[]) STATUS_MUST_CHECK;

/* Values, NULL where memory is short: a number, or null for NAN and infinities; a count; foreign text, printable. */
json_t *page_of_number(double value);
json_t *page_of_count(size_t count);
json_t *page_of_text(const char *text);

/* What every page tells of itself: version, date, machine, command (the command line); and `head`, its first lines. */
json_t *page_of_head(const char *command_line);

/* The bytes of a PNG with 8 bits of a picture, whose values are display codes in [0,1]; as a value, a data: URI. */
void page_png(const struct image *image, struct page *out);
json_t *page_of_png(const struct page *png);

#endif
