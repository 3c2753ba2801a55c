/* Reads a file or standard input by lines or records, as a dialogue: everything read so far is answered before waiting
 * for more.
 *
 * Of lines, '#' begins a comment, and those with nothing else are passed over, as is a byte order mark before the
 * first. Numbers have blanks between them, or one comma. */
#ifndef PSCN_COMMAND_STREAM_H
#define PSCN_COMMAND_STREAM_H

#include <stddef.h>

#include "command/command.h"

/* A line without its comment and its end, LF or CRLF, or a record. `bytes` is its length with the end, `number` the
 * line's, or the record's, from 1. */
struct stream_line {
  const char *text;
  size_t length, bytes, number;
};

/* The fault of a line, and where it is: bytes begin .. end-1. text is NULL if there is none. */
struct stream_fault {
  const char *text;
  size_t begin, end;
};

/* How a command handles its input. `take` gets each line or record and returns its fault; the last record may be cut
 * off. `answer`, which may be NULL, writes to stdout the outstanding answers to what was taken; if it fails, with
 * STATUS_LIMIT, reading ends. */
struct stream_reader {
  struct stream_fault (*take)(void *context, const struct stream_line *line);
  enum status (*answer)(void *context);
  void *context;
  size_t record;    /* bytes of a record, 0: lines */
  const char *path; /* the file, NULL or "-": standard input */
};

/* What messages call the input. */
const char *stream_name(const char *path);

/* Reads until the input ends, a line is faulty, or something fails. A fault is printed after all answers to the
 * lines before it. Returns STATUS_INPUT, STATUS_FILE or STATUS_LIMIT, after printing the error. */
enum status stream_read(const struct command *command, const struct stream_reader *reader) STATUS_MUST_CHECK;

/* A number of a line, bytes begin .. end-1. */
struct stream_number {
  double value;
  size_t begin, end;
};

/* Reads a line's numbers, `least` to `most` of them; `few` and `many` are the texts of the faults if there are others. */
struct stream_fault stream_numbers(const struct stream_line *line, size_t least, size_t most, const char *few,
                                   const char *many, struct stream_number out[], size_t *out_count);

#endif
