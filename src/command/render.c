/* pscn render SCENE: a picture. */
#include "render/render.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "command/command.h"
#include "command/interrupt.h"
#include "command/output.h"
#include "command/progress.h"
#include "command/report.h"
#include "command/scene_file.h"
#include "command/values.h"
#include "image/image_loading.h"
#include "language/words.h"

enum { OPTION_CROP = 1, OPTION_CHANNELS, OPTION_BITS };

enum {
  MAX_SAMPLES = 256, /* a side: 65536 rays a pixel */
  MAX_THREADS = 1024,
  MAX_PIXELS = 1 << 28 /* of the part that is kept, 3 GiB of colours; larger ones are typing errors */
};

/* What the command line asks for. */
struct request {
  struct scene_request scene;
  struct render_options options; /* crop.width 0: not given */
  enum image_format format;
  size_t bits; /* 0: not given */
  const char *output, *stats;
  char *default_output; /* owned */
};

static const struct command_option OPTIONS[] = {
  COMMAND_HELP_OPTION,
  COMMAND_TEXT("output", 'o', output, "the picture, .png or .exr; default: SCENE with .png", "FILE"),
  SCENE_SIZE_OPTION("of the picture in pixels; default 800x600"),
  SCENE_OPTIONS,
  COMMAND_INTEGER("samples", options.samples, 1, MAX_SAMPLES, "number of samples",
                  "N x N rays a pixel on a regular grid; default 1", "N"),
  COMMAND_OPTION("crop", 0, OPTION_CROP, "only this part, in pixels from the left and top", "X,Y,W,H"),
  COMMAND_INTEGER("threads", options.threads, 1, MAX_THREADS, "number of threads", "default: one for each processor",
                  "N"),
  COMMAND_OPTION("channels", 0, OPTION_CHANNELS, "what is kept of each pixel, with commas; default rgb", "LIST"),
  COMMAND_OPTION("bits", 0, OPTION_BITS, "of a colour value: 8 or 16 (PNG), 16 or 32 (EXR)", "N"),
  COMMAND_TEXT("stats", 0, stats, "statistics as JSON; - is standard output", "FILE"),
  COMMAND_TRUE("quiet", 'q', scene.quiet, "say nothing unless something is wrong"),
  COMMAND_OPTIONS_END,
};

static enum status take_channels(const struct command *command, struct request *request, const char *text)
{
  const char *bad;
  size_t length;
  if (channel_list_parse(text, &request->options.channels, &bad, &length)) return STATUS_OK;
  const char *names[CHANNEL_KINDS];
  char known[256];
  for (int k = 0; k < CHANNEL_KINDS; k++) {
    names[k] = channel_traits((enum channel_kind)k)->name;
    if (strlen(names[k]) == length && memcmp(names[k], bad, length) == 0)
      return (enum status)command_usage(command, "channel '%s' is named twice", names[k]);
  }
  words_list(names, CHANNEL_KINDS, known, sizeof known);
  return (enum status)command_usage(command, "there is no channel '%.*s', only %s", (int)length, bad, known);
}

static enum status take_option(const struct command *command, void *context, int val, const char *argument)
{
  struct request *request = context;
  switch (val) {
  case OPTION_CROP:
    if (!value_rectangle(argument, &request->options.crop))
      return (enum status)command_usage(command, "'%s' is no crop X,Y,W,H in pixels", argument);
    break;
  case OPTION_CHANNELS: return take_channels(command, request, argument);
  case OPTION_BITS:
    if (!value_integer(argument, 8, 32, &request->bits))
      return (enum status)command_usage(command, "'%s' bits are 8, 16 or 32", argument);
    break;
  default: return scene_request_take(command, &request->scene, val, argument);
  }
  return STATUS_OK;
}

static enum status check_format(const struct command *command, struct request *request)
{
  const struct channel_list *channels = &request->options.channels;
  const bool plain = channels->count == 1 && channels->kind[0] == CHANNEL_RGB;
  if (output_is_standard(request->output)) request->format = plain && request->bits != 32 ? IMAGE_PNG : IMAGE_EXR;
  else if (output_format(command, request->output, &request->format) != STATUS_OK) return STATUS_USAGE;
  if (request->bits == 0) request->bits = (size_t)image_format_default_bits(request->format);
  if (!image_format_has_bits(request->format, (int)request->bits))
    return (enum status)command_usage(command, "'%s' cannot have %zu bits a value: %s", request->output, request->bits,
                                      request->format == IMAGE_PNG ? "a PNG has 8 or 16" : "an EXR has 16 or 32");
  if (request->format == IMAGE_PNG && !plain)
    return (enum status)command_usage(command, "a PNG holds the channel rgb only; other channels need an .exr");
  return STATUS_OK;
}

