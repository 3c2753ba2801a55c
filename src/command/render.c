/* pscn render SCENE: a picture. */
#include "render/render.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "command/command.h"
#include "command/interrupt.h"
#include "command/output.h"
#include "command/piece.h"
#include "command/progress.h"
#include "command/report.h"
#include "command/scene_file.h"
#include "command/values.h"
#include "image/image_loading.h"
#include "language/words.h"
#include "render/threads.h"

enum { OPTION_CROP = 1, OPTION_CHANNELS, OPTION_BITS, OPTION_TILE };

enum {
  MAX_SAMPLES = 256, /* a side: 65536 rays a pixel */
  MAX_THREADS = 1024
};

/* What the command line asks for. */
struct request {
  struct scene_request scene;
  struct render_options options; /* crop.width 0: not given */
  enum image_format format;
  size_t bits; /* 0: not given */
  const char *output, *stats, *channels;
  size_t piece, pieces; /* of --tile; 0: not given */
  bool resume;
  double checkpoint;    /* seconds; 0: never */
  char *default_output; /* owned */
  char *part;           /* owned: where what is done is kept while it is not all; NULL: nowhere */
  char *scene_options;  /* owned */
};

/* Seconds between two looks at what is done so far that are kept: with the time that keeping takes, a minute is lost at
 * most. */
static const double DEFAULT_CHECKPOINT = 30;

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
  COMMAND_OPTION("tile", 0, OPTION_TILE, "only piece K of N, from 1, as an EXR for pscn merge", "K/N"),
  COMMAND_TRUE("resume", 0, resume, "go on where an earlier run was ended"),
  COMMAND_NUMBER("checkpoint", checkpoint, "seconds after which what is done is kept; default 30, 0: never", "S"),
  COMMAND_TEXT("stats", 0, stats, "statistics as JSON; - is standard output", "FILE"),
  COMMAND_TRUE("quiet", 'q', scene.quiet, "say nothing unless something is wrong"),
  COMMAND_OPTIONS_END,
};

static enum status take_channels(const struct command *command, struct request *request, const char *text)
{
  const char *bad;
  size_t length;
  request->channels = text;
  if (channel_list_parse(text, &request->options.channels, &bad, &length)) return STATUS_OK;
  const char *names[CHANNEL_KINDS];
  char known[256];
  for (int k = 0; k < CHANNEL_KINDS; k++) {
    names[k] = channel_traits((enum channel_kind)k)->name;
    if (strlen(names[k]) == length && memcmp(names[k], bad, length) == 0)
      return command_usage(command, "channel '%s' is named twice", names[k]);
  }
  words_list(names, CHANNEL_KINDS, known, sizeof known);
  return command_usage(command, "there is no channel '%.*s', only %s", (int)length, bad, known);
}

static enum status take_option(const struct command *command, void *context, int val, const char *argument)
{
  struct request *request = context;
  switch (val) {
  case OPTION_CROP:
    if (!value_rectangle(argument, &request->options.crop))
      return command_usage(command, "'%s' is no crop X,Y,W,H in pixels", argument);
    break;
  case OPTION_CHANNELS: return take_channels(command, request, argument);
  case OPTION_BITS:
    if (!value_integer(argument, 8, 32, &request->bits))
      return command_usage(command, "'%s' bits are 8, 16 or 32", argument);
    break;
  case OPTION_TILE:
    if (!piece_number(argument, strlen(argument), &request->piece, &request->pieces))
      return command_usage(command, "'%s' is no piece K/N, such as 3/16", argument);
    break;
  default: return scene_request_take(command, &request->scene, val, argument);
  }
  return STATUS_OK;
}

/* A piece is of one format. */
static enum status check_piece(const struct command *command, struct request *request)
{
  if (request->pieces == 0) return STATUS_OK;
  if (request->bits != 0) return command_usage(command, "a piece has 32 bits a value; pscn merge takes --bits");
  request->bits = 32;
  if (request->format == IMAGE_EXR || output_is_standard(request->output)) return STATUS_OK;
  return command_usage(command, "a piece is an EXR: -o FILE.exr; pscn merge makes pictures of all formats");
}

