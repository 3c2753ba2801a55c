/* pscn trace SCENE: rays on stdin, hits on stdout. */
#include <math.h>
#include <stdint.h>
#include <string.h>
#include <unistd.h>

#include "base/number.h"
#include "command/command.h"
#include "command/ray_input.h"
#include "command/report.h"
#include "command/scene_file.h"
#include "geometry/vector.h"
#include "intersect/intersect.h"

enum { OPTION_BINARY = 1, OPTION_STATS, OPTION_QUIET };

enum {
  ANSWER_VALUES = 7, /* T U V PATCH NX NY NZ */
  ANSWER_SIZE = ANSWER_VALUES * NUMBER_TEXT_SIZE + 16, /* bytes of an answer as text, at most */
  OUTPUT_BUFFER = 1 << 16
};

static const struct poptOption OPTIONS[] = {
  COMMAND_HELP_OPTION,
  SCENE_OPTIONS,
  COMMAND_FLAG("binary", 0, OPTION_BINARY, "little-endian doubles instead of text"),
  COMMAND_OPTION("stats", 0, OPTION_STATS, "statistics as JSON; - is standard output, after the hits", "FILE"),
  COMMAND_FLAG("quiet", 'q', OPTION_QUIET, "no summary on a terminal"),
  POPT_TABLEEND
};

struct request {
  struct scene_request scene;
  const char *stats;
  bool binary, quiet;
};

static enum status take_option(const struct command *command, void *context, int val, const char *argument)
{
  struct request *request = context;
  switch (val) {
  SCENE_OPTION_CASES:
    return scene_request_take(command, &request->scene, val, argument);
  case OPTION_BINARY:
    request->binary = true;
    break;
  case OPTION_STATS:
    request->stats = argument;
    break;
  default:
    request->quiet = true;
    break;
  }
  return STATUS_OK;
}

/* The numbers of an answer; a miss has T infinite and PATCH -1. */
static void answer_values(const struct ray *ray, const struct hit *hit, double out[ANSWER_VALUES])
{
  const bool missed = hit->patch == HIT_NONE;
  memset(out, 0, ANSWER_VALUES * sizeof *out);
  out[0] = missed ? INFINITY : hit->t * vector_length(ray->direction);
  out[3] = missed ? -1 : (double)hit->patch;
  if (!missed) {
    out[1] = hit->u;
    out[2] = hit->v;
    for (int k = 0; k < 3; k++)
      out[4 + k] = hit->normal[k] + 0.0; /* -0 becomes 0 */
  }
}

static void write_text(const struct ray *ray, const struct hit *hit)
{
  double value[ANSWER_VALUES];
  char line[ANSWER_SIZE] = "miss";
  size_t length = 4;
  if (hit->patch != HIT_NONE) {
    answer_values(ray, hit, value);
    memcpy(line, "hit", 3);
    length = 3;
    for (int k = 0; k < ANSWER_VALUES; k++) {
      line[length++] = ' ';
      length += number_write_17(value[k], line + length);
    }
  }
  line[length++] = '\n';
  fwrite(line, 1, length, stdout);
}

static void write_binary(const struct ray *ray, const struct hit *hit)
{
  double value[ANSWER_VALUES];
  unsigned char bytes[8 * ANSWER_VALUES];
  answer_values(ray, hit, value);
  for (int k = 0; k < ANSWER_VALUES; k++) {
    uint64_t bits;
    memcpy(&bits, &value[k], sizeof bits);
    for (int b = 0; b < 8; b++)
      bytes[8 * k + b] = (unsigned char)(bits >> (8 * b) & 0xff);
  }
  fwrite(bytes, 1, sizeof bytes, stdout);
}

static void answer(struct tracer *tracer, bool binary, size_t count, const struct ray rays[])
{
  struct hit hits[PACKET_SIZE];
  if (count == 0)
    return;
  tracer_closest(tracer, count, rays, hits);
  for (size_t k = 0; k < count; k++)
    (binary ? write_binary : write_text)(&rays[k], &hits[k]);
}