/* The part of the picture that is kept. */
static enum status check_crop(const struct command *command, struct render_options *options)
{
  struct rectangle *crop = &options->crop;
  if (crop->width == 0) *crop = (struct rectangle){.width = options->width, .height = options->height};
  if (crop->x + crop->width > options->width || crop->y + crop->height > options->height)
    return (enum status)command_usage(command, "the crop %zu,%zu,%zu,%zu is not inside the picture of %zux%zu pixels",
                                      crop->x, crop->y, crop->width, crop->height, options->width, options->height);
  if (crop->height > MAX_PIXELS / crop->width)
    return (enum status)command_usage(command, "%zux%zu pixels are more than the %d that a picture may have",
                                      crop->width, crop->height, MAX_PIXELS);
  return STATUS_OK;
}

/* What is written is no other file of the command; `scene` NULL: as far as known before it is read. */
static enum status check_outputs(const struct command *command, const struct request *request,
                                 const struct scene *scene)
{
  enum status status = output_spare(command, request->stats, request->output);
  if (status == STATUS_OK) status = scene_file_spare(command, &request->scene, scene, request->output);
  return status == STATUS_OK ? scene_file_spare(command, &request->scene, scene, request->stats) : status;
}

/* Whatever can be known to be wrong before the work starts. */
static enum status check(const struct command *command, struct request *request)
{
  if (request->output == NULL) request->output = request->default_output = output_name(request->scene.path, ".png");
  if (request->output == NULL) {
    command_error(command, "out of memory");
    return STATUS_LIMIT;
  }
  if (output_is_standard(request->output) && isatty(STDOUT_FILENO) == 1)
    return (enum status)command_usage(command, "a picture is not written to a terminal; -o FILE says where to");
  enum status status = check_format(command, request);
  if (status == STATUS_OK) status = check_crop(command, &request->options);
  if (status != STATUS_OK) return status;
  status = check_outputs(command, request, NULL);
  if (status == STATUS_OK) status = output_probe(command, request->output);
  if (status == STATUS_OK) status = output_probe(command, request->stats);
  return status;
}

static void name_channels(const struct channel_list *channels, struct image *image)
{
  struct image_channel *channel = image->channel;
  for (size_t k = 0; k < channels->count; k++) {
    const struct channel_traits *traits = channel_traits(channels->kind[k]);
    for (size_t c = 0; c < traits->width; c++, channel++) {
      channel->data = traits->data;
      snprintf(channel->name, IMAGE_NAME_SIZE, "%s", traits->value_names[c]);
    }
  }
}

/* Waits until pictures can be written; tells it where they cannot. */
static enum status loaded(const struct command *command, struct image_loading *loading)
{
  const char *message;
  const enum status status = image_loading_end(loading, &message);
  if (status != STATUS_OK) command_error(command, "cannot write pictures: %s", message);
  return status;
}

/* Renders into a new image, and no further where it could not be written. */
static enum status make_picture(const struct command *command, const struct request *request,
                                struct image_loading *loading, struct report *report, struct image *out)
{
  const struct rectangle *crop = &request->options.crop;
  struct intersector *intersector = NULL;
  struct progress progress = progress_start();
  const struct render_watch watch = {.progress = request->scene.quiet ? NULL : progress_tell,
                                     .context = &progress,
                                     .stop = &interrupt_signal,
                                     .failed = &loading->failed};
  struct render_stats stats = {0};
  enum status status = image_create(crop->width, crop->height, request->options.channels.width, out);
  if (status == STATUS_OK) {
    name_channels(&request->options.channels, out);
    const struct seconds start = seconds_now();
    status = intersector_create(report->scene, &intersector);
    report->build = seconds_since(start);
  }
  if (status == STATUS_OK) {
    interrupt_defer();
    const struct seconds start = seconds_now();
    status = render_scene(report->scene, intersector, &request->options, &watch, out->value, &stats);
    progress_end(&progress);
    interrupt_resume();
    if (atomic_load(&interrupt_signal) != 0) status = STATUS_INTERRUPTED;
    report->counts = stats.counts;
    report->threads = stats.threads;
    report->render = seconds_since(start);
  }
  if (status == STATUS_LIMIT) command_error(command, "out of memory or threads");
  else if (atomic_load(&interrupt_signal) == 0) status = loaded(command, loading);
  intersector_destroy(intersector);
  return status;
}

