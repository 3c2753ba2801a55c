/* Fuzzes the text of --solver: a text that is accepted, written back, reads as the same method. */
#include <string.h>

#include "language/language.h"
#include "scene/method.h"
#include "target.h"

static void tell(void *context, const char *text, size_t length)
{
  assert(length > 0 && text[length - 1] == '\n');
  ++*(size_t *)context;
}

static enum status parse(const char *text, struct method *out)
{
  size_t told = 0;
  struct diagnostics diagnostics = {.tell = tell, .context = &told};
  *out = (struct method){0};
  const enum status status = language_parse_solver(text, &diagnostics, out);
  assert((status == STATUS_OK) == (out->roots.solver != NULL) && (status == STATUS_OK) == (told == 0));
  assert(status == STATUS_OK || status == STATUS_USAGE || status == STATUS_LIMIT);
  return status;
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
  char text[1000], canonical[METHOD_TEXT_SIZE];
  struct method method, again;
  if (size >= sizeof text || memchr(data, '\0', size)) return 0;
  memcpy(text, data, size);
  text[size] = '\0';
  if (parse(text, &method) != STATUS_OK) return 0;
  method_text(&method, canonical, sizeof canonical);
  assert(parse(canonical, &again) == STATUS_OK && method_equal(&method, &again));
  return 0;
}
