/* The text of --solver. */
#include <math.h>
#include <string.h>

#include "language/language.h"
#include "target.h"

static void tell(void *context, const char *text, size_t length)
{
  assert(length > 0 && text[length - 1] == '\n');
  ++*(size_t *)context;
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
  char text[1000];
  if (size >= sizeof text || memchr(data, '\0', size)) return 0;
  memcpy(text, data, size);
  text[size] = '\0';
  size_t told = 0;
  struct diagnostics diagnostics = {.tell = tell, .context = &told};
  struct method method = {0};
  const enum status status = language_parse_solver(text, &diagnostics, &method);
  assert((status == STATUS_OK) == (method.roots.solver != NULL) && (status == STATUS_OK) == (told == 0));
  assert(status == STATUS_OK || status == STATUS_USAGE || status == STATUS_LIMIT);
  return 0;
}
