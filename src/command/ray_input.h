/* Rays from a stream: text, one a line, "ox oy oz dx dy dz", or binary, six little-endian doubles each. */
#ifndef PSCN_COMMAND_RAY_INPUT_H
#define PSCN_COMMAND_RAY_INPUT_H

#include <stdbool.h>

#include "base/diagnostics.h"
#include "base/status.h"
#include "command/stream.h"
#include "intersect/intersect.h"

struct ray_input {
  struct stream stream; /* its count is of lines or records; its reason is that of RAY_INPUT_FAILED */
  bool binary;
};

/* STATUS_LIMIT where memory is short. The caller ends with ray_input_free in any case. */
enum status ray_input_open(int descriptor, bool binary, struct ray_input *out) STATUS_MUST_CHECK;
void ray_input_free(struct ray_input *input);

enum ray_input_result {
  RAY_INPUT_RAY,     /* *out is the next ray */
  RAY_INPUT_PENDING, /* the next call will wait for the stream: the moment to answer what has come so far */
  RAY_INPUT_END,
  RAY_INPUT_BAD,     /* the line or record is wrong: ray_input_explain says how */
  RAY_INPUT_FAILED,  /* the stream can not be read: its `reason` says why */
  RAY_INPUT_LIMIT    /* memory */
};

/* The next ray. Its direction has a power of two taken out, so that its length neither overflows nor underflows. */
enum ray_input_result ray_input_next(struct ray_input *input, struct ray *out);

/* Tells what is wrong with the line or record that was RAY_INPUT_BAD. STATUS_INPUT, or STATUS_LIMIT where memory is
 * short. */
enum status ray_input_explain(const struct ray_input *input, struct diagnostics *diagnostics) STATUS_MUST_CHECK;

#endif
