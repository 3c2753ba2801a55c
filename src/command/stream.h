/* A stream read by lines or records, and what is wrong with one of them. */
#ifndef PSCN_COMMAND_STREAM_H
#define PSCN_COMMAND_STREAM_H

#include <stdbool.h>
#include <stddef.h>

#include "base/diagnostics.h"
#include "base/status.h"

/* How standard input is called in diagnostics. */
#define STREAM_NAME "<stdin>"

/* The longest line, in bytes. */
enum { STREAM_MAX_LINE = 1 << 20 };

/* The stream of a file descriptor, from its first byte. */
struct stream {
  int descriptor;
  bool ended;
  char *buffer;
  size_t size, begin, end; /* of the buffer, and of what in it is still to be read */
  size_t count;            /* lines or records read */
  int reason;              /* errno of STREAM_FAILED */
};

/* STATUS_LIMIT where memory is short. The caller ends with stream_free in any case. */
enum status stream_open(int descriptor, struct stream *out) STATUS_MUST_CHECK;
void stream_free(struct stream *stream);

enum stream_result {
  STREAM_MORE,   /* there are more bytes, or the end was reached */
  STREAM_FAILED, /* the stream can not be read: `reason` says why */
  STREAM_LIMIT   /* memory */
};

/* Reads more bytes behind those that are left; waits for them. */
enum stream_result stream_refill(struct stream *stream);

/* Everything was read and taken. */
static inline bool stream_at_end(const struct stream *stream)
{
  return stream->ended && stream->begin == stream->end;
}

/* The line at the beginning of what is left, without its end, LF or CRLF; `bytes` is its length with it. False where
 * its end is still to come. A line longer than STREAM_MAX_LINE comes as the part that has been read. */
struct stream_line {
  const char *text;
  size_t length, bytes;
};
bool stream_line(const struct stream *stream, struct stream_line *out);

/* Steps over a line or record. */
static inline void stream_take(struct stream *stream, size_t bytes)
{
  stream->begin += bytes;
  stream->count++;
}

/* What is wrong with a line, and where in it: bytes begin .. end-1. text is NULL where nothing is. */
struct stream_fault {
  const char *text;
  size_t begin, end;
};

/* Reads the next number of a line, from byte *at on, and steps over it: 1; 0 where the line holds no more; -1 where
 * what stands there is no finite number, told in out_fault. Either way *at is then the first byte of the word, and
 * out_end the first behind it. */
int stream_number(const struct stream_line *line, size_t *at, double *out_value, size_t *out_end,
                  struct stream_fault *out_fault);

/* Tells the fault of the line at the beginning of what is left. STATUS_INPUT, or STATUS_LIMIT where memory is short. */
enum status stream_explain(const struct stream *stream, const struct stream_line *line, struct stream_fault fault,
                           struct diagnostics *diagnostics) STATUS_MUST_CHECK;

#endif
