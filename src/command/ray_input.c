/* Rays from a stream. */
#include "command/ray_input.h"

#include <errno.h>
#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/number.h"

enum {
  BUFFER_SIZE = 1 << 16,
  MAX_LINE = 1 << 20, /* bytes; six numbers do not need more */
  VALUES = 6,         /* of a ray */
  RECORD = VALUES * 8 /* bytes of a binary ray */
};

static const char STREAM_NAME[] = "<stdin>";

/* What is wrong with a line, and where in it. */
struct fault {
  const char *text;
  size_t begin, end;
};

enum status ray_input_open(int descriptor, bool binary, struct ray_input *out)
{
  *out = (struct ray_input){ .descriptor = descriptor, .binary = binary, .size = BUFFER_SIZE };
  out->buffer = malloc(out->size);
  return out->buffer == NULL ? STATUS_LIMIT : STATUS_OK;
}

void ray_input_free(struct ray_input *input)
{
  free(input->buffer);
  *input = (struct ray_input){ 0 };
}

/* Reads more bytes behind those that are left. RAY_INPUT_PENDING: there are some, or the end was reached. */
static enum ray_input_result refill(struct ray_input *input)
{
  memmove(input->buffer, input->buffer + input->begin, input->end - input->begin);
  input->end -= input->begin;
  input->begin = 0;
  if (input->end == input->size) {
    char *larger = realloc(input->buffer, 2 * input->size);
    if (larger == NULL)
      return RAY_INPUT_LIMIT;
    input->buffer = larger;
    input->size *= 2;
  }
  ssize_t length;
  do
    length = read(input->descriptor, input->buffer + input->end, input->size - input->end);
  while (length < 0 && errno == EINTR);
  if (length < 0) {
    input->reason = errno;
    return RAY_INPUT_FAILED;
  }
  input->ended = length == 0;
  input->end += (size_t)length;
  return RAY_INPUT_PENDING;
}

static bool is_blank(char c)
{
  return c == ' ' || c == '\t';
}

/* The end of the word that begins at `begin`. */
static size_t word_end(const char *line, size_t length, size_t begin)
{
  size_t end = begin;
  while (end < length && !is_blank(line[end]))
    end++;
  return end > begin ? end : begin + 1;
}

/* Makes a ray of six finite numbers; false where the direction is zero. */
static bool make_ray(const double value[VALUES], struct ray *out)
{
  const double largest = fmax(fmax(fabs(value[3]), fabs(value[4])), fabs(value[5]));
  int exponent;
  if (largest == 0)
    return false;
  (void)frexp(largest, &exponent);
  for (int k = 0; k < 3; k++) {
    out->origin[k] = value[k];
    out->direction[k] = ldexp(value[k + 3], -exponent);
  }
  out->t_min = 0;
  out->t_max = INFINITY;
  return true;
}

/* Reads "ox oy oz dx dy dz"; the fault's text is NULL where all is well. */
static struct fault parse_line(const char *line, size_t length, struct ray *out)
{
  double value[VALUES];
  size_t at = 0, direction = 0, last = 0;
  if (length > MAX_LINE)
    return (struct fault){ "the line is too long", 0, 1 };
  for (int k = 0; k < VALUES; k++) {
    while (at < length && is_blank(line[at]))
      at++;
    size_t used;
    const enum number_kind kind = number_read(line + at, length - at, &value[k], &used);
    const size_t end = at < length ? word_end(line, length, at) : at + 1;
    if (at == length)
      return (struct fault){ "a ray is six numbers: ox oy oz dx dy dz", at, end };
    if (kind == NUMBER_NONE || (kind == NUMBER_FINITE && at + used != end))
      return (struct fault){ "this is no number", at, end };
    if (kind == NUMBER_OVERFLOW)
      return (struct fault){ "the number is too large", at, end };
    direction = k == 3 ? at : direction;
    at = last = end;
  }
  while (at < length && is_blank(line[at]))
    at++;
  if (at < length)
    return (struct fault){ "a ray is six numbers, and here is more", at, word_end(line, length, at) };
  if (!make_ray(value, out))
    return (struct fault){ "the direction is zero", direction, last };
  return (struct fault){ 0 };
}