/* The picture, and the statistics where they are asked for. */
static enum status write_results(const struct command *command, const struct request *request, struct report *report,
                                 const struct image *image)
{
  const struct seconds start = seconds_now();
  struct report_metadata metadata;
  report_metadata_fill(report, &metadata);
  const struct image_encoding encoding = {.format = request->format,
                                          .bits = (int)request->bits,
                                          .attributes = metadata.attribute,
                                          .attribute_count = metadata.count};
  unsigned char *bytes;
  char *statistics = NULL;
  size_t size;
  char message[IMAGE_MESSAGE_SIZE];
  enum status status = image_encode(image, &encoding, &bytes, &size, message);
  if (status != STATUS_OK) {
    command_error(command, "cannot make '%s': %s", request->output, message);
    return status;
  }
  report->write = seconds_since(start);
  if (request->stats != NULL) status = report_text(command, report_statistics(report), &statistics);
  const size_t length = statistics == NULL ? 0 : strlen(statistics);
  const struct atomic_file files[] = {{request->output, bytes, size}, {request->stats, statistics, length}};
  if (status == STATUS_OK) status = output_write(command, files, 2);
  free(statistics);
  free(bytes);
  return status;
}

static enum status render(const struct command *command, struct request *request, struct image_loading *loading)
{
  struct scene *scene = NULL;
  struct image image = {0};
  const struct seconds start = seconds_now();
  enum status status = scene_file_load(command, &request->scene, &scene);
  if (status == STATUS_OK && !request->scene.quiet) scene_file_warn(command, scene);
  struct report report = {.scene_path = request->scene.path,
                          .picture_path = request->output,
                          .scene = scene,
                          .width = request->options.width,
                          .height = request->options.height,
                          .crop = request->options.crop,
                          .samples = request->options.samples,
                          .parse = seconds_since(start)};
  if (status == STATUS_OK) status = check_outputs(command, request, scene);
  if (status == STATUS_OK) status = make_picture(command, request, loading, &report, &image);
  if (status == STATUS_OK) status = write_results(command, request, &report, &image);
  if (status == STATUS_OK && !request->scene.quiet) report_print(&report);
  image_destroy(&image);
  scene_destroy(scene);
  return status;
}

static int run(const struct command *command, int argc, const char **argv)
{
  struct request request = {.scene = {.width = DEFAULT_WIDTH, .height = DEFAULT_HEIGHT, .tolerance = NAN},
                            .options = {.samples = 1,
                                        .threads = render_processors(),
                                        .channels = {.count = 1, .width = 3, .kind = {CHANNEL_RGB}}}};
  struct command_line line;
  enum status status = command_line_read(command, argc, argv, 1, take_option, &request, &line);
  if (status == STATUS_OK && !line.help) {
    request.scene.path = line.positional[0];
    request.options.width = request.scene.width;
    request.options.height = request.scene.height;
    status = check(command, &request);
  }
  if (status == STATUS_OK && !line.help) {
    struct image_loading loading;
    const char *unused;
    image_loading_begin(&loading);
    status = render(command, &request, &loading);
    (void)!image_loading_end(&loading, &unused);
  }
  free(request.default_output);
  return (int)status;
}

const struct command command_render = {
  .name = "render",
  .arguments = "SCENE",
  .summary = "Renders a scene into a picture",
  .description =
    "The suffix chooses the format. PNG: 8 bits a value (--bits 16 for 16), sRGB. EXR: half floats (--bits 32 for\n"
    "floats), linear, not clipped. Neither --crop nor --threads changes a pixel.\n"
    "\n"
    "Channels (all but rgb need EXR and are stored with 32 bits; depth and all below are those of one sample, the "
    "middle\n"
    "one, which is the pixel's centre when the number of samples is odd):\n"
    "  rgb       R G B: linear colour, the mean of the samples\n"
    "  coverage  share of the samples that hit a patch\n"
    "  depth     distance from the camera in scene units; infinity on a miss\n"
    "  u, v      parameters of the whole patch; 0 on a miss\n"
    "  patch     number of the patch, from 0 in the order of the scene; -1 on a miss\n"
    "  normal    normal.x normal.y normal.z: unit, facing the camera; 0 on a miss\n"
    "  status    0 miss, 1 hit, both certain; 2 miss, 3 hit, both grazing: a change of the input within rounding\n"
    "            could turn the answer\n"
    "  iterations, roots: of the solver, over all leaves of patches that the ray comes to\n"
    "  residual  |P|/delta of the root that is the hit, eq 11 of the paper: accurate below 1; 0 on a miss\n"
    "  deviation relative, of the distance from the default solver's, which is certified; 0 where both miss,\n"
    "            infinity where one does\n",
  .options = OPTIONS,
  .run = run,
};
