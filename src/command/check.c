/* pscn check SCENE: the same scene by POV-Ray, side by side. */
#include "check/check.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/stat.h>

#include "base/number.h"
#include "command/command.h"
#include "command/output.h"
#include "command/scene_file.h"
#include "image/image_file.h"

enum { OPTION_POVRAY_OPTION = 1 };
enum { MAX_PIXELS = 1 << 26, MAX_GRID = 100000 };

/* The command line's request. */
struct request {
  struct scene_request scene;
  struct check_request check;
  struct output_folder folder;
  const char **options; /* owned, as are the next two; the texts are not */
  const char **folders; /* in which included files are looked for */
  char *declared;       /* texts of options */
  bool dump;
};

static const struct command_option OPTIONS[] = {
  COMMAND_HELP_OPTION,
  COMMAND_TEXT("output", 'o', folder.path, "folder of the results; default: SCENE's name and -check", "DIR"),
  SCENE_SIZE_OPTION("width and height in pixels; default 800x600"),
  SCENE_OPTIONS,
  COMMAND_INTEGER("steps", check.steps, 0, CHECK_MAX_STEPS, "number of steps",
                  "POV-Ray's u_steps and v_steps go from 1 to N; 0: none; default 6", "N"),
  COMMAND_INTEGER("grid", check.grid, 0, MAX_GRID, "grid",
                  "compare hits of every Nth pixel and row; 0: none; default 8", "N"),
  COMMAND_TEXT("povray", 0, check.povray.program, "POV-Ray's program; default povray", "FILE"),
  COMMAND_OPTION("povray-option", 0, OPTION_POVRAY_OPTION, "passed on to POV-Ray; may be repeated", "OPT"),
  COMMAND_TRUE("dump", 0, dump, "POV-Ray reads the dump for the first picture, too"),
  COMMAND_POSITIVE("timeout", check.povray.timeout, "number of seconds", "limit of each run of POV-Ray; default 300",
                   "S"),
  COMMAND_NUMBER("fail", check.fail.each, "a pixel fails beyond this difference; default 4/255", "E"),
  COMMAND_NUMBER("failpercent", check.fail.percent, "percent of the pixels that may fail; default 0.3", "P"),
  COMMAND_NUMBER("allowfailures", check.fail.allowed_pixels, "or number of pixels that may fail; default 0", "N"),
  COMMAND_NUMBER("hardfail", check.fail.any, "difference that no pixel may exceed; default none", "E"),
  COMMAND_NUMBER("failpsnr", check.fail_psnr, "the least PSNR; default 40", "DB"),
  COMMAND_NUMBER("failmask", check.fail_mask, "percent of the pixels that only one may hit; default 0.3", "P"),
  COMMAND_TRUE("quiet", 'q', scene.quiet, "print nothing unless something is wrong"),
  COMMAND_OPTIONS_END,
};

static enum status take_povray_option(const struct command *command, struct request *request, const char *text)
{
  const char **options = realloc(request->options, (request->check.povray.option_count + 1) * sizeof *options);
  if (options == NULL) return command_out_of_memory(command);
  options[request->check.povray.option_count++] = text;
  request->check.povray.options = request->options = options;
  return STATUS_OK;
}

/* Adds POV-Ray options for --clock and the numbers of --declare, where POV-Ray reads the scene's file. */
static enum status declare_numbers(const struct command *command, struct request *request)
{
  const struct scene_request *scene = &request->scene;
  enum status status = STATUS_OK;
  char number[NUMBER_TEXT_SIZE];
  size_t size = sizeof "Clock=" + NUMBER_TEXT_SIZE, used = 0;
  for (size_t k = 0; k < scene->number_count; k++)
    size += sizeof "Declare==" + scene->numbers[k].name_length + NUMBER_TEXT_SIZE;
  char *texts = request->declared = malloc(size);
  if (texts == NULL) return command_out_of_memory(command);
  for (size_t k = 0; k < scene->number_count && status == STATUS_OK; k++) {
    const struct language_number *given = &scene->numbers[k];
    number_write_17(given->value, number);
    status = take_povray_option(command, request, texts + used);
    used += 1 + (size_t)snprintf(texts + used, size - used, "Declare=%.*s=%s", (int)given->name_length, given->name,
                                 number);
  }
  number_write_17(scene->clock, number);
  snprintf(texts + used, size - used, "Clock=%s", number);
  return status == STATUS_OK && scene->clock != 0 ? take_povray_option(command, request, texts + used) : status;
}

