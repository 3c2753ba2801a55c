/* JSON values and their text: whole, or NULL. */
#ifndef PSCN_BASE_JSON_TEXT_H
#define PSCN_BASE_JSON_TEXT_H

#include <jansson.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdlib.h>

static inline json_t *json_count(uint64_t value) { return json_integer((json_int_t)value); }

/* The list with the value appended, and the object with the members of another one; NULL where memory is short, or
 * either argument is NULL. They take over both arguments, as json_pack does. */
static inline json_t *json_append(json_t *list, json_t *value)
{
  if (json_array_append_new(list, value) == 0) return list;
  json_decref(list);
  return NULL;
}

static inline json_t *json_join(json_t *object, json_t *other)
{
  const bool whole = json_object_update(object, other) == 0;
  json_decref(other);
  if (whole) return object;
  json_decref(object);
  return NULL;
}

/* The text, ended by NUL and with one byte to spare; the caller frees it. NULL where memory is short, or json is NULL.
 * jansson's json_dumps leaves parts out where its text cannot grow (2.14: a key), so the text goes to a buffer with
 * room for all of it. */
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
