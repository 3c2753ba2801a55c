/* Growing text and templates. Base64: RFC 4648, section 4. */
#include "check/page.h"

#include <math.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/utsname.h>
#include <time.h>

#include "base/atomic_file.h"
#include "base/number.h"
#include "base/source.h"
#include "image/image_file.h"
#include "library/pscn.h"
#include "check/templates.h"

/* ---- text ---- */

/* Room for `more` bytes and a NUL at the end. */
static bool reserve(struct page *page, size_t more)
{
  if (!page->failed && more <= SIZE_MAX / 4 - page->length && page->length + more + 1 > page->size) {
    const size_t size = 2 * (page->length + more + 1);
    char *text = realloc(page->text, size);
    page->failed = text == NULL;
    page->text = page->failed ? page->text : text;
    page->size = page->failed ? page->size : size;
  }
  page->failed = page->failed || page->length + more + 1 > page->size;
  return !page->failed;
}

void page_bytes(struct page *page, const void *bytes, size_t length)
{
  if (!reserve(page, length)) return;
  memcpy(page->text + page->length, bytes, length);
  page->length += length;
  page->text[page->length] = '\0';
}

void page_format(struct page *page, const char *format, ...)
{
  va_list arguments, again;
  va_start(arguments, format);
  va_copy(again, arguments);
  const int length = vsnprintf(NULL, 0, format, arguments);
  va_end(arguments);
  if (length >= 0 && reserve(page, (size_t)length)) {
    vsnprintf(page->text + page->length, (size_t)length + 1, format, again);
    page->length += (size_t)length;
  }
  va_end(again);
}

void page_free(struct page *page)
{
  free(page->text);
  *page = (struct page){0};
}

void page_printable(struct page *page, const char *text, size_t length)
{
  for (size_t at = 0, size; at < length; at += size) {
    size = source_character(text + at, length - at);
    if (source_is_shown(text + at, size) || text[at] == '\n') {
      page_bytes(page, text + at, size);
      continue;
    }
    size += size == 0;
    for (size_t k = 0; k < size; k++) page_format(page, "\\x%02x", (unsigned char)text[at + k]);
  }
}

static void put_escaped(struct page *page, const char *text)
{
  static const char RESERVED[] = "&<>\"'";
  static const char *const NAME[] = {"&amp;", "&lt;", "&gt;", "&quot;", "&#39;"};
  while (*text != '\0') {
    const size_t free_of_them = strcspn(text, RESERVED);
    page_bytes(page, text, free_of_them);
    text += free_of_them;
    if (*text != '\0') page_format(page, "%s", NAME[strchr(RESERVED, *text++) - RESERVED]);
  }
}

/* ---- templates ---- */

enum { MOST_NESTED = 8 };

/* The objects whose names hold, the innermost last. */
struct scope {
  const json_t *value[MOST_NESTED];
  size_t depth;
};

static const json_t *find(const struct scope *scope, const char *name, size_t length)
{
  const json_t *found = NULL;
  for (size_t k = scope->depth; k-- > 0 && found == NULL;) found = json_object_getn(scope->value[k], name, length);
  return found;
}

static bool is_nothing(const json_t *value)
{
  return value == NULL || json_is_null(value) || json_is_false(value) ||
         (json_is_array(value) && json_array_size(value) == 0);
}

/* As printf does, with the point for the locale's comma. */
static void put_decimal(struct page *page, double value, int width, int digits, char letter)
{
  char text[512]; /* %f of the largest double has 309 digits before the point */
  if (letter == 'f') snprintf(text, sizeof text, "%*.*f", width, digits, value);
  else if (letter == 'e') snprintf(text, sizeof text, "%*.*e", width, digits, value);
  else snprintf(text, sizeof text, "%*.*g", width, digits, value);
  char *comma = strchr(text, ',');
  if (comma != NULL) *comma = '.';
  page_bytes(page, text, strlen(text));
}

