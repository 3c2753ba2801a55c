/* Pages: templates, figures, values and files. Base64: RFC 4648, section 4. */
#include "page/page.h"

#include <errno.h>
#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/utsname.h>
#include <time.h>

#include "base/atomic_file.h"
#include "base/number.h"
#include "page/templates.h"
#include "image/image_file.h"
#include "library/pscn.h"
#include "page/process.h"
#include "page/scratch.h"

/* ---- templates ---- */

enum { MOST_NESTED = 8 };

/* Names are looked up in these objects, the innermost last. */
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

static void put_escaped(struct text_buffer *out, const char *text)
{
  static const char RESERVED[] = "&<>\"'";
  static const char *const NAME[] = {"&amp;", "&lt;", "&gt;", "&quot;", "&#39;"};
  while (*text != '\0') {
    const size_t free_of_them = strcspn(text, RESERVED);
    text_buffer_add(out, text, free_of_them);
    text += free_of_them;
    if (*text != '\0') text_buffer_add_text(out, NAME[strchr(RESERVED, *text++) - RESERVED]);
  }
}

/* Like printf: the program's locale is "C". */
static void put_decimal(struct text_buffer *out, double value, int width, int digits, char letter)
{
  char text[512]; /* %f of the largest double has 309 digits before the point */
  if (letter == 'f') snprintf(text, sizeof text, "%*.*f", width, digits, value);
  else if (letter == 'e') snprintf(text, sizeof text, "%*.*e", width, digits, value);
  else snprintf(text, sizeof text, "%*.*g", width, digits, value);
  text_buffer_add_text(out, text);
}

/* The shortest text of the number rounded to `digits` digits. */
static void put_shortest(struct text_buffer *out, double value, int digits)
{
  struct text_buffer rounded = {0};
  char text[NUMBER_TEXT_SIZE];
  size_t used;
  put_decimal(&rounded, value, 0, digits, 'g');
  if (!rounded.failed && number_read(rounded.text, rounded.length, &value, &used) == NUMBER_FINITE) {
    number_write(value, text);
    text_buffer_add_text(out, text);
  }
  out->failed = out->failed || rounded.failed;
  text_buffer_free(&rounded);
}

/* format: WIDTH.DIGITS and a letter, or DIGITS alone, or "". */
static void put_value(struct text_buffer *out, const json_t *value, const char *format, bool as_it_is)
{
  char *point;
  const long width = strtol(format, &point, 10), digits = *point == '.' ? strtol(point + 1, &point, 10) : 0;
  if (json_is_string(value) && *point == 's') text_buffer_format(out, "%*s", (int)width, json_string_value(value));
  else if (json_is_string(value) && as_it_is) text_buffer_add(out, json_string_value(value), json_string_length(value));
  else if (json_is_string(value)) put_escaped(out, json_string_value(value));
  else if (json_is_number(value) && strchr("feg", *point) != NULL && *point != '\0')
    put_decimal(out, json_number_value(value), (int)width, (int)digits, *point);
  else if (json_is_integer(value))
    text_buffer_format(out, "%*" JSON_INTEGER_FORMAT, (int)width, json_integer_value(value));
  else if (json_is_real(value)) put_shortest(out, json_real_value(value), width > 0 ? (int)width : 17);
}

static void fill(struct text_buffer *out, const char *text, size_t length, struct scope *scope);

static void fill_with(struct text_buffer *out, const char *text, size_t length, const json_t *value,
                      struct scope *scope)
{
  if (scope->depth == MOST_NESTED) return;
  scope->value[scope->depth++] = value;
  fill(out, text, length, scope);
  scope->depth--;
}

static void fill_section(struct text_buffer *out, const char *text, size_t length, const json_t *value, bool inverted,
                         struct scope *scope)
{
  if (inverted || is_nothing(value)) {
    if (inverted && is_nothing(value)) fill(out, text, length, scope);
  } else if (json_is_array(value)) {
    for (size_t k = 0; k < json_array_size(value); k++) fill_with(out, text, length, json_array_get(value, k), scope);
  } else {
    fill_with(out, text, length, value, scope);
  }
}

/* The end of the section of that name: its {{/name}}. */
static const char *section_end(const char *text, const char *name, size_t length)
{
  for (const char *at = text; (at = strstr(at, "{{/")) != NULL; at += 3)
    if (strncmp(at + 3, name, length) == 0 && strncmp(at + 3 + length, "}}", 2) == 0) return at;
  return NULL;
}

