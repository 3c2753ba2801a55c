/* Text that grows, to twice what is needed and a little more: most texts are allocated once. */
#include "base/text_buffer.h"

#include <stdarg.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include "base/memory.h"
#include "base/source.h"

enum { LITTLE = 256 };

/* Room for `more` bytes and a NUL at the end. */
static bool reserve(struct text_buffer *buffer, size_t more)
{
  if (more < buffer->size - buffer->length) return true;
  char *text = NULL;
  const size_t size = more > SIZE_MAX / 4 - buffer->length ? 0 : 2 * (buffer->length + more) + LITTLE;
  if (size > 0) text = memory_resize(buffer->text, size);
  if (text == NULL) buffer->failed = true;
  if (text == NULL) return false;
  buffer->text = text;
  buffer->size = size;
  return true;
}

void text_buffer_free(struct text_buffer *buffer)
{
  memory_free(buffer->text);
  *buffer = (struct text_buffer){0};
}

void text_buffer_add(struct text_buffer *buffer, const void *bytes, size_t length)
{
  if (!reserve(buffer, length)) return;
  memcpy(buffer->text + buffer->length, bytes, length);
  buffer->length += length;
  buffer->text[buffer->length] = '\0';
}

void text_buffer_add_text(struct text_buffer *buffer, const char *text) { text_buffer_add(buffer, text, strlen(text)); }

void text_buffer_format(struct text_buffer *buffer, const char *format, ...)
{
  va_list arguments, again;
  va_start(arguments, format);
  va_copy(again, arguments);
  const int length = vsnprintf(NULL, 0, format, arguments);
  va_end(arguments);
  if (length >= 0 && reserve(buffer, (size_t)length)) {
    vsnprintf(buffer->text + buffer->length, (size_t)length + 1, format, again);
    buffer->length += (size_t)length;
  }
  va_end(again);
}

void text_buffer_add_printable(struct text_buffer *buffer, const char *text, size_t length)
{
  for (size_t at = 0, size; at < length; at += size) {
    size = source_character(text + at, length - at);
    if (source_is_shown(text + at, size) || text[at] == '\n') {
      text_buffer_add(buffer, text + at, size);
      continue;
    }
    size += size == 0;
    for (size_t k = 0; k < size; k++) text_buffer_format(buffer, "\\x%02x", (unsigned char)text[at + k]);
  }
}
