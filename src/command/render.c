/* pscn render SCENE: a picture. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "command/command.h"
#include "command/output.h"
#include "command/piece.h"
#include "command/rendering.h"
#include "command/scene_file.h"
#include "command/values.h"
#include "language/words.h"

enum { OPTION_CROP = 1, OPTION_CHANNELS, OPTION_FRAMES, OPTION_TILE };

enum {
  MAX_SAMPLES = 256, /* per side: 65536 rays per pixel */
  MAX_THREADS = 1024
};

/* The command line's request. */
struct request {
  struct scene_request scene;
  struct rendering_request picture; /* bits 0, crop.width 0: not given */
  char *output, *part, *how;        /* owned: texts of `picture` that are not on the command line; or NULL */
};

enum { MAX_FRAME = 999999 };

/* Seconds after which what is done is kept again. With the time that keeping takes, at most a minute is lost. */
#define DEFAULT_CHECKPOINT 30.0

static const struct command_option OPTIONS[] = {
  COMMAND_HELP_OPTION,
  COMMAND_TEXT("output", 'o', picture.output, "the picture, .png or .exr; default: SCENE with .png", "FILE"),
  SCENE_SIZE_OPTION("width and height in pixels; default 800x600"),
  SCENE_OPTIONS,
  COMMAND_INTEGER("samples", picture.options.samples, 1, MAX_SAMPLES, "number of samples",
                  "N x N rays a pixel on a regular grid; default 1", "N"),
  COMMAND_OPTION("crop", 0, OPTION_CROP, "only this part, in pixels from the left and top", "X,Y,W,H"),
  COMMAND_INTEGER("threads", picture.options.threads, 1, MAX_THREADS, "number of threads",
                  "number of threads; default one for each processor", "N"),
  COMMAND_OPTION("channels", 0, OPTION_CHANNELS, "values kept of each pixel, separated by commas; default rgb", "LIST"),
  COMMAND_BITS_OPTION(picture.bits),
  COMMAND_OPTION("frames", 0, OPTION_FRAMES, "frames A to B of an animation; clock goes from 0 to 1 over them", "A-B"),
  COMMAND_OPTION("tile", 0, OPTION_TILE, "only piece K of N, from 1, as an EXR for pscn merge", "K/N"),
  COMMAND_TRUE("resume", 0, picture.resume, "continue where an earlier run ended"),
  COMMAND_NUMBER("checkpoint", picture.checkpoint, "seconds between writing the finished part; default 30, 0: never",
                 "S"),
  COMMAND_TEXT("stats", 0, picture.stats, "statistics as JSON; - is standard output", "FILE"),
  COMMAND_TRUE("quiet", 'q', scene.quiet, "print nothing unless something is wrong"),
  COMMAND_OPTIONS_END,
};

