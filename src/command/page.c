/* HTML text. Base64: RFC 4648, section 4. */
#include "command/page.h"

#include <math.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/number.h"
#include "image/image_file.h"

/* Room for `more` bytes and a NUL at the end. */
static bool reserve(struct page *page, size_t more)
{
  if (page->failed || more > SIZE_MAX / 4 - page->length) {
    page->failed = true;
    return false;
  }
  if (page->length + more + 1 <= page->size)
    return true;
  const size_t size = 2 * (page->length + more + 1);
  char *text = realloc(page->text, size);
  if (text == NULL) {
    page->failed = true;
    return false;
  }
  page->text = text;
  page->size = size;
  return true;
}

static void put_bytes(struct page *page, const char *bytes, size_t length)
{
  if (!reserve(page, length))
    return;
  memcpy(page->text + page->length, bytes, length);
  page->length += length;
  page->text[page->length] = '\0';
}

void page_put(struct page *page, const char *html)
{
  put_bytes(page, html, strlen(html));
}

void page_format(struct page *page, const char *format, ...)
{
  va_list arguments;
  va_start(arguments, format);
  va_list again;
  va_copy(again, arguments);
  const int length = vsnprintf(NULL, 0, format, arguments);
  va_end(arguments);
  if (length < 0)
    page->failed = true;
  else if (reserve(page, (size_t)length)) {
    vsnprintf(page->text + page->length, (size_t)length + 1, format, again);
    page->length += (size_t)length;
  }
  va_end(again);
}

void page_text(struct page *page, const char *text)
{
  for (const char *c = text; *c != '\0'; c++) {
    switch (*c) {
    case '&':
      page_put(page, "&amp;");
      break;
    case '<':
      page_put(page, "&lt;");
      break;
    case '>':
      page_put(page, "&gt;");
      break;
    case '"':
      page_put(page, "&quot;");
      break;
    default:
      put_bytes(page, c, 1);
      break;
    }
  }
}

void page_number(struct page *page, double value, int digits)
{
  char rounded[NUMBER_TEXT_SIZE + 32], text[NUMBER_TEXT_SIZE];
  if (isinf(value)) {
    page_put(page, value > 0 ? "&infin;" : "-&infin;");
    return;
  }
  snprintf(rounded, sizeof rounded, "%.*g", digits, value);
  for (char *c = rounded; *c != '\0'; c++) { /* the locale's point */
    if (*c == ',')
      *c = '.';
  }
  double read = value;
  size_t used;
  (void)number_read(rounded, strlen(rounded), &read, &used);
  number_write(read, text);
  page_put(page, text);
}

static void put_base64(struct page *page, const unsigned char *bytes, size_t size)
{
  static const char DIGITS[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  if (!reserve(page, size / 3 * 4 + 4))
    return;
  for (size_t k = 0; k < size; k += 3) {
    const unsigned b = bytes[k], c = k + 1 < size ? bytes[k + 1] : 0, d = k + 2 < size ? bytes[k + 2] : 0;
    const unsigned group = b << 16 | c << 8 | d;
    const char four[4] = { DIGITS[group >> 18], DIGITS[group >> 12 & 63], k + 1 < size ? DIGITS[group >> 6 & 63] : '=',
                           k + 2 < size ? DIGITS[group & 63] : '=' };
    put_bytes(page, four, sizeof four);
  }
}

void page_image_data(struct page *page, const struct image *image)
{
  const struct image_encoding encoding = { .format = IMAGE_PNG, .bits = 8, .encoded = true };
  unsigned char *bytes;
  size_t size;
  char message[IMAGE_MESSAGE_SIZE];
  const enum status status = image_encode(image, &encoding, &bytes, &size, message);
  if (status != STATUS_OK) {
    page->failed = true;
    if (status == STATUS_FILE)
      snprintf(page->message, sizeof page->message, "%s", message);
    return;
  }
  page_put(page, "data:image/png;base64,");
  put_base64(page, bytes, size);
  free(bytes);
}

void page_begin(struct page *page, const char *title, const char *style)
{
  *page = (struct page){ 0 };
  page_put(page,
           "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
           "<meta name=\"viewport\" content=\"width=device-width\">\n<link rel=\"icon\" href=\"data:,\">\n<title>");
  page_text(page, title);
  page_put(page,
           "</title>\n<style>\n"
           "body { font: 15px/1.45 sans-serif; margin: 2em auto; max-width: 1240px; padding: 0 1em; color: #222 }\n"
           "h1 { font-size: 1.5em } h2 { font-size: 1.15em; margin-top: 2em }\n"
           "table { border-collapse: collapse } th, td { padding: .25em .7em; text-align: right }\n"
           "th { border-bottom: 1px solid #888; font-weight: 600; vertical-align: bottom }\n"
           "td:first-child, th:first-child { text-align: left } tr:nth-child(even) td { background: #f3f3f3 }\n"
           "figure { display: inline-block; margin: 0 1em 1em 0; vertical-align: top }\n"
           "figcaption { color: #555 } img { display: block; max-width: 100% }\n");
  page_put(page, style);
  page_put(page, "</style>\n</head>\n<body>\n<h1>");
  page_text(page, title);
  page_put(page, "</h1>\n");
}

enum status page_finish(struct page *page)
{
  page_put(page, "</body>\n</html>\n");
  if (!page->failed)
    return STATUS_OK;
  return page->message[0] == '\0' ? STATUS_LIMIT : STATUS_FILE;
}

void page_free(struct page *page)
{
  free(page->text);
  *page = (struct page){ 0 };
}