static enum status check_format(const struct command *command, struct request *request)
{
  const struct channel_list *channels = &request->options.channels;
  const bool plain = channels->count == 1 && channels->kind[0] == CHANNEL_RGB;
  if (output_is_standard(request->output))
    request->format = plain && request->pieces == 0 && request->bits != 32 ? IMAGE_PNG : IMAGE_EXR;
  else if (output_format(command, request->output, &request->format) != STATUS_OK) return STATUS_USAGE;
  if (check_piece(command, request) != STATUS_OK) return STATUS_USAGE;
  if (request->bits == 0) request->bits = (size_t)image_format_default_bits(request->format);
  if (!image_format_has_bits(request->format, (int)request->bits))
    return command_usage(command, "'%s' cannot have %zu bits a value: %s", request->output, request->bits,
                         request->format == IMAGE_PNG ? "a PNG has 8 or 16" : "an EXR has 16 or 32");
  if (request->format == IMAGE_PNG && !plain)
    return command_usage(command, "a PNG holds the channel rgb only; other channels need an .exr");
  return STATUS_OK;
}

/* The part of the picture that is kept. */
static enum status check_crop(const struct command *command, struct render_options *options)
{
  struct rectangle *crop = &options->crop;
  if (crop->width == 0) *crop = (struct rectangle){.width = options->width, .height = options->height};
  if (crop->x + crop->width > options->width || crop->y + crop->height > options->height)
    return command_usage(command, "the crop %zu,%zu,%zu,%zu is not inside the picture of %zux%zu pixels", crop->x,
                         crop->y, crop->width, crop->height, options->width, options->height);
  if (crop->height > IMAGE_MAX_PIXELS / crop->width)
    return command_usage(command, "%zux%zu pixels are more than the %d that a picture may have", crop->width,
                         crop->height, IMAGE_MAX_PIXELS);
  return STATUS_OK;
}

/* What is written is no other file of the command; `scene` NULL: as far as known before it is read. */
static enum status check_outputs(const struct command *command, const struct request *request,
                                 const struct scene *scene)
{
  enum status status = output_spare(command, request->stats, request->output);
  if (status == STATUS_OK) status = output_spare(command, request->stats, request->part);
  if (status == STATUS_OK) status = scene_file_spare(command, &request->scene, scene, request->part);
  if (status == STATUS_OK) status = scene_file_spare(command, &request->scene, scene, request->output);
  return status == STATUS_OK ? scene_file_spare(command, &request->scene, scene, request->stats) : status;
}

/* The names and texts that follow from what is given. */
static enum status complete(const struct command *command, struct request *request)
{
  if (request->output == NULL) request->output = request->default_output = output_name(request->scene.path, ".png");
  request->scene_options = scene_request_text(&request->scene);
  bool enough = request->output != NULL && request->scene_options != NULL;
  if (enough && !output_is_standard(request->output)) {
    const size_t size = strlen(request->output) + sizeof ".part.exr";
    request->part = malloc(size);
    enough = request->part != NULL;
    if (enough) snprintf(request->part, size, "%s.part.exr", request->output);
  }
  if (!enough) command_error(command, "out of memory");
  return enough ? STATUS_OK : STATUS_LIMIT;
}

/* Whatever can be known to be wrong before the work starts. */
static enum status check(const struct command *command, struct request *request)
{
  if (complete(command, request) != STATUS_OK) return STATUS_LIMIT;
  if (request->part == NULL && request->resume)
    return command_usage(command, "--resume wants a picture that is a file");
  if (output_is_standard(request->output) && isatty(STDOUT_FILENO) == 1)
    return command_usage(command, "a picture is not written to a terminal; -o FILE says where to");
  enum status status = check_format(command, request);
  if (status == STATUS_OK) status = check_crop(command, &request->options);
  if (status != STATUS_OK) return status;
  status = check_outputs(command, request, NULL);
  if (status == STATUS_OK) status = output_probe(command, request->output);
  if (status == STATUS_OK) status = output_probe(command, request->stats);
  return status;
}

/* Waits until pictures can be written; tells it where they cannot. */
static enum status loaded(const struct command *command, struct image_loading *loading)
{
  const char *message;
  const enum status status = image_loading_end(loading, &message);
  if (status != STATUS_OK) command_error(command, "cannot write pictures: %s", message);
  return status;
}

/* ---- what is done so far ---- */

/* A rendering that is under way. */
struct run {
  const struct command *command;
  const struct request *request;
  struct report *report;
  struct piece piece;
  struct progress progress;
  double kept;   /* when it was last kept, in seconds since the rendering began */
  bool has_part; /* there is a file of what is done */
};

