/* Text that grows. */
#include "base/text_buffer.h"

#include <stdarg.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include "base/memory.h"
#include "base/source.h"

/* Makes room for `more` bytes and a NUL at the end. */
static bool reserve(struct text_buffer *buffer, size_t more)
{
  if (more < buffer->room - buffer->length) return true;
  const bool countable = more < SIZE_MAX - buffer->length;
  char *text = countable ? memory_grow(buffer->text, &buffer->room, buffer->length + more + 1, 1) : NULL;
  if (text) buffer->text = text;
  else buffer->failed = true;
  return text != NULL;
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

char *text_buffer_take(struct text_buffer *buffer)
{
  text_buffer_add(buffer, "", 0); /* so that there is a text */
  char *text = buffer->text;
  if (buffer->failed) memory_free(text), text = NULL;
  *buffer = (struct text_buffer){0};
  return text;
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
