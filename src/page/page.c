/* Values for pages, and their files. Base64: RFC 4648, section 4. */
#include "page/page.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/utsname.h>
#include <time.h>

#include "base/atomic_file.h"
#include "page/templates.h"
#include "image/image_file.h"
#include "library/pscn.h"

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
