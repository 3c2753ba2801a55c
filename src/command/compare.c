/* pscn compare A B: the difference of two pictures. */
#include "image/compare.h"

#include <math.h>
#include <string.h>

#include "command/command.h"
#include "command/output.h"
#include "image/image_file.h"

/* Smaller differences do not count unless options say otherwise; idiff's default is the same. */
#define DEFAULT_LIMIT 1e-6

struct request {
  const char *first, *second, *output, *channels;
  double scale;
  struct compare_limit fail, warn;
  bool quiet;
};

static const struct command_option OPTIONS[] = {
  COMMAND_HELP_OPTION,
  COMMAND_TEXT("output", 'o', output, "picture of the absolute differences, .png or .exr", "DIFF"),
  COMMAND_POSITIVE("scale", scale, "factor above 0", "factor of the differences in that picture; default 1", "S"),
  COMMAND_TEXT("channels", 0, channels, "only these channels, separated by commas: R,G,B,depth", "LIST"),
  COMMAND_NUMBER("fail", fail.each, "a pixel fails beyond this difference; default 1e-6", "E"),
  COMMAND_NUMBER("failpercent", fail.percent, "percent of the pixels that may fail; default 0", "P"),
  COMMAND_NUMBER("allowfailures", fail.allowed_pixels, "or number of pixels that may fail; default 0", "N"),
  COMMAND_NUMBER("hardfail", fail.any, "difference that no pixel may exceed; default none", "E"),
  COMMAND_NUMBER("warn", warn.each, "as --fail, but only a warning; default none", "E"),
  COMMAND_NUMBER("warnpercent", warn.percent, "percent of the pixels beyond --warn without a warning; default 0", "P"),
  COMMAND_NUMBER("hardwarn", warn.any, "a warning if any pixel exceeds this; default none", "E"),
  COMMAND_TRUE("quiet", 'q', quiet, "print nothing unless the comparison fails"),
  COMMAND_OPTIONS_END,
};

/* What is compared: two pictures and the channels they share. */
struct subject {
  struct image image[2];
  size_t channel[2][IMAGE_MAX_CHANNELS]; /* the indices in each picture */
  size_t channel_count;
};

/* Adds the channel of that name. */
static enum status add_channel(const struct command *command, const struct request *request, struct subject *subject,
                               const char *name)
{
  const char *const path[2] = {request->first, request->second};
  if (subject->channel_count == IMAGE_MAX_CHANNELS)
    return command_usage(command, "more than %d channels", IMAGE_MAX_CHANNELS);
  for (int k = 0; k < 2; k++) {
    const size_t index = image_find_channel(&subject->image[k], name);
    if (index == subject->image[k].channel_count) {
      command_error(command, "'%s' has no channel '%s'", path[k], name);
      return STATUS_DIFFERENT;
    }
    subject->channel[k][subject->channel_count] = index;
  }
  subject->channel_count++;
  return STATUS_OK;
}

static enum status add_listed(const struct command *command, const struct request *request, struct subject *subject)
{
  enum status status = STATUS_OK;
  for (const char *from = request->channels; status == STATUS_OK; from++) {
    char name[IMAGE_NAME_SIZE + 1]; /* one more byte than any name, so that a longer one is not cut to match it */
    const size_t length = strcspn(from, ",");
    snprintf(name, sizeof name, "%.*s", (int)(length < sizeof name ? length : sizeof name - 1), from);
    status = add_channel(command, request, subject, name);
    from += length;
    if (*from == '\0') break;
  }
  return status;
}

/* Pairs the channels: those listed, or else all, which both pictures must then have. */
static enum status pair_channels(const struct command *command, const struct request *request, struct subject *subject)
{
  if (request->channels != NULL) return add_listed(command, request, subject);
  const struct image *first = &subject->image[0], *second = &subject->image[1];
  enum status status = STATUS_OK;
  for (size_t k = 0; k < first->channel_count && status == STATUS_OK; k++)
    status = add_channel(command, request, subject, first->channel[k].name);
  for (size_t k = 0; k < second->channel_count && status == STATUS_OK; k++) {
    if (image_find_channel(first, second->channel[k].name) == first->channel_count) {
      command_error(command, "'%s' has no channel '%s'", request->first, second->channel[k].name);
      status = STATUS_DIFFERENT;
    }
  }
  return status;
}

static enum status read_subject(const struct command *command, const struct request *request, struct subject *out)
{
  const char *const path[2] = {request->first, request->second};
  for (int k = 0; k < 2; k++) {
    char message[IMAGE_MESSAGE_SIZE];
    const enum status status = image_read(path[k], &out->image[k], message);
    if (status != STATUS_OK) {
      command_error(command, "cannot read '%s': %s", path[k], message);
      return status;
    }
  }
  const struct image *a = &out->image[0], *b = &out->image[1];
  if (a->width != b->width || a->height != b->height) {
    command_error(command, "'%s' has %zux%zu pixels, '%s' has %zux%zu", path[0], a->width, a->height, path[1], b->width,
                  b->height);
    return STATUS_DIFFERENT;
  }
  return pair_channels(command, request, out);
}

static enum status write_difference(const struct command *command, const struct request *request,
                                    enum image_format format, const struct image *difference)
{
  const struct image_encoding encoding = {.format = format, .bits = format == IMAGE_PNG ? 8 : 32, .encoded = true};
  return output_picture(command, difference, &encoding, request->output);
}