static void fill(struct text_buffer *out, const char *text, size_t length, struct scope *scope)
{
  const char *const end = text + length;
  while (text < end) {
    const char *tag = strstr(text, "{{");
    const char *close = tag == NULL || tag >= end ? NULL : strstr(tag, "}}");
    text_buffer_add(out, text, (size_t)((close == NULL ? end : tag) - text));
    if (close == NULL) return;
    const bool section = tag[2] == '#' || tag[2] == '^', as_it_is = tag[2] == '&';
    const char *name = tag + 2 + (section || as_it_is), *format = memchr(name, ':', (size_t)(close - name));
    const size_t name_length = (size_t)((format == NULL ? close : format) - name);
    const json_t *value = find(scope, name, name_length);
    const char *rest = section ? section_end(close, name, name_length) : NULL;
    text = close + 2;
    if (rest != NULL) {
      fill_section(out, text, (size_t)(rest - text), value, tag[2] == '^', scope);
      text = rest + 5 + name_length;
    } else {
      put_value(out, value, format == NULL ? "" : format + 1, as_it_is);
    }
  }
}

void fill_template(struct text_buffer *out, const char *template, const json_t *values)
{
  struct scope scope = {{values}, 1};
  out->failed = out->failed || values == NULL;
  if (!out->failed) fill(out, template, strlen(template), &scope);
}

/* ---- figures, by gnuplot ---- */

static const char SCRIPT[] = "figure.gp", FIGURE[] = "figure.svg", LOG[] = "gnuplot.log";

#define TIMEOUT 120.0 /* seconds; a figure takes less than one */

/* gnuplot shows the texts of points by a script of its own; HTML and SVG have titles for that. */
static void copy_with_titles(const char *svg, struct text_buffer *out)
{
  static const char BEGIN[] = " onmousemove=\"gnuplot_svg.showHypertext(evt,'", END[] = "</title>";
  for (const char *at; (at = strstr(svg, BEGIN)) != NULL;) {
    const char *text = at + sizeof BEGIN - 1, *close = strstr(text, "')\""), *end = strstr(text, END);
    if (close == NULL || end == NULL) break;
    text_buffer_add(out, svg, (size_t)(at - svg));
    text_buffer_format(out, "><title>%.*s", (int)(close - text), text);
    svg = end;
  }
  text_buffer_add_text(out, svg);
}

/* Reads the figure that gnuplot wrote, if it is complete. */
static void read_figure(const char *folder, struct text_buffer *out)
{
  static const char LAST[] = "</svg>";
  struct text_buffer svg = scratch_read(folder, FIGURE);
  const char *begin = svg.text == NULL ? NULL : strstr(svg.text, "<svg");
  char *end = begin == NULL ? NULL : strstr(begin, LAST);
  out->failed = svg.failed;
  if (end != NULL) {
    end[sizeof LAST - 1] = '\0';
    copy_with_titles(begin, out);
  }
  text_buffer_free(&svg);
}

static enum status run_gnuplot(const struct listener *listener, const char *folder, struct text_buffer *out)
{
  char log[SCRATCH_PATH_SIZE];
  scratch_path(folder, LOG, log);
  const char *const arguments[] = {"gnuplot", SCRIPT, NULL};
  const char *const environment[] = {"LC_ALL", "C", NULL};
  const struct process_request request = {
    .arguments = arguments, .folder = folder, .environment = environment, .output = log, .timeout = TIMEOUT};
  struct process_result result;
  const enum status status = process_run(&request, listener->stop, &result);
  if (status == STATUS_INTERRUPTED) return status;
  if (status == STATUS_OK && result.exit_code == 0) read_figure(folder, out);
  if (out->length == 0 && result.missing) {
    listener_tell(listener, TOLD_PROGRESS,
                  "gnuplot is not installed, so there is no figure; the numbers are written "
                  "all the same. On Debian 'apt-get install gnuplot-nox' installs it.");
  } else if (out->length == 0) {
    struct text_buffer text = scratch_read(folder, LOG), said = {0};
    out->failed = text.failed || out->failed;
    if (status == STATUS_LIMIT) text_buffer_format(&said, "it took more than %g seconds", TIMEOUT);
    else if (status != STATUS_OK) text_buffer_add_text(&said, strerror(result.reason));
    else if (text.text != NULL) text_buffer_add_printable(&said, text.text, text.length < 400 ? text.length : 400);
    listener_tell(listener, TOLD_WARNING, "gnuplot made no figure: %s",
                  said.text == NULL ? "its file cannot be read" : said.text);
    text_buffer_free(&said);
    text_buffer_free(&text);
  }
  return out->failed ? listener_out_of_memory(listener) : STATUS_OK;
}

