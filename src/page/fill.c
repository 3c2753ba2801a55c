/* Fills in templates. */
#include "page/fill.h"

#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/number.h"

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
