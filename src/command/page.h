/* An HTML page that needs nothing but itself: text that grows, pictures inside as data: URIs.
 *
 * What cannot be kept for lack of memory is dropped and remembered: page_finish tells. Numbers are written the same in
 * every locale.
 */
#ifndef PSCN_COMMAND_PAGE_H
#define PSCN_COMMAND_PAGE_H

#include <stdbool.h>
#include <stddef.h>

#include "base/status.h"
#include "image/image.h"

struct page {
  char *text; /* owned; length bytes */
  size_t length, size;
  bool failed;
  char message[512]; /* why a picture could not be made, or "" */
};

/* Begins with the head of a page of that title (plain text) and a style for headings, tables and figures. `style` is
 * further CSS. A page of zeros is empty and may be freed. */
void page_begin(struct page *page, const char *title, const char *style);

/* Closes the page. STATUS_LIMIT where memory was short, STATUS_FILE where a picture could not be made. */
enum status page_finish(struct page *page) STATUS_MUST_CHECK;
void page_free(struct page *page);

/* Adds HTML as it is, formatted as by printf (only %s %d %zu and the like: numbers with a fraction go through
 * page_number), and plain text with what HTML reserves escaped. */
void page_put(struct page *page, const char *html);
void page_format(struct page *page, const char *format, ...) __attribute__((format(printf, 2, 3)));
void page_text(struct page *page, const char *text);

/* A number with that many significant digits; infinities as the sign for it. */
void page_number(struct page *page, double value, int digits);

/* The value of an <img src="">: a PNG with 8 bits of the picture, whose values are display codes in [0,1]. */
void page_image_data(struct page *page, const struct image *image);

#endif