/* Answers until the stream ends, or a bad line comes, or something fails. */
static enum status trace_stream(const struct command *command, struct tracer *tracer, struct ray_input *input)
{
  struct ray rays[PACKET_SIZE];
  size_t count = 0;
  enum ray_input_result result;
  do {
    result = ray_input_next(input, &rays[count]);
    if (result == RAY_INPUT_RAY && ++count < PACKET_SIZE)
      continue;
    answer(tracer, input->binary, count, rays);
    count = 0;
    const bool more = result == RAY_INPUT_RAY;
    const enum status status = more && !ferror(stdout) ? STATUS_OK : command_finish_output(command);
    if (status != STATUS_OK)
      return status;
  } while (result == RAY_INPUT_RAY || result == RAY_INPUT_PENDING);

  enum status status = STATUS_OK;
  if (result == RAY_INPUT_FAILED) {
    command_error(command, "cannot read standard input: %s", strerror(input->stream.reason));
    status = STATUS_FILE;
  } else if (result == RAY_INPUT_BAD) {
    struct diagnostics diagnostics = stderr_diagnostics();
    status = ray_input_explain(input, &diagnostics);
  } else if (result == RAY_INPUT_LIMIT) {
    status = STATUS_LIMIT;
  }
  return status;
}

static enum status trace(const struct command *command, struct request *request)
{
  struct scene *scene = NULL;
  struct intersector *intersector = NULL;
  struct tracer *tracer = NULL;
  struct ray_input input = { .binary = request->binary };
  struct seconds start = seconds_now();
  enum status status = report_probe(command, request->stats);
  if (status != STATUS_OK)
    return status;
  status = scene_file_load(&request->scene, &scene);
  struct report report = { .scene_path = request->scene.path, .scene = scene, .threads = 1 };
  report.parse = seconds_since(start);
  if (status != STATUS_OK)
    return status;

  start = seconds_now();
  status = intersector_create(scene, &intersector);
  if (status == STATUS_OK)
    status = tracer_create(intersector, &tracer);
  if (status == STATUS_OK)
    status = ray_input_open(STDIN_FILENO, request->binary, &input);
  report.build = seconds_since(start);
  if (status == STATUS_OK) {
    start = seconds_now();
    status = trace_stream(command, tracer, &input);
    report.render = seconds_since(start);
    report.counts = *tracer_counts(tracer);
  }
  if (status == STATUS_LIMIT)
    command_error(command, "out of memory");
  if (status == STATUS_OK)
    status = report_write(command, &report, request->stats);
  if (status == STATUS_OK && !request->quiet && isatty(STDERR_FILENO) == 1)
    report_print(&report);
  ray_input_free(&input);
  if (tracer != NULL)
    tracer_destroy(tracer);
  if (intersector != NULL)
    intersector_destroy(intersector);
  scene_destroy(scene);
  return status;
}

static int run(const struct command *command, int argc, const char **argv)
{
  struct request request = { .scene = { .width = DEFAULT_WIDTH, .height = DEFAULT_HEIGHT, .tolerance = NAN } };
  struct command_line line;
  enum status status = command_line_read(command, argc, argv, 1, take_option, &request, &line);
  if (status == STATUS_OK && !line.help) {
    static char buffer[OUTPUT_BUFFER];
    (void)setvbuf(stdout, buffer, _IOFBF, sizeof buffer);
    request.scene.path = line.positional[0];
    status = trace(command, &request);
  }
  command_line_free(&line);
  return (int)status;
}

const struct command command_trace = {
  .name = "trace",
  .arguments = "SCENE",
  .summary = "Reads rays and answers where each hits the scene",
  .description =
    "Standard input has one ray a line, 'ox oy oz dx dy dz'; the direction may have any length. Standard output has\n"
    "one answer a line, in order: 'hit T U V PATCH NX NY NZ' or 'miss'. T is the distance from the origin in scene\n"
    "units, U and V are the parameters of the whole patch, PATCH is its number from 0, N the unit normal facing the\n"
    "origin. A bad line ends the run with its number, after the answers to the lines before it.\n"
    "\n"
    "--binary: a ray is six little-endian doubles, an answer seven, T U V PATCH NX NY NZ; a miss has T infinite,\n"
    "PATCH -1 and zeros.\n",
  .options = OPTIONS,
  .run = run,
};
