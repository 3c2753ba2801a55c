/* pscn check SCENE: the same scene by POV-Ray, side by side. */
#include "check/check.h"

#include <math.h>
#include <stdlib.h>
#include <sys/stat.h>

#include "check/povray.h"
#include "command/command.h"
#include "command/output.h"
#include "command/scene_file.h"
#include "command/values.h"
#include "image/image_file.h"

enum {
  OPTION_OUTPUT = 1,
  OPTION_STEPS,
  OPTION_GRID,
  OPTION_POVRAY,
  OPTION_POVRAY_OPTION,
  OPTION_OWN_TEXT,
  OPTION_TIMEOUT,
  OPTION_FAIL,
  OPTION_FAIL_PERCENT,
  OPTION_FAIL_PIXELS,
  OPTION_FAIL_ANY,
  OPTION_FAIL_PSNR,
  OPTION_FAIL_MASK,
  OPTION_QUIET
};

enum { MAX_PIXELS = 1 << 26, MAX_GRID = 100000 };

static const struct command_option OPTIONS[] = {
  COMMAND_HELP_OPTION,
  COMMAND_OPTION("output", 'o', OPTION_OUTPUT, "folder of the results; default: SCENE's name and -check", "DIR"),
  SCENE_SIZE_OPTION("of the pictures in pixels; default 800x600"),
  SCENE_OPTIONS,
  COMMAND_OPTION("steps", 0, OPTION_STEPS, "POV-Ray's u_steps and v_steps go from 1 to N; 0: none; default 6", "N"),
  COMMAND_OPTION("grid", 0, OPTION_GRID, "compare hits of every Nth pixel and row; 0: none; default 8", "N"),
  COMMAND_OPTION("povray", 0, OPTION_POVRAY, "the program; default povray", "FILE"),
  COMMAND_OPTION("povray-option", 0, OPTION_POVRAY_OPTION, "passed on to it; may be repeated", "OPT"),
  COMMAND_FLAG("own-text", 0, OPTION_OWN_TEXT, "in the first row it reads the scene's own text"),
  COMMAND_OPTION("timeout", 0, OPTION_TIMEOUT, "seconds that each run of it may take; default 300", "S"),
  COMMAND_OPTION("fail", 0, OPTION_FAIL, "a pixel fails beyond this difference; default 4/255", "E"),
  COMMAND_OPTION("failpercent", 0, OPTION_FAIL_PERCENT, "so many percent of the pixels may; default 0.3", "P"),
  COMMAND_OPTION("allowfailures", 0, OPTION_FAIL_PIXELS, "or so many pixels may; default 0", "N"),
  COMMAND_OPTION("hardfail", 0, OPTION_FAIL_ANY, "but none beyond this difference; default none", "E"),
  COMMAND_OPTION("failpsnr", 0, OPTION_FAIL_PSNR, "the least PSNR; default 40", "DB"),
  COMMAND_OPTION("failmask", 0, OPTION_FAIL_MASK, "percent of the pixels that only one may hit; default 0.3", "P"),
  COMMAND_FLAG("quiet", 'q', OPTION_QUIET, "say nothing unless something is wrong"),
  COMMAND_OPTIONS_END
};

/* What the command line says. */
struct line {
  struct check_request request;
  struct scene_request scene;
  struct output_folder folder;
  struct command_ear ear;
  const char **options; /* owned, not the texts */
};

static enum status take_povray_option(const struct command *command, struct line *line, const char *text)
{
  const char **options = realloc(line->options, (line->request.option_count + 1) * sizeof *options);
  if (options == NULL) {
    command_error(command, "out of memory");
    return STATUS_LIMIT;
  }
  options[line->request.option_count++] = text;
  line->request.options = line->options = options;
  return STATUS_OK;
}

static enum status take_limit(const struct command *command, struct check_request *request, int val, const char *text)
{
  double *const number = val == OPTION_FAIL           ? &request->fail.each
                         : val == OPTION_FAIL_PERCENT ? &request->fail.percent
                         : val == OPTION_FAIL_PIXELS  ? &request->fail.allowed_pixels
                         : val == OPTION_FAIL_ANY     ? &request->fail.any
                         : val == OPTION_FAIL_PSNR    ? &request->fail_psnr
                                                      : &request->fail_mask;
  if (value_number(text, number))
    return STATUS_OK;
  return (enum status)command_usage(command, "'%s' is no number from 0 up, such as 0.01 or 4/255", text);
}

