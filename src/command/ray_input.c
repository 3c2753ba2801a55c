/* Rays from a stream. */
#include "command/ray_input.h"

#include <math.h>
#include <stdint.h>
#include <string.h>

enum {
  VALUES = 6,         /* of a ray */
  RECORD = VALUES * 8 /* bytes of a binary ray */
};

enum status ray_input_open(int descriptor, bool binary, struct ray_input *out)
{
  out->binary = binary;
  return stream_open(descriptor, &out->stream);
}

void ray_input_free(struct ray_input *input)
{
  stream_free(&input->stream);
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
static struct stream_fault parse_line(const struct stream_line *line, struct ray *out)
{
  double value[VALUES + 1];
  size_t at = 0, end = 0, direction = 0;
  struct stream_fault fault;
  if (line->length > STREAM_MAX_LINE)
    return (struct stream_fault){ "the line is too long", 0, 1 };
  for (int k = 0; k < VALUES; k++) {
    const int found = stream_number(line, &at, &value[k], &end, &fault);
    if (found < 0)
      return fault;
    if (found == 0)
      return (struct stream_fault){ "a ray is six numbers: ox oy oz dx dy dz", fault.begin, fault.end };
    direction = k == 3 ? at : direction;
    at = end;
  }
  const size_t last = end;
  if (stream_number(line, &at, &value[VALUES], &end, &fault) != 0)
    return (struct stream_fault){ "a ray is six numbers, and here is more", fault.begin, fault.end };
  if (!make_ray(value, out))
    return (struct stream_fault){ "the direction is zero", direction, last };
  return (struct stream_fault){ 0 };
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

static enum ray_input_result refill(struct stream *stream)
{
  switch (stream_refill(stream)) {
  case STREAM_MORE:
    return RAY_INPUT_PENDING;
  case STREAM_FAILED:
    return RAY_INPUT_FAILED;
  default:
    return RAY_INPUT_LIMIT;
  }
}

enum ray_input_result ray_input_next(struct ray_input *input, struct ray *out)
{
  struct stream *stream = &input->stream;
  const size_t left = stream->end - stream->begin;
  size_t bytes = RECORD;
  if (stream_at_end(stream))
    return RAY_INPUT_END;
  if (input->binary) {
    if (left < RECORD && !stream->ended)
      return refill(stream);
    if (parse_record(stream->buffer + stream->begin, left, out) != NULL)
      return RAY_INPUT_BAD;
  } else {
    struct stream_line line;
    if (!stream_line(stream, &line))
      return refill(stream);
    if (parse_line(&line, out).text != NULL)
      return RAY_INPUT_BAD;
    bytes = line.bytes;
  }
  stream_take(stream, bytes);
  return RAY_INPUT_RAY;
}

enum status ray_input_explain(const struct ray_input *input, struct diagnostics *diagnostics)
{
  const struct stream *stream = &input->stream;
  struct ray ray;
  if (input->binary) {
    const struct place nowhere = { 0 };
    diagnostics_error(diagnostics, nowhere, "%s, record %zu: %s", STREAM_NAME, stream->count + 1,
                      parse_record(stream->buffer + stream->begin, stream->end - stream->begin, &ray));
    return STATUS_INPUT;
  }
  struct stream_line line = { 0 };
  (void)stream_line(stream, &line);
  return stream_explain(stream, &line, parse_line(&line, &ray), diagnostics);
}