/* Prints the table to stdout. */
static void print_result(const struct compare_pair *pair, const struct compare_result *result)
{
  static const int CODES[] = {1, 4, 16};
  const struct image *first = pair->first;
  printf("compared  %zu x %zu pixels, channels", first->width, first->height);
  for (size_t k = 0; k < pair->channel_count; k++) {
    putchar(' ');
    command_print(stdout, first->channel[pair->first_channel[k]].name);
  }
  printf("\nmean      %.9g\nrms       %.9g\npsnr      %.6g dB\nmax       %.9g", result->mean, result->rms, result->psnr,
         result->max);
  if (result->max > 0) {
    printf(" at pixel %zu,%zu channel ", result->worst_x, result->worst_y);
    command_print(stdout, first->channel[pair->first_channel[result->worst_channel]].name);
    printf(": %.9g and %.9g", (double)result->worst_first, (double)result->worst_second);
  }
  fputc('\n', stdout);
  for (size_t k = 0; k < sizeof CODES / sizeof CODES[0]; k++) {
    char label[16];
    snprintf(label, sizeof label, "%d/255", CODES[k]);
    const size_t over = compare_count_over(pair, CODES[k] / 255.0 + DEFAULT_LIMIT);
    printf("over %-9s %zu pixels, %.4g %%\n", label, over, 100 * (double)over / (double)result->pixels);
  }
}

/* Checks the limits, and prints the result. */
static enum status judge(const struct command *command, const struct request *request, const struct compare_pair *pair,
                         const struct compare_result *result)
{
  const size_t failing = compare_count_over(pair, request->fail.each);
  const size_t warning = compare_count_over(pair, request->warn.each);
  if (!request->quiet)
    printf("over %-9.9g %zu pixels, %.4g %%\n", request->fail.each, failing,
           100 * (double)failing / (double)result->pixels);
  if (compare_limit_passed(&request->fail, result, failing)) {
    const enum status status = command_finish_output(command);
    if (status != STATUS_OK) return status;
    command_error(command, "'%s' and '%s' differ: %zu pixels by more than %.9g, the most by %.9g", request->first,
                  request->second, failing, request->fail.each, result->max);
    return STATUS_DIFFERENT;
  }
  if (compare_limit_passed(&request->warn, result, warning) && !request->quiet)
    command_warning(command, "%zu pixels differ by more than %.9g, the most by %.9g", warning, request->warn.each,
                    result->max);
  return STATUS_OK;
}

static enum status compare(const struct command *command, const struct request *request)
{
  enum image_format format = IMAGE_PNG;
  if (request->output != NULL && output_format(command, request->output, &format) != STATUS_OK) return STATUS_USAGE;
  enum status status = output_spare_input(command, request->output, request->first);
  if (status == STATUS_OK) status = output_spare_input(command, request->output, request->second);
  if (status == STATUS_OK) status = output_probe(command, request->output);
  if (status != STATUS_OK) return status;
  struct subject subject = {0};
  struct image difference = {0};
  status = read_subject(command, request, &subject);
  if (status != STATUS_OK) goto done;
  const struct compare_pair pair = {.first = &subject.image[0],
                                    .second = &subject.image[1],
                                    .channel_count = subject.channel_count,
                                    .first_channel = subject.channel[0],
                                    .second_channel = subject.channel[1]};
  if (request->output != NULL) {
    if (format == IMAGE_PNG && pair.channel_count > 4) {
      status = command_usage(command, "a PNG holds at most 4 channels; choose some, or an .exr");
      goto done;
    }
    status = image_create(pair.first->width, pair.first->height, pair.channel_count, &difference);
    if (status != STATUS_OK) {
      status = command_out_of_memory(command);
      goto done;
    }
    for (size_t k = 0; k < pair.channel_count; k++) difference.channel[k] = pair.first->channel[pair.first_channel[k]];
  }
  struct compare_result result;
  compare_images(&pair, &result, request->output == NULL ? NULL : &difference, request->scale);
  if (request->output != NULL) status = write_difference(command, request, format, &difference);
  if (status != STATUS_OK) goto done;
  if (!request->quiet) print_result(&pair, &result);
  status = judge(command, request, &pair, &result);
  if (status == STATUS_OK) status = command_finish_output(command);

done:
  image_destroy(&difference);
  for (int k = 0; k < 2; k++) image_destroy(&subject.image[k]);
  return status;
}

static const struct request DEFAULTS = {
  .scale = 1, .fail = {.each = DEFAULT_LIMIT, .any = INFINITY}, .warn = {.each = INFINITY, .any = INFINITY}};

static enum status run(const struct command *command, void *context, const struct command_line *line)
{
  struct request *request = context;
  request->first = line->positional[0];
  request->second = line->positional[1];
  return compare(command, request);
}

const struct command command_compare = {
  .name = "compare",
  .arguments = "A B",
  .summary = "Compares two pictures",
  .description =
    "Standard output has mean, root mean square and largest difference of the values as they are stored (0 to 1 in\n"
    "integer files), the signal to noise ratio, and how many pixels are over 1/255, 4/255, 16/255 and the limit.\n"
    "The numbers are defined as those of OpenImageIO's idiff. Channels are paired by name. Limits may be quotients:\n"
    "4/255. The exit code is 1 if the pictures differ by more than the limits, or in size or channels.\n",
  COMMAND_RUNS(2, NULL),
};