static enum status take_option(const struct command *command, void *context, int val, const char *argument)
{
  struct line *line = context;
  struct check_request *request = &line->request;
  switch (val) {
  case OPTION_OUTPUT:
    line->folder.path = argument;
    break;
  case OPTION_SIZE:
    if (!value_size(argument, MAX_SIDE, &request->width, &request->height) ||
        request->height > MAX_PIXELS / request->width)
      return (enum status)command_usage(command, "'%s' is no size WxH of at most %d pixels", argument, MAX_PIXELS);
    break;
  SCENE_OPTION_CASES:
    return scene_request_take(command, &line->scene, val, argument);
  case OPTION_STEPS:
    if (!value_integer(argument, 0, CHECK_MAX_STEPS, &request->steps))
      return (enum status)command_usage(command, "'%s' is no number of steps from 0 to %d", argument, CHECK_MAX_STEPS);
    break;
  case OPTION_GRID:
    if (!value_integer(argument, 0, MAX_GRID, &request->grid))
      return (enum status)command_usage(command, "'%s' is no distance from 0 to %d", argument, MAX_GRID);
    break;
  case OPTION_POVRAY:
    request->program = argument;
    break;
  case OPTION_POVRAY_OPTION:
    return take_povray_option(command, line, argument);
  case OPTION_OWN_TEXT:
    request->own_text = true;
    break;
  case OPTION_TIMEOUT:
    if (!value_number(argument, &request->timeout) || request->timeout == 0)
      return (enum status)command_usage(command, "'%s' is no number of seconds", argument);
    break;
  case OPTION_QUIET:
    line->ear.quiet = line->scene.quiet = true;
    break;
  default:
    return take_limit(command, request, val, argument);
  }
  return STATUS_OK;
}

/* ---- the work ---- */

/* What can be known to be wrong before the work. */
static enum status prepare(const struct command *command, const struct check_request *request)
{
  struct stat info;
  char message[IMAGE_MESSAGE_SIZE];
  if (request->own_text && stat(request->path, &info) == 0 && !S_ISREG(info.st_mode)) {
    command_error(command, "--own-text reads the scene twice, and '%s' is no regular file", request->path);
    return STATUS_FILE;
  }
  const enum status status = image_file_ready(message);
  if (status != STATUS_OK)
    command_error(command, "cannot write pictures: %s", message);
  return status;
}

static enum status work(void *context, const char *folder, struct page *out_text)
{
  struct line *line = context;
  struct check_request *request = &line->request;
  const struct listener listener = command_listener(&line->ear);
  const struct seconds start = seconds_now();
  struct scene *scene = NULL;
  request->folder = folder;
  request->memory = scene_request_memory(&line->scene);
  line->scene.path = request->path;
  line->scene.width = request->width;
  line->scene.height = request->height;
  enum status status = scene_file_load(line->ear.command, &line->scene, &scene);
  request->parse = seconds_since(start);
  if (status == STATUS_OK)
    status = check_scene(request, scene, &listener, out_text);
  scene_destroy(scene);
  return status;
}

static int run(const struct command *command, int argc, const char **argv)
{
  struct line line = { .request = { .width = DEFAULT_WIDTH,
                                    .height = DEFAULT_HEIGHT,
                                    .program = "povray",
                                    .timeout = POVRAY_TIMEOUT,
                                    .steps = 6,
                                    .grid = 8,
                                    .fail = { .each = 4.0 / 255, .percent = 0.3, .any = INFINITY },
                                    .fail_psnr = 40,
                                    .fail_mask = 0.3 },
                       .scene = { .tolerance = NAN },
                       .folder = { .suffix = "-check", .page = "check.html" },
                       .ear = { .command = command } };
  struct command_line arguments;
  char *command_line = command_line_text(argc, argv);
  enum status status = command_line_read(command, argc, argv, 1, take_option, &line, &arguments);
  if (status == STATUS_OK && !arguments.help) {
    line.request.path = arguments.positional[0];
    line.request.command_line = command_line == NULL ? "" : command_line;
    line.folder.scene = line.request.path;
    line.folder.quiet = line.ear.quiet;
    status = prepare(command, &line.request);
    if (status == STATUS_OK)
      status = output_folder_fill(command, &line.folder, work, &line);
  }
  free(command_line);
  free(line.options);
  return (int)status;
}

const struct command command_check = {
  .name = "check",
  .arguments = "SCENE",
  .summary = "Renders a scene here and by POV-Ray and compares the pictures",
  .description =
    "POV-Ray renders the scene as it is written, and then with every patch cut finer and finer (u_steps = v_steps = 1\n"
    "to 6, flatness 0), which shows it converging towards the exact surface. Standard output tells how many pixels\n"
    "differ by more than 1, 4 and 16 of 255, how many of those beyond the limit are not on a silhouette, a shadow's\n"
    "edge or a crease, which pixels only one of both hits, the time of both, and the differences of the distances\n"
    "that POV-Ray's trace() answers. DIR receives check.html, which needs nothing beside itself, check.json, and\n"
    "the pictures. The exit code is 1 where the last picture passes the limits.\n"
    "POV-Ray runs without the user's settings, on one thread, without antialiasing, and reads what pscn understood of\n"
    "the scene (pscn dump); with --own-text it first reads the scene's own text, which may do whatever POV-Ray lets\n"
    "it do: it runs in a folder of its own, with a limit of time and memory.\n",
  .options = OPTIONS,
  .run = run,
};