/* Writes what is done into its file. Whether that could be done: it is told where not. */
static bool keep(struct run *run)
{
  struct report_metadata metadata;
  char message[IMAGE_MESSAGE_SIZE];
  unsigned char *bytes;
  size_t size, which;
  int reason = 0;
  report_metadata_fill(run->report, &metadata);
  enum status status = piece_encode(&run->piece, metadata.attribute, metadata.count, &bytes, &size, message);
  if (status == STATUS_OK) {
    const struct atomic_file file = {run->request->part, bytes, size};
    status = atomic_files_write(&file, 1, NULL, &which, &reason);
    snprintf(message, sizeof message, "%s", strerror(reason));
  }
  free(bytes);
  if (status == STATUS_OK) run->has_part = true;
  else command_error(run->command, "cannot keep what is done in '%s': %s", run->request->part, message);
  return status == STATUS_OK;
}

/* About ten times a second. */
static void look(void *context, const struct render_progress *progress)
{
  struct run *run = context;
  const struct request *request = run->request;
  if (!request->scene.quiet) progress_tell(&run->progress, progress);
  if (request->part == NULL || !(request->checkpoint > 0) || progress->seconds - run->kept < request->checkpoint)
    return;
  const struct seconds start = seconds_now();
  (void)keep(run);
  run->kept = progress->seconds + seconds_since(start).wall;
}

/* What is done when a signal ends the rendering. */
static void keep_interrupted(struct run *run)
{
  const size_t done = tile_list_pixels(&run->piece.tiles, true), all = tile_list_pixels(&run->piece.tiles, false);
  if (run->request->part == NULL || done == 0 || !keep(run) || run->request->scene.quiet) return;
  fprintf(stderr, "pscn %s: interrupted; the %.0f %% that are done are in '%s', and --resume goes on from there\n",
          run->command->name, floor(100 * (double)done / (double)all), run->request->part);
}

/* Takes what an earlier run has left. */
static enum status resume(struct run *run)
{
  const struct command *command = run->command;
  const char *path = run->request->part;
  struct piece part;
  char message[IMAGE_MESSAGE_SIZE];
  if (path == NULL || access(path, F_OK) != 0) return STATUS_OK;
  if (!run->request->resume) {
    if (!run->request->scene.quiet)
      fprintf(stderr, "pscn %s: warning: '%s' is left by an earlier run; --resume goes on from there\n", command->name,
              path);
    return STATUS_OK;
  }
  enum status status = piece_read(path, true, &part, message);
  if (status != STATUS_OK) {
    command_error(command, "cannot go on from '%s': %s", path, message);
    return status;
  }
  const bool same_piece = part.number == run->piece.number && part.count == run->piece.count;
  if (!same_piece)
    snprintf(message, sizeof message, "its piece: %zu/%zu, not %zu/%zu", part.number, part.count, run->piece.number,
             run->piece.count);
  if (same_piece && piece_belongs(&part.image, &run->piece.image, message, sizeof message) &&
      piece_copy(&part, &run->piece.image)) {
    for (size_t k = 0; k < part.tiles.count; k++)
      atomic_store(&run->piece.tiles.done[k], atomic_load(&part.tiles.done[k]));
    run->has_part = true;
  } else {
    command_error(command, "'%s' is of another picture; %s. Without --resume it begins anew", path, message);
    status = STATUS_INPUT;
  }
  piece_destroy(&part);
  return status;
}

/* The picture as it is before anything is rendered now. */
static enum status begin(struct run *run)
{
  const struct request *request = run->request;
  const size_t piece = request->pieces == 0 ? 1 : request->piece, pieces = request->pieces == 0 ? 1 : request->pieces;
  struct report_metadata metadata;
  report_metadata_fill(run->report, &metadata);
  const enum status status = piece_create(&request->options, piece, pieces, metadata.attribute, metadata.count,
                                          &run->piece);
  if (status == STATUS_OK) return resume(run);
  command_error(run->command, "out of memory");
  return status;
}

/* ---- the picture ---- */

/* Renders what is not done, and no further where it could not be written. */
static enum status make_picture(struct run *run, struct image_loading *loading)
{
  struct report *report = run->report;
  struct intersector *intersector = NULL;
  struct render_options options = run->request->options;
  const struct render_watch watch = {
    .progress = look, .context = run, .stop = &interrupt_signal, .failed = &loading->failed};
  struct render_stats stats = {0};
  struct seconds start = seconds_now();
  options.tiles = &run->piece.tiles;
  run->progress = progress_start();
  const struct team team = threads_team(options.threads);
  enum status status = intersector_create_by(report->scene, &team, &intersector);
  report->build = seconds_since(start);
  if (status == STATUS_OK) {
    interrupt_defer();
    start = seconds_now();
    status = render_scene(report->scene, intersector, &options, &watch, run->piece.image.value, &stats);
    report->render = seconds_since(start);
    progress_end(&run->progress);
    if (atomic_load(&interrupt_signal) != 0) {
      keep_interrupted(run);
      status = STATUS_INTERRUPTED;
    }
    interrupt_resume();
    report->counts = stats.counts;
    report->threads = stats.threads;
  }
  if (status == STATUS_LIMIT) command_error(run->command, "out of memory or threads");
  else if (atomic_load(&interrupt_signal) == 0) status = loaded(run->command, loading);
  intersector_destroy(intersector);
  return status;
}

