/* Text that grows. Text that cannot be kept for lack of memory is dropped, and `failed` remembers that. */
#ifndef PSCN_BASE_TEXT_BUFFER_H
#define PSCN_BASE_TEXT_BUFFER_H

#include <stdbool.h>
#include <stddef.h>

/* A buffer of zeros is empty and may be freed. */
struct text_buffer {
  char *text; /* owned, base/memory.h's; length bytes, then a NUL; NULL while nothing was added */
  size_t length, room;
  bool failed;
};

void text_buffer_free(struct text_buffer *buffer);

/* The text, "" if nothing was added. It is then the caller's (memory_free), and the buffer is empty again. NULL if
 * something could not be kept. */
char *text_buffer_take(struct text_buffer *buffer);

/* Adds bytes, a text, and text formatted as by printf. */
void text_buffer_add(struct text_buffer *buffer, const void *bytes, size_t length);
void text_buffer_add_text(struct text_buffer *buffer, const char *text);
void text_buffer_format(struct text_buffer *buffer, const char *format, ...) __attribute__((format(printf, 2, 3)));

/* Adds foreign text that no terminal obeys: control characters except the newline, and malformed UTF-8, as \xNN. */
void text_buffer_add_printable(struct text_buffer *buffer, const char *text, size_t length);

#endif