static enum status take_option(const struct command *command, void *context, int val, const char *argument)
{
  struct request *request = context;
  return val == OPTION_POVRAY_OPTION ? take_povray_option(command, request, argument)
                                     : scene_request_take(command, &request->scene, val, argument);
}

/* ---- the work ---- */

/* The errors that can be known before the work. */
static enum status prepare(const struct command *command, const struct check_request *request)
{
  char message[IMAGE_MESSAGE_SIZE];
  if (request->height > MAX_PIXELS / request->width)
    return command_usage(command, "%zux%zu pixels are more than the %d that are compared", request->width,
                         request->height, MAX_PIXELS);
  const enum status status = image_file_ready(message);
  if (status != STATUS_OK) command_error(command, "cannot write pictures: %s", message);
  return status;
}

/* Why POV-Ray cannot read the scene as written, or NULL. */
static const char *dumped_because(const struct request *request)
{
  struct stat info;
  const char *path = request->check.path;
  if (request->dump) return "--dump is given";
  if (request->scene.untrusted) return "--untrusted is given";
  const bool file = !output_is_standard(path) && (stat(path, &info) != 0 || S_ISREG(info.st_mode));
  return file ? NULL : "the scene is not a file that can be read again";
}

static enum status work(void *context, const struct output_job *job)
{
  struct check_request *check = &((struct request *)context)->check;
  check->folder = job->folder;
  check->parse = job->parse;
  return check_scene(check, job->scene, job->listener, job->out_text);
}

static const struct request DEFAULTS = {
  .scene = SCENE_REQUEST_DEFAULT,
  .check = {.povray = {.program = "povray", .timeout = POVRAY_TIMEOUT},
            .steps = 6,
            .grid = 8,
            .fail = {.each = 4.0 / 255, .percent = 0.3, .any = INFINITY},
            .fail_psnr = 40,
            .fail_mask = 0.3},
  .folder = {.suffix = "-check", .files = check_files, .file_count = CHECK_FILES}};

static enum status run(const struct command *command, void *context, const struct command_line *line)
{
  struct request *request = context;
  struct check_request *check = &request->check;
  check->path = request->scene.path = line->positional[0];
  check->command_line = line->text;
  check->width = request->scene.width;
  check->height = request->scene.height;
  check->povray.memory = scene_request_memory(&request->scene);
  check->dumped = dumped_because(request);
  check->folders = request->folders = scene_request_folders(&request->scene);
  if (check->folders == NULL) return command_out_of_memory(command);
  enum status status = prepare(command, check);
  if (status == STATUS_OK && check->dumped == NULL) status = declare_numbers(command, request);
  return status == STATUS_OK ? output_folder_fill(command, &request->folder, &request->scene, work, request) : status;
}

static void end(void *context)
{
  struct request *request = context;
  free(request->options);
  free(request->folders);
  free(request->declared);
}

const struct command command_check = {
  .name = "check",
  .arguments = "SCENE",
  .summary = "Renders a scene here and by POV-Ray and compares the pictures",
  .description =
    "POV-Ray renders the scene as it is written, and then with every patch cut finer and finer (u_steps = v_steps =\n"
    "1 to 6, flatness 0), which shows it converging towards the exact surface. Standard output has the percentage\n"
    "of pixels that differ by more than 1, 4 and 16 of 255; the number of those beyond the limit that are not on a\n"
    "silhouette, a shadow's edge or a crease, and of those that only one of both hits; the time of both; and the\n"
    "differences of the distances that POV-Ray's trace() returns. DIR receives check.html, check.json and the\n"
    "pictures. The exit code is 1 if the last picture exceeds a limit.\n"
    "\n"
    "POV-Ray runs without the user's settings, on one thread, without antialiasing, in a folder of its own, with a\n"
    "limit of time and memory. For the first picture it reads the scene's file, without solver statements. For the\n"
    "others it reads the dump (pscn dump). It reads the dump for all pictures with --dump, and if the scene could\n"
    "read or write other files.\n",
  COMMAND_RUNS(1, take_option),
  .end = end,
};