/* The line at the beginning of the buffer, without its end, LF or CRLF. False where its end is still to come. */
static bool find_line(const struct ray_input *input, size_t *out_length, size_t *out_bytes)
{
  const char *line = input->buffer + input->begin;
  const size_t left = input->end - input->begin;
  const char *newline = memchr(line, '\n', left);
  if (newline == NULL && !input->ended && left <= MAX_LINE)
    return false;
  const size_t length = newline == NULL ? left : (size_t)(newline - line);
  *out_bytes = newline == NULL ? left : length + 1;
  *out_length = length > 0 && line[length - 1] == '\r' ? length - 1 : length;
  return true;
}

static double little_endian_double(const char *bytes)
{
  uint64_t bits = 0;
  for (int k = 7; k >= 0; k--)
    bits = bits << 8 | (unsigned char)bytes[k];
  double value;
  memcpy(&value, &bits, sizeof value);
  return value;
}

/* NULL, or what is wrong. */
static const char *parse_record(const char *record, size_t length, struct ray *out)
{
  double value[VALUES];
  if (length < RECORD)
    return "the stream ends inside a record of 48 bytes";
  for (int k = 0; k < VALUES; k++) {
    value[k] = little_endian_double(record + 8 * k);
    if (!isfinite(value[k]))
      return "a number is not finite";
  }
  return make_ray(value, out) ? NULL : "the direction is zero";
}

enum ray_input_result ray_input_next(struct ray_input *input, struct ray *out)
{
  size_t length, bytes;
  const size_t left = input->end - input->begin;
  if (left == 0 && input->ended)
    return RAY_INPUT_END;
  if (input->binary) {
    if (left < RECORD && !input->ended)
      return refill(input);
    if (parse_record(input->buffer + input->begin, left, out) != NULL)
      return RAY_INPUT_BAD;
    bytes = RECORD;
  } else {
    if (!find_line(input, &length, &bytes))
      return refill(input);
    if (parse_line(input->buffer + input->begin, length, out).text != NULL)
      return RAY_INPUT_BAD;
  }
  input->begin += bytes;
  input->count++;
  return RAY_INPUT_RAY;
}

/* The line alone, standing where it stood in the stream: after as many line ends. NULL where memory is short. */
static struct source *line_source(const struct ray_input *input, const char *line, size_t length)
{
  char *text = length > SIZE_MAX - input->count ? NULL : malloc(input->count + length + 1);
  if (text == NULL)
    return NULL;
  memset(text, '\n', input->count);
  memcpy(text + input->count, line, length);
  struct source *source = source_from_text(STREAM_NAME, text, input->count + length);
  free(text);
  return source;
}

enum status ray_input_explain(const struct ray_input *input, struct diagnostics *diagnostics)
{
  const char *line = input->buffer + input->begin;
  struct ray ray;
  if (input->binary) {
    const struct place nowhere = { 0 };
    diagnostics_error(diagnostics, nowhere, "%s, record %zu: %s", STREAM_NAME, input->count + 1,
                      parse_record(line, input->end - input->begin, &ray));
    return STATUS_INPUT;
  }
  size_t length = 0, bytes;
  (void)find_line(input, &length, &bytes);
  const struct fault fault = parse_line(line, length, &ray);
  struct source *source = line_source(input, line, length > MAX_LINE ? 1 : length);
  if (source == NULL)
    return STATUS_LIMIT;
  const struct place place = { source, input->count + fault.begin, input->count + fault.end };
  diagnostics_error(diagnostics, place, "%s", fault.text);
  source_destroy(source);
  return STATUS_INPUT;
}