enum status plot_draw(const struct listener *listener, const char *template, const json_t *values,
                      struct text_buffer *out)
{
  char folder[SCRATCH_PATH_SIZE];
  struct text_buffer script = {0};
  *out = (struct text_buffer){0};
  fill_template(&script, template, values);
  if (script.failed) {
    text_buffer_free(&script);
    return listener_out_of_memory(listener);
  }
  enum status status = scratch_create(folder);
  FILE *file = status == STATUS_OK ? scratch_open(folder, SCRIPT) : NULL;
  if (file != NULL) {
    (void)fwrite(script.text, 1, script.length, file);
    status = scratch_close(file);
  }
  if (status != STATUS_OK || file == NULL)
    status = listener_fail(listener, STATUS_FILE, "cannot write a temporary file: %s", strerror(errno));
  else status = run_gnuplot(listener, folder, out);
  scratch_remove(folder);
  text_buffer_free(&script);
  return status;
}

/* ---- files ---- */

enum status page_write(const struct listener *listener, const char *folder, size_t count, const char *const names[],
                       const struct text_buffer pages[])
{
  struct atomic_file *files = calloc(count, sizeof *files);
  struct text_buffer *paths = calloc(count, sizeof *paths);
  bool failed = files == NULL || paths == NULL;
  size_t which;
  int reason;
  for (size_t k = 0; k < count && !failed; k++) {
    text_buffer_format(&paths[k], "%s/%s", folder, names[k]);
    files[k] = (struct atomic_file){paths[k].text, pages[k].text, pages[k].length};
    failed = paths[k].failed || pages[k].failed;
  }
  enum status status = failed ? listener_out_of_memory(listener)
                              : atomic_files_write(files, count, listener->stop, &which, &reason);
  if (!failed && (status == STATUS_FILE || status == STATUS_LIMIT))
    status = listener_fail(listener, status, "cannot write '%s': %s", files[which].path, strerror(reason));
  for (size_t k = 0; k < count && paths != NULL; k++) text_buffer_free(&paths[k]);
  free(paths);
  free(files);
  return status;
}

/* ---- values ---- */

json_t *page_of_number(double value) { return isfinite(value) ? json_real(value) : json_null(); }

static json_t *take_text(struct text_buffer *buffer)
{
  json_t *text = buffer->failed ? NULL : json_stringn_nocheck(buffer->text == NULL ? "" : buffer->text, buffer->length);
  text_buffer_free(buffer);
  return text;
}

json_t *page_of_text(const char *text)
{
  struct text_buffer printable = {0};
  text_buffer_add_printable(&printable, text, strlen(text));
  return take_text(&printable);
}

void page_png(const struct image *image, struct text_buffer *out)
{
  const struct image_encoding encoding = {.format = IMAGE_PNG, .bits = 8, .encoded = true};
  unsigned char *bytes;
  size_t size;
  char message[IMAGE_MESSAGE_SIZE];
  *out = (struct text_buffer){.failed = image_encode(image, &encoding, &bytes, &size, message) != STATUS_OK};
  if (out->failed) return;
  text_buffer_add(out, bytes, size);
  free(bytes);
}

static void put_base64(struct text_buffer *out, const unsigned char *bytes, size_t size)
{
  static const char DIGITS[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  for (size_t k = 0; k < size; k += 3) {
    const unsigned b = bytes[k], c = k + 1 < size ? bytes[k + 1] : 0, d = k + 2 < size ? bytes[k + 2] : 0;
    const unsigned group = b << 16 | c << 8 | d;
    const char four[4] = {DIGITS[group >> 18], DIGITS[group >> 12 & 63], k + 1 < size ? DIGITS[group >> 6 & 63] : '=',
                          k + 2 < size ? DIGITS[group & 63] : '='};
    text_buffer_add(out, four, sizeof four);
  }
}

json_t *page_of_png(const struct text_buffer *png)
{
  struct text_buffer text = {.failed = png->failed};
  text_buffer_add_text(&text, "data:image/png;base64,");
  put_base64(&text, (const unsigned char *)png->text, png->length);
  return take_text(&text);
}

/* The processor's name if Linux tells it, else the kind of machine; never a name that identifies the machine. */
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

json_t *page_of_file(const char *path)
{
  const char *slash = strrchr(path, '/');
  return page_of_text(slash == NULL ? path : slash + 1);
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