static enum status encode(struct run *run, unsigned char **out_bytes, size_t *out_size, char *message)
{
  const struct request *request = run->request;
  struct report_metadata metadata;
  report_metadata_fill(run->report, &metadata);
  if (request->pieces != 0)
    return piece_encode(&run->piece, metadata.attribute, metadata.count, out_bytes, out_size, message);
  run->progress = progress_start();
  const struct image_encoding encoding = {.format = request->format,
                                          .bits = (int)request->bits,
                                          .attributes = metadata.attribute,
                                          .attribute_count = metadata.count,
                                          .progress = request->scene.quiet ? NULL : progress_write,
                                          .context = &run->progress};
  const enum status status = image_encode(&run->piece.image, &encoding, out_bytes, out_size, message);
  progress_end(&run->progress);
  return status;
}

/* The picture, and the statistics where they are asked for; what was kept of it on the way goes. */
static enum status write_results(struct run *run)
{
  const struct command *command = run->command;
  const struct request *request = run->request;
  const struct seconds start = seconds_now();
  unsigned char *bytes;
  char *statistics = NULL;
  size_t size;
  char message[IMAGE_MESSAGE_SIZE];
  enum status status = encode(run, &bytes, &size, message);
  if (status != STATUS_OK) {
    command_error(command, "cannot make '%s': %s", request->output, message);
    return status;
  }
  run->report->write = seconds_since(start);
  if (request->stats != NULL) status = report_text(command, report_statistics(run->report), &statistics);
  const size_t length = statistics == NULL ? 0 : strlen(statistics);
  const struct atomic_file files[] = {{request->output, bytes, size},
                                      {request->stats, statistics, length},
                                      {run->has_part ? request->part : NULL, NULL, 0}};
  if (status == STATUS_OK) status = output_write(command, files, 3);
  free(statistics);
  free(bytes);
  return status;
}

static enum status render(const struct command *command, struct request *request, struct image_loading *loading)
{
  struct scene *scene = NULL;
  const struct seconds start = seconds_now();
  enum status status = scene_file_load(command, &request->scene, &scene);
  if (status == STATUS_OK && !request->scene.quiet) scene_file_warn(command, scene);
  struct report report = {.scene_path = request->scene.path,
                          .picture_path = request->output,
                          .scene = scene,
                          .width = request->options.width,
                          .height = request->options.height,
                          .crop = request->options.crop,
                          .channels = request->channels,
                          .options = request->scene_options,
                          .samples = request->options.samples,
                          .parse = seconds_since(start)};
  struct run run = {.command = command, .request = request, .report = &report};
  if (status == STATUS_OK) status = check_outputs(command, request, scene);
  if (status == STATUS_OK) status = begin(&run);
  if (status == STATUS_OK) status = make_picture(&run, loading);
  if (status == STATUS_OK) status = write_results(&run);
  if (status == STATUS_OK && !request->scene.quiet) report_print(&report);
  piece_destroy(&run.piece);
  scene_destroy(scene);
  return status;
}

static enum status run(const struct command *command, int argc, const char **argv)
{
  struct request request = {.scene = {.width = DEFAULT_WIDTH, .height = DEFAULT_HEIGHT, .tolerance = NAN},
                            .options = {.samples = 1,
                                        .threads = render_processors(),
                                        .channels = {.count = 1, .width = 3, .kind = {CHANNEL_RGB}}},
                            .channels = "rgb",
                            .checkpoint = DEFAULT_CHECKPOINT};
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
  free(request.part);
  free(request.scene_options);
  return status;
}

const struct command command_render = {
  .name = "render",
  .arguments = "SCENE",
  .summary = "Renders a scene into a picture",
  .description =
    "The suffix chooses the format. PNG: 8 bits a value (--bits 16 for 16), sRGB. EXR: half floats (--bits 32 for\n"
    "floats), linear, not clipped. Neither --crop nor --threads changes a pixel.\n"
    "\n"
    "What is done of FILE is kept in FILE.part.exr meanwhile, and stays there where SIGINT, SIGTERM or SIGHUP ends\n"
    "the rendering, or the process is killed: --resume goes on with it, pscn merge and viewers read it. It goes when\n"
    "FILE is complete.\n"
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