/* The shortest text of the number rounded to so many digits. */
static void put_shortest(struct page *page, double value, int digits)
{
  struct page rounded = {0};
  char text[NUMBER_TEXT_SIZE];
  size_t used;
  put_decimal(&rounded, value, 0, digits, 'g');
  if (!rounded.failed && number_read(rounded.text, rounded.length, &value, &used) == NUMBER_FINITE) {
    number_write(value, text);
    page_bytes(page, text, strlen(text));
  }
  page->failed = page->failed || rounded.failed;
  page_free(&rounded);
}

/* format: WIDTH.DIGITS and a letter, or DIGITS alone, or "". */
static void put_value(struct page *page, const json_t *value, const char *format, bool as_it_is)
{
  char *point;
  const long width = strtol(format, &point, 10), digits = *point == '.' ? strtol(point + 1, &point, 10) : 0;
  if (json_is_string(value) && *point == 's') page_format(page, "%*s", (int)width, json_string_value(value));
  else if (json_is_string(value) && as_it_is) page_bytes(page, json_string_value(value), json_string_length(value));
  else if (json_is_string(value)) put_escaped(page, json_string_value(value));
  else if (json_is_number(value) && strchr("feg", *point) != NULL && *point != '\0')
    put_decimal(page, json_number_value(value), (int)width, (int)digits, *point);
  else if (json_is_integer(value)) page_format(page, "%*" JSON_INTEGER_FORMAT, (int)width, json_integer_value(value));
  else if (json_is_real(value)) put_shortest(page, json_real_value(value), width > 0 ? (int)width : 17);
}

static void fill(struct page *page, const char *text, size_t length, struct scope *scope);

static void fill_with(struct page *page, const char *text, size_t length, const json_t *value, struct scope *scope)
{
  if (scope->depth == MOST_NESTED) return;
  scope->value[scope->depth++] = value;
  fill(page, text, length, scope);
  scope->depth--;
}

static void fill_section(struct page *page, const char *text, size_t length, const json_t *value, bool inverted,
                         struct scope *scope)
{
  if (inverted || is_nothing(value)) {
    if (inverted && is_nothing(value)) fill(page, text, length, scope);
  } else if (json_is_array(value)) {
    for (size_t k = 0; k < json_array_size(value); k++) fill_with(page, text, length, json_array_get(value, k), scope);
  } else {
    fill_with(page, text, length, value, scope);
  }
}

/* Where the section of that name ends: its {{/name}}. */
static const char *section_end(const char *text, const char *name, size_t length)
{
  for (const char *at = text; (at = strstr(at, "{{/")) != NULL; at += 3)
    if (strncmp(at + 3, name, length) == 0 && strncmp(at + 3 + length, "}}", 2) == 0) return at;
  return NULL;
}

static void fill(struct page *page, const char *text, size_t length, struct scope *scope)
{
  const char *const end = text + length;
  while (text < end) {
    const char *tag = strstr(text, "{{");
    const char *close = tag == NULL || tag >= end ? NULL : strstr(tag, "}}");
    page_bytes(page, text, (size_t)((close == NULL ? end : tag) - text));
    if (close == NULL) return;
    const bool section = tag[2] == '#' || tag[2] == '^', as_it_is = tag[2] == '&';
    const char *name = tag + 2 + (section || as_it_is), *format = memchr(name, ':', (size_t)(close - name));
    const size_t name_length = (size_t)((format == NULL ? close : format) - name);
    const json_t *value = find(scope, name, name_length);
    const char *rest = section ? section_end(close, name, name_length) : NULL;
    text = close + 2;
    if (rest != NULL) {
      fill_section(page, text, (size_t)(rest - text), value, tag[2] == '^', scope);
      text = rest + 5 + name_length;
    } else {
      put_value(page, value, format == NULL ? "" : format + 1, as_it_is);
    }
  }
}

void page_fill(struct page *page, const char *template, const json_t *values)
{
  struct scope scope = {{values}, 1};
  page->failed = page->failed || values == NULL;
  if (!page->failed) fill(page, template, strlen(template), &scope);
}

/* ---- files ---- */