static enum status take_channels(const struct command *command, struct request *request, const char *text)
{
  const char *bad;
  size_t length;
  request->picture.channels = text;
  if (channel_list_parse(text, &request->picture.options.channels, &bad, &length)) return STATUS_OK;
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

static enum status take_frames(const struct command *command, struct scene_request *scene, const char *text)
{
  size_t first, last;
  if (!value_range(text, '-', MAX_FRAME, &first, &last))
    return command_usage(command, "'%s' is not a range of frames A-B, such as 1-24", text);
  scene->first_frame = (int)first;
  scene->last_frame = (int)last;
  return STATUS_OK;
}

static enum status take_option(const struct command *command, void *context, int val, const char *argument)
{
  struct request *request = context;
  switch (val) {
  case OPTION_CROP:
    if (!value_rectangle(argument, &request->picture.options.crop))
      return command_usage(command, "'%s' is not a crop X,Y,W,H in pixels", argument);
    break;
  case OPTION_CHANNELS: return take_channels(command, request, argument);
  case OPTION_FRAMES: return take_frames(command, &request->scene, argument);
  case OPTION_TILE:
    if (!value_range(argument, '/', PIECE_MOST, &request->picture.piece, &request->picture.pieces))
      return command_usage(command, "'%s' is not a piece K/N, such as 3/16", argument);
    break;
  default: return scene_request_take(command, &request->scene, val, argument);
  }
  return STATUS_OK;
}

/* A piece has only one format. */
static enum status check_piece(const struct command *command, struct rendering_request *picture)
{
  if (picture->pieces == 0) return STATUS_OK;
  if (picture->bits != 0) return command_usage(command, "a piece has 32 bits a value; pscn merge takes --bits");
  picture->bits = 32;
  if (picture->format == IMAGE_EXR || output_is_standard(picture->output)) return STATUS_OK;
  return command_usage(command, "a piece is an EXR: -o FILE.exr; pscn merge makes pictures of all formats");
}

static enum status check_format(const struct command *command, struct rendering_request *picture)
{
  const bool plain = channel_list_is_rgb(&picture->options.channels);
  if (output_is_standard(picture->output))
    picture->format = plain && picture->pieces == 0 && picture->bits != 32 ? IMAGE_PNG : IMAGE_EXR;
  else if (output_format(command, picture->output, &picture->format) != STATUS_OK) return STATUS_USAGE;
  if (check_piece(command, picture) != STATUS_OK) return STATUS_USAGE;
  if (picture->bits == 0) picture->bits = (size_t)image_format_default_bits(picture->format);
  if (!image_format_has_bits(picture->format, (int)picture->bits))
    return command_usage(command, "'%s' cannot have %zu bits a value: %s", picture->output, picture->bits,
                         picture->format == IMAGE_PNG ? "a PNG has 8 or 16" : "an EXR has 16 or 32");
  if (picture->format == IMAGE_PNG && !plain)
    return command_usage(command, "a PNG holds only the channel rgb; other channels need .exr");
  return STATUS_OK;
}

/* The most pixels, and rays from the camera, of a stranger's scene. */
enum { UNTRUSTED_PIXELS = 1 << 24, UNTRUSTED_RAYS = 1 << 28 };

/* Completes and checks the part of the picture that is rendered. */
static enum status check_crop(const struct command *command, bool untrusted, struct render_options *options)
{
  struct rectangle *crop = &options->crop;
  if (crop->width == 0) *crop = (struct rectangle){.width = options->width, .height = options->height};
  if (crop->x + crop->width > options->width || crop->y + crop->height > options->height)
    return command_usage(command, "the crop %zu,%zu,%zu,%zu is not inside the picture of %zux%zu pixels", crop->x,
                         crop->y, crop->width, crop->height, options->width, options->height);
  if (crop->height > IMAGE_MAX_PIXELS / crop->width)
    return command_usage(command, "%zux%zu pixels are more than the %d that a picture may have", crop->width,
                         crop->height, IMAGE_MAX_PIXELS);
  const size_t pixels = crop->width * crop->height;
  if (untrusted && (pixels > UNTRUSTED_PIXELS || pixels * options->samples * options->samples > UNTRUSTED_RAYS))
    return command_usage(command, "--untrusted allows %d pixels and %d samples", UNTRUSTED_PIXELS, UNTRUSTED_RAYS);
  return STATUS_OK;
}

/* Adds the names and texts that follow from the request. */
static enum status complete(const struct command *command, struct request *request)
{
  struct rendering_request *picture = &request->picture;
  picture->scene = &request->scene;
  picture->options.width = request->scene.width, picture->options.height = request->scene.height;
  if (picture->output == NULL && request->scene.untrusted)
    return command_usage(command, "with --untrusted the picture is not written beside the scene; name it with -o FILE");
  if (picture->output == NULL) picture->output = request->output = output_name(request->scene.path, ".png");
  picture->how = request->how = scene_request_text(&request->scene);
  bool enough = picture->output != NULL && picture->how != NULL;
  if (enough && !output_is_standard(picture->output)) {
    const size_t size = strlen(picture->output) + sizeof ".part.exr";
    picture->part = request->part = malloc(size);
    enough = request->part != NULL;
    if (enough) snprintf(request->part, size, "%s.part.exr", picture->output);
  }
  return enough ? STATUS_OK : command_out_of_memory(command);
}

/* A picture may be writable where its part is not, because the part's name is longer. The part is then omitted, unless
 * --resume asks for it. A link of its name, which somebody else may have made, is not followed. */
static enum status check_part(const struct command *command, struct rendering_request *picture)
{
  int reason;
  struct stat state;
  if (picture->part == NULL) return STATUS_OK;
  if (lstat(picture->part, &state) == 0 && S_ISLNK(state.st_mode)) {
    command_error(
      command,
      "'%s', in which the finished part would be kept, is a link; remove it, or choose another name for the "
      "picture",
      picture->part);
    return STATUS_FILE;
  }
  if (picture->resume) return output_probe(command, picture->part);
  const enum status status = atomic_file_probe(picture->part, &reason);
  /* opening a pipe waits for a reader, and what a device gets is lost */
  const bool special = status == STATUS_OK && stat(picture->part, &state) == 0 && !S_ISREG(state.st_mode);
  if (status == STATUS_OK && !special) return STATUS_OK;
  if (status == STATUS_LIMIT) return command_out_of_memory(command);
  if (!picture->scene->quiet)
    command_warning(command, "the finished part will not be kept, because '%s' cannot be written: %s", picture->part,
                    special ? "it is not a file" : output_reason(picture->part, reason));
  picture->part = NULL;
  return STATUS_OK;
}

/* Checks what can be known to be wrong before the work starts. */
static enum status check(const struct command *command, struct rendering_request *picture)
{
  if (picture->part == NULL && picture->resume)
    return command_usage(command, "--resume needs a picture that is a file");
  if (output_is_standard(picture->output) && isatty(STDOUT_FILENO) == 1)
    return command_usage(command, "a picture is not written to a terminal; name a file with -o FILE");
  enum status status = check_format(command, picture);
  if (status == STATUS_OK) status = check_crop(command, picture->scene->untrusted, &picture->options);
  if (status == STATUS_OK) status = rendering_check_outputs(command, picture, NULL);
  if (status == STATUS_OK) status = output_probe(command, picture->output);
  if (status == STATUS_OK) status = output_probe(command, picture->stats);
  return status == STATUS_OK ? check_part(command, picture) : status;
}

static enum status make(const struct command *command, struct request *request)
{
  enum status status = complete(command, request);
  if (status == STATUS_OK) status = check(command, &request->picture);
  if (status == STATUS_OK) status = rendering_make(command, &request->picture);
  free(request->output);
  free(request->part);
  free(request->how);
  return status;
}

/* NAME07.png: the number has as many digits as that of the last frame, as in POV-Ray. The caller frees it. */
static char *frame_name(const char *name, int frame, int last)
{
  const size_t size = strlen(name) + 16;
  char *framed = malloc(size);
  const char *slash = strrchr(name, '/'), *suffix = strrchr(name, '.');
  if (suffix == NULL || (slash != NULL && suffix < slash)) suffix = name + strlen(name);
  if (framed != NULL)
    snprintf(framed, size, "%.*s%0*d%s", (int)(suffix - name), name, snprintf(NULL, 0, "%d", last), frame, suffix);
  return framed;
}

/* Whether an earlier run has finished the picture: it is there, and nothing is kept of it. */
static bool is_finished(const char *output)
{
  struct stat state;
  char part[4096];
  return snprintf(part, sizeof part, "%s.part.exr", output) < (int)sizeof part && stat(output, &state) == 0 &&
         lstat(part, &state) != 0;
}

static enum status make_frames(const struct command *command, const struct request *request)
{
  const int first = request->scene.first_frame, last = request->scene.last_frame;
  if (request->picture.stats != NULL || request->picture.pieces > 0)
    return command_usage(command, "--frames cannot be used with --stats or --tile, which are for one picture");
  char *name = request->picture.output != NULL ? strdup(request->picture.output)
                                               : output_name(request->scene.path, ".png");
  enum status status = name == NULL ? command_out_of_memory(command) : STATUS_OK;
  if (status == STATUS_OK && output_is_standard(name))
    status = command_usage(command, "frames are files; name them with -o NAME.png");
  for (int frame = first; frame <= last && status == STATUS_OK; frame++) {
    struct request one = *request;
    char *output = frame_name(name, frame, last);
    one.scene.frame = frame;
    one.scene.clock = last > first ? (double)(frame - first) / (last - first) : 0;
    one.picture.output = output;
    if (output == NULL) status = command_out_of_memory(command);
    else if (!one.picture.resume || !is_finished(output)) status = make(command, &one);
    if (status != STATUS_OK) command_error(command, "frame %d of %d to %d is not rendered", frame, first, last);
    free(output);
  }
  free(name);
  return status;
}

static const struct request DEFAULTS = {
  .scene = SCENE_REQUEST_DEFAULT,
  .picture = {.options = {.samples = 1, .channels = {.count = 1, .width = 3, .kind = {CHANNEL_RGB}}},
              .channels = "rgb",
              .checkpoint = DEFAULT_CHECKPOINT}};

static enum status run(const struct command *command, void *context, const struct command_line *line)
{
  struct request *request = context;
  request->scene.path = line->positional[0];
  if (request->picture.options.threads == 0) request->picture.options.threads = render_processors();
  return request->scene.last_frame > 0 ? make_frames(command, request) : make(command, request);
}

const struct command command_render = {
  .name = "render",
  .arguments = "SCENE",
  .summary = "Renders a scene into a picture",
  .description =
    "The suffix chooses the format. PNG: 8 bits a value (--bits 16 for 16), sRGB. EXR: half floats (--bits 32 for\n"
    "floats), linear, not clipped. Neither --crop nor --threads changes a pixel.\n"
    "\n"
    "During rendering the finished part is kept in FILE.part.exr. It stays if SIGINT, SIGTERM, SIGHUP or SIGXCPU\n"
    "ends the rendering, if the process is killed, or if FILE cannot be written. --resume continues with it; pscn\n"
    "merge and viewers can read it. It is removed when FILE is complete.\n"
    "\n"
    "--frames 1-24 -o NAME.png writes NAME01.png to NAME24.png, with --resume only the missing ones. A single\n"
    "frame, for a farm: --clock X --declare frame_number=K -o NAME07.png.\n"
    "\n"
    "'pscn help channels' lists the values that --channels may name. All but rgb need EXR.\n",
  COMMAND_RUNS(1, take_option),
};
