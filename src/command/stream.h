/* Standard input read by lines or records, as a dialogue: whatever has come is answered before more is waited for. */
#ifndef PSCN_COMMAND_STREAM_H
#define PSCN_COMMAND_STREAM_H

#include <stddef.h>

#include "command/command.h"

/* A line without its end, LF or CRLF, or a record; `bytes` is its length with the end. */
struct stream_line {
  const char *text;
  size_t length, bytes;
};

/* What is wrong with a line, and where in it: bytes begin .. end-1. text is NULL where nothing is. */
struct stream_fault {
  const char *text;
  size_t begin, end;
};

/* What a command does with its input. `take` is told each line or record, and what is wrong with it is what it answers;
 * the last record may be cut off. `answer`, which may be NULL, is to write to stdout whatever is still to be said of
 * what was taken; a failure, STATUS_LIMIT, ends the reading. */
struct stream_reader {
  struct stream_fault (*take)(void *context, const struct stream_line *line);
  enum status (*answer)(void *context);
  void *context;
  size_t record; /* bytes of a record, 0: lines */
};

/* Reads until standard input ends, or a line is wrong, which is told after all answers to those before it, or something
 * fails: STATUS_INPUT, STATUS_FILE or STATUS_LIMIT, told. */
enum status stream_read(const struct command *command, const struct stream_reader *reader) STATUS_MUST_CHECK;

/* Reads the next number of a line, from byte *at on, and steps over it: 1; 0 where the line holds no more; -1 where
 * what stands there is no finite number, told in out_fault. Either way *at is then the first byte of the word, and
 * out_end the first behind it. */
int stream_number(const struct stream_line *line, size_t *at, double *out_value, size_t *out_end,
                  struct stream_fault *out_fault);

#endif