enum status page_write(const struct listener *listener, size_t count, char (*paths)[PAGE_PATH_SIZE],
                       const struct page pages[])
{
  struct atomic_file *files = calloc(count, sizeof *files);
  bool failed = files == NULL;
  size_t which;
  int reason;
  for (size_t k = 0; k < count && !failed; k++) {
    files[k] = (struct atomic_file){paths[k], pages[k].text, pages[k].length};
    failed = pages[k].failed;
  }
  enum status status = failed ? listener_out_of_memory(listener)
                              : atomic_files_write(files, count, listener->stop, &which, &reason);
  if (!failed && (status == STATUS_FILE || status == STATUS_LIMIT))
    status = listener_fail(listener, status, "cannot write '%s': %s", files[which].path, strerror(reason));
  free(files);
  return status;
}

/* ---- values ---- */

json_t *page_of_number(double value) { return isfinite(value) ? json_real(value) : json_null(); }

json_t *page_of_count(size_t count) { return json_integer((json_int_t)count); }

static json_t *take_text(struct page *page)
{
  json_t *text = page->failed ? NULL : json_stringn_nocheck(page->text == NULL ? "" : page->text, page->length);
  page_free(page);
  return text;
}

json_t *page_of_text(const char *text)
{
  struct page printable = {0};
  page_printable(&printable, text, strlen(text));
  return take_text(&printable);
}

void page_png(const struct image *image, struct page *out)
{
  const struct image_encoding encoding = {.format = IMAGE_PNG, .bits = 8, .encoded = true};
  unsigned char *bytes;
  size_t size;
  char message[IMAGE_MESSAGE_SIZE];
  *out = (struct page){.failed = image_encode(image, &encoding, &bytes, &size, message) != STATUS_OK};
  if (!out->failed) *out = (struct page){.text = (char *)bytes, .length = size, .size = size};
}

static void put_base64(struct page *page, const unsigned char *bytes, size_t size)
{
  static const char DIGITS[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  if (!reserve(page, size / 3 * 4 + 4)) return;
  for (size_t k = 0; k < size; k += 3) {
    const unsigned b = bytes[k], c = k + 1 < size ? bytes[k + 1] : 0, d = k + 2 < size ? bytes[k + 2] : 0;
    const unsigned group = b << 16 | c << 8 | d;
    const char four[4] = {DIGITS[group >> 18], DIGITS[group >> 12 & 63], k + 1 < size ? DIGITS[group >> 6 & 63] : '=',
                          k + 2 < size ? DIGITS[group & 63] : '='};
    page_bytes(page, four, sizeof four);
  }
}

json_t *page_of_png(const struct page *png)
{
  struct page text = {.failed = png->failed};
  page_format(&text, "data:image/png;base64,");
  put_base64(&text, (const unsigned char *)png->text, png->length);
  return take_text(&text);
}

/* The processor's name where Linux tells it, else the machine's kind; never whose machine it is. */
static void find_machine(char *out, size_t size)
{
  struct utsname system;
  char line[256];
  snprintf(out, size, "%s", uname(&system) == 0 ? system.machine : "");
  FILE *file = fopen("/proc/cpuinfo", "r");
  while (file != NULL && fgets(line, sizeof line, file) != NULL) {
    const char *name = strncmp(line, "model name", 10) == 0 ? strstr(line, ": ") : NULL;
    if (name == NULL) continue;
    snprintf(out, size, "%.*s", (int)strcspn(name + 2, "\n"), name + 2);
    break;
  }
  if (file != NULL) (void)fclose(file);
}

json_t *page_of_head(const char *command_line)
{
  char machine[256], date[64] = "";
  const time_t now = time(NULL);
  struct tm calendar;
  if (gmtime_r(&now, &calendar) != NULL) (void)strftime(date, sizeof date, "%Y-%m-%d %H:%M UTC", &calendar);
  find_machine(machine, sizeof machine);
  return json_pack("{s:s,s:s,s:o,s:o,s:s}", "version", PSCN_VERSION, "date", date, "machine", page_of_text(machine),
                   "command", page_of_text(command_line), "head", TEMPLATE_HEAD);
}
