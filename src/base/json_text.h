/* JSON as a text, and counts in it. */
#ifndef PSCN_BASE_JSON_TEXT_H
#define PSCN_BASE_JSON_TEXT_H

#include <jansson.h>
#include <stdint.h>
#include <stdlib.h>

static inline json_t *json_count(uint64_t value) { return json_integer((json_int_t)value); }

/* The text, ended by NUL and with one byte to spare; to be freed. NULL where memory is short, or json is NULL. jansson's
 * json_dumps leaves parts out where its text cannot grow (2.14: a key); a buffer that has room for all gets all. */
static inline char *json_text(const json_t *json, size_t flags)
{
  const size_t length = json_dumpb(json, NULL, 0, flags);
  char *text = length == 0 ? NULL : malloc(length + 2);
  if (text == NULL) return NULL;
  text[length] = text[length + 1] = '\0';
  if (json_dumpb(json, text, length, flags) == length) return text;
  free(text);
  return NULL;
}

#endif
