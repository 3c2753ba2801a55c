/* Input read by lines or records. */
#include "command/stream.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/input.h"
#include "base/number.h"
#include "command/output.h"
#include "command/scene_file.h"

enum {
  BUFFER_SIZE = 1 << 16,
  MAX_LINE = 1 << 20 /* bytes */
};

/* The input, from its first byte. */
struct stream {
  const char *name;
  int file;
  bool ended;
  char *buffer;
  size_t size, begin, end; /* of the buffer, and of its unread bytes */
  size_t count;            /* lines or records read */
};

const char *stream_name(const char *path) { return path == NULL || output_is_standard(path) ? "stdin" : path; }

/* Reads more bytes, after the unread ones; waits for them. */
static enum status refill(const struct command *command, struct stream *stream)
{
  memmove(stream->buffer, stream->buffer + stream->begin, stream->end - stream->begin);
  stream->end -= stream->begin;
  stream->begin = 0;
  if (stream->end == stream->size) {
    char *larger = realloc(stream->buffer, 2 * stream->size);
    if (larger == NULL) return STATUS_LIMIT;
    stream->buffer = larger;
    stream->size *= 2;
  }
  ssize_t length;
  do length = read(stream->file, stream->buffer + stream->end, stream->size - stream->end);
  while (length < 0 && errno == EINTR);
  if (length < 0) {
    command_error(command, "cannot read %s: %s", stream->file == STDIN_FILENO ? "standard input" : stream->name,
                  input_reason(errno));
    return STATUS_FILE;
  }
  stream->ended = length == 0;
  stream->end += (size_t)length;
  return STATUS_OK;
}

/* Finds the line or record at the beginning of the unread bytes. Returns false if its end has not been read. A line
 * longer than MAX_LINE is returned as far as it has been read. */
static bool find_line(const struct stream *stream, size_t record, struct stream_line *out)
{
  const char *line = stream->buffer + stream->begin;
  const size_t left = stream->end - stream->begin;
  out->number = stream->count + 1;
  if (record != 0) {
    out->text = line;
    out->length = out->bytes = left < record ? left : record;
    return left >= record || stream->ended;
  }
  const char *newline = memchr(line, '\n', left);
  if (newline == NULL && !stream->ended && left <= MAX_LINE) return false;
  const size_t length = newline == NULL ? left : (size_t)(newline - line);
  out->text = line;
  out->bytes = newline == NULL ? left : length + 1;
  out->length = length > 0 && line[length - 1] == '\r' ? length - 1 : length;
  return true;
}

static bool is_blank(char c) { return c == ' ' || c == '\t'; }

/* Cuts off the comment. Returns whether anything is left. */
static bool has_words(struct stream_line *line)
{
  const char *comment = memchr(line->text, '#', line->length);
  if (comment != NULL) line->length = (size_t)(comment - line->text);
  for (size_t k = 0; k < line->length; k++)
    if (!is_blank(line->text[k])) return true;
  return false;
}

/* Reads the number at byte `at`, after blanks and one comma, unless it is the first. Returns its fault. If the line has
 * no more words, that is none, and begin and end are the line's end. */
static struct stream_fault read_number(const struct stream_line *line, size_t at, struct stream_number *out)
{
  const bool first = at == 0;
  bool comma = false;
  for (; at < line->length && (is_blank(line->text[at]) || (line->text[at] == ',' && !first && !comma)); at++)
    comma |= line->text[at] == ',';
  size_t end = at, used;
  while (end < line->length && !is_blank(line->text[end]) && line->text[end] != ',') end++;
  out->begin = at;
  out->end = end;
  if (at == line->length && !comma) return (struct stream_fault){0};
  const enum number_kind kind = number_read(line->text + at, end - at, &out->value, &used);
  const char *text = NULL;
  if (end == at) text = "a number is missing here: a comma stands between two numbers";
  else if (kind == NUMBER_NONE || (kind == NUMBER_FINITE && at + used != end))
    text = "this is not a number: a line has real numbers such as -2.5e3, with blanks or commas between them";
  else if (kind == NUMBER_OVERFLOW) text = "the number is too large";
  return (struct stream_fault){text, at, end};
}

