/* A stream read by lines or records. */
#include "command/stream.h"

#include <errno.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/number.h"

enum { BUFFER_SIZE = 1 << 16 };

enum status stream_open(int descriptor, struct stream *out)
{
  *out = (struct stream){ .descriptor = descriptor, .size = BUFFER_SIZE };
  out->buffer = malloc(out->size);
  return out->buffer == NULL ? STATUS_LIMIT : STATUS_OK;
}

void stream_free(struct stream *stream)
{
  free(stream->buffer);
  *stream = (struct stream){ 0 };
}

enum stream_result stream_refill(struct stream *stream)
{
  memmove(stream->buffer, stream->buffer + stream->begin, stream->end - stream->begin);
  stream->end -= stream->begin;
  stream->begin = 0;
  if (stream->end == stream->size) {
    char *larger = realloc(stream->buffer, 2 * stream->size);
    if (larger == NULL)
      return STREAM_LIMIT;
    stream->buffer = larger;
    stream->size *= 2;
  }
  ssize_t length;
  do
    length = read(stream->descriptor, stream->buffer + stream->end, stream->size - stream->end);
  while (length < 0 && errno == EINTR);
  if (length < 0) {
    stream->reason = errno;
    return STREAM_FAILED;
  }
  stream->ended = length == 0;
  stream->end += (size_t)length;
  return STREAM_MORE;
}

bool stream_line(const struct stream *stream, struct stream_line *out)
{
  const char *line = stream->buffer + stream->begin;
  const size_t left = stream->end - stream->begin;
  const char *newline = memchr(line, '\n', left);
  if (newline == NULL && !stream->ended && left <= STREAM_MAX_LINE)
    return false;
  const size_t length = newline == NULL ? left : (size_t)(newline - line);
  out->text = line;
  out->bytes = newline == NULL ? left : length + 1;
  out->length = length > 0 && line[length - 1] == '\r' ? length - 1 : length;
  return true;
}

static bool is_blank(char c)
{
  return c == ' ' || c == '\t';
}

int stream_number(const struct stream_line *line, size_t *at, double *out_value, size_t *out_end,
                  struct stream_fault *out_fault)
{
  while (*at < line->length && is_blank(line->text[*at]))
    ++*at;
  size_t end = *at, used;
  while (end < line->length && !is_blank(line->text[end]))
    end++;
  *out_end = end > *at ? end : end + 1;
  *out_fault = (struct stream_fault){ NULL, *at, *out_end };
  if (*at == line->length)
    return 0;
  const enum number_kind kind = number_read(line->text + *at, end - *at, out_value, &used);
  if (kind == NUMBER_NONE || (kind == NUMBER_FINITE && *at + used != end))
    out_fault->text = "this is no number";
  else if (kind == NUMBER_OVERFLOW)
    out_fault->text = "the number is too large";
  else
    return 1;
  return -1;
}

enum status stream_explain(const struct stream *stream, const struct stream_line *line, struct stream_fault fault,
                           struct diagnostics *diagnostics)
{
  /* The line alone, standing where it stood in the stream: after as many line ends. */
  const size_t length = line->length > STREAM_MAX_LINE ? 1 : line->length;
  char *text = length > SIZE_MAX - stream->count ? NULL : malloc(stream->count + length + 1);
  if (text == NULL)
    return STATUS_LIMIT;
  memset(text, '\n', stream->count);
  memcpy(text + stream->count, line->text, length);
  struct source *source = source_from_text(STREAM_NAME, text, stream->count + length);
  free(text);
  if (source == NULL)
    return STATUS_LIMIT;
  const struct place place = { source, stream->count + fault.begin, stream->count + fault.end };
  diagnostics_error(diagnostics, place, "%s", fault.text);
  source_destroy(source);
  return STATUS_INPUT;
}