struct stream_fault stream_numbers(const struct stream_line *line, size_t least, size_t most, const char *few,
                                   const char *many, struct stream_number out[], size_t *out_count)
{
  struct stream_number number = {0};
  *out_count = 0;
  for (;;) {
    const struct stream_fault fault = read_number(line, number.end, &number);
    if (fault.text == NULL && number.begin == number.end) break;
    if (*out_count == most) return (struct stream_fault){many, number.begin, number.end};
    if (fault.text != NULL) return fault;
    out[(*out_count)++] = number;
  }
  return (struct stream_fault){*out_count < least ? few : NULL, number.begin, number.end};
}

/* Prints the fault of the line at the beginning of the unread bytes. */
static enum status explain(const struct command *command, const struct stream *stream, const struct stream_line *line,
                           size_t record, struct stream_fault fault)
{
  struct diagnostics diagnostics = stderr_diagnostics(command);
  if (record != 0) {
    diagnostics_error(&diagnostics, (struct place){NULL, 0, 0}, "%s, record %zu: %s", stream->name, line->number,
                      fault.text);
    return STATUS_INPUT;
  }
  struct source *source = source_from_text(stream->name, line->text, line->length > MAX_LINE ? 1 : line->bytes);
  if (source == NULL) return STATUS_LIMIT;
  source->lines_before = stream->count;
  const struct place place = {source, fault.begin, fault.end};
  diagnostics_error(&diagnostics, place, "%s", fault.text);
  source_destroy(source);
  return STATUS_INPUT;
}

static enum status write_answers(const struct command *command, const struct stream_reader *reader)
{
  const enum status status = reader->answer == NULL ? STATUS_OK : reader->answer(reader->context);
  const enum status written = command_finish_output(command);
  return status == STATUS_OK ? written : status;
}

/* Passes over a byte order mark. */
static enum status skip_mark(const struct command *command, struct stream *stream)
{
  static const char mark[] = {'\xef', '\xbb', '\xbf'};
  enum status status = STATUS_OK;
  while (status == STATUS_OK && !stream->ended && stream->end < sizeof mark &&
         memcmp(stream->buffer, mark, stream->end) == 0)
    status = refill(command, stream);
  if (stream->end >= sizeof mark && memcmp(stream->buffer, mark, sizeof mark) == 0) stream->begin = sizeof mark;
  return status;
}

/* Reads lines or records until the end or a fault. */
static enum status read_lines(const struct command *command, const struct stream_reader *reader, struct stream *stream)
{
  struct stream_line line = {0};
  struct stream_fault fault = {0};
  enum status status = reader->record == 0 ? skip_mark(command, stream) : STATUS_OK;
  while (status == STATUS_OK && !(stream->ended && stream->begin == stream->end) && !ferror(stdout)) {
    if (!find_line(stream, reader->record, &line)) {
      status = write_answers(command, reader); /* the sender may wait for these answers before it asks again */
      if (status == STATUS_OK) status = refill(command, stream);
      continue;
    }
    if (line.length > MAX_LINE) fault = (struct stream_fault){"the line is too long", 0, 1};
    else if (reader->record != 0 || has_words(&line)) fault = reader->take(reader->context, &line);
    if (fault.text != NULL) break;
    stream->begin += line.bytes;
    stream->count++;
  }
  if (status == STATUS_OK) status = write_answers(command, reader);
  return status == STATUS_OK && fault.text != NULL ? explain(command, stream, &line, reader->record, fault) : status;
}

enum status stream_read(const struct command *command, const struct stream_reader *reader)
{
  struct stream stream = {.name = stream_name(reader->path), .file = STDIN_FILENO, .size = BUFFER_SIZE};
  const bool opened = reader->path != NULL && !output_is_standard(reader->path);
  const char *reason;
  if (opened) stream.file = input_open(reader->path, INPUT_FILE_OR_PIPE, &reason);
  if (stream.file < 0) {
    command_error(command, "%s: %s", reader->path, reason);
    return STATUS_FILE;
  }
  stream.buffer = malloc(BUFFER_SIZE);
  const enum status status = stream.buffer == NULL ? STATUS_LIMIT : read_lines(command, reader, &stream);
  if (status == STATUS_LIMIT) (void)command_out_of_memory(command);
  free(stream.buffer);
  if (opened) (void)close(stream.file);
  return status;
}
