/* pscn check SCENE: the same scene by POV-Ray, side by side.
 *
 * The first row is the scene's own text, so that both programs read the same file. The rows with u_steps are
 * POV-Ray's pictures of the canonical text (scene/dump.h) with the steps of every patch set: in the text of the scene
 * a patch may say nothing of its steps, or take them from a name that means other things as well.
 */
#include "command/check.h"

#include <math.h>
#include <stdlib.h>
#include <unistd.h>

#include "base/atomic_file.h"
#include "command/interrupt.h"
#include "command/output.h"
#include "command/report.h"
#include "command/values.h"
#include "image/image_file.h"
#include "language/plain_copy.h"

enum {
  OPTION_OUTPUT = 1,
  OPTION_STEPS,
  OPTION_GRID,
  OPTION_POVRAY,
  OPTION_POVRAY_OPTION,
  OPTION_FAIL,
  OPTION_FAIL_PERCENT,
  OPTION_FAIL_PIXELS,
  OPTION_FAIL_ANY,
  OPTION_FAIL_PSNR,
  OPTION_FAIL_MASK,
  OPTION_QUIET
};

enum { MAX_PIXELS = 1 << 26, MAX_GRID = 100000 };

static const struct poptOption OPTIONS[] = {
  COMMAND_HELP_OPTION,
  COMMAND_OPTION("output", 'o', OPTION_OUTPUT, "folder of the results; default: SCENE's name and -check", "DIR"),
  SCENE_SIZE_OPTION("of the pictures in pixels; default 800x600"),
  SCENE_OPTIONS,
  COMMAND_OPTION("steps", 0, OPTION_STEPS, "POV-Ray's u_steps and v_steps go from 1 to N; 0: none; default 6", "N"),
  COMMAND_OPTION("grid", 0, OPTION_GRID, "compare hits of every Nth pixel and row; 0: none; default 8", "N"),
  COMMAND_OPTION("povray", 0, OPTION_POVRAY, "the program; default povray", "FILE"),
  COMMAND_OPTION("povray-option", 0, OPTION_POVRAY_OPTION, "passed on to it; may be repeated", "OPT"),
  COMMAND_OPTION("fail", 0, OPTION_FAIL, "a pixel fails beyond this difference; default 4/255", "E"),
  COMMAND_OPTION("failpercent", 0, OPTION_FAIL_PERCENT, "so many percent of the pixels may; default 0.3", "P"),
  COMMAND_OPTION("allowfailures", 0, OPTION_FAIL_PIXELS, "or so many pixels may; default 0", "N"),
  COMMAND_OPTION("hardfail", 0, OPTION_FAIL_ANY, "but none beyond this difference; default none", "E"),
  COMMAND_OPTION("failpsnr", 0, OPTION_FAIL_PSNR, "the least PSNR; default 40", "DB"),
  COMMAND_OPTION("failmask", 0, OPTION_FAIL_MASK, "percent of the pixels that only one may hit; default 0.3", "P"),
  COMMAND_FLAG("quiet", 'q', OPTION_QUIET, "say nothing unless something is wrong"),
  POPT_TABLEEND
};

/* What the command line says. */
struct line {
  struct check_request request;
  size_t width, height;
  const char **options; /* owned, not the texts */
  const char *output;
  char *default_output; /* owned */
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
    line->output = argument;
    break;
  case OPTION_SIZE:
    if (!value_size(argument, MAX_SIDE, &line->width, &line->height) || line->height > MAX_PIXELS / line->width)
      return (enum status)command_usage(command, "'%s' is no size WxH of at most %d pixels", argument, MAX_PIXELS);
    break;
  SCENE_OPTION_CASES:
    return scene_request_take(command, &request->scene, val, argument);
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
  case OPTION_QUIET:
    request->quiet = true;
    break;
  default:
    return take_limit(command, request, val, argument);
  }
  return STATUS_OK;
}

/* ---- the folder of the results ---- */

static enum status write_bytes(const struct check *check, const char *folder, const char *name, const void *bytes,
                               size_t size)
{
  char path[SCRATCH_PATH_SIZE];
  int reason;
  snprintf(path, sizeof path, "%s/%s", folder, name);
  const enum status status = atomic_file_write(path, bytes, size, &interrupt_signal, &reason);
  return command_written(check->command, path, status, reason);
}

static enum status write_image(const struct check *check, const char *folder, const char *name,
                               const struct image *image)
{
  const struct image_encoding encoding = { .format = IMAGE_PNG, .bits = 8, .encoded = true };
  unsigned char *bytes;
  size_t size;
  char message[IMAGE_MESSAGE_SIZE];
  enum status status = image_encode(image, &encoding, &bytes, &size, message);
  if (status != STATUS_OK) {
    command_error(check->command, "cannot make '%s/%s': %s", folder, name, message);
    return status;
  }
  status = write_bytes(check, folder, name, bytes, size);
  free(bytes);
  return status;
}

static enum status write_pictures(const struct check *check, const char *folder)
{
  enum status status = write_image(check, folder, "pscn.png", &check->ours.picture);
  for (size_t k = 0; k < check->row_count && status == STATUS_OK; k++) {
    struct image difference;
    char name[64], difference_name[64];
    snprintf(name, sizeof name, k == 0 ? "povray.png" : "povray-%zu.png", check->row[k].steps);
    snprintf(difference_name, sizeof difference_name, k == 0 ? "difference.png" : "difference-%zu.png",
             check->row[k].steps);
    status = write_image(check, folder, name, &check->row[k].picture.image);
    if (status == STATUS_OK)
      status = check_difference(check, &check->row[k], 16, &difference);
    if (status == STATUS_OK) {
      status = write_image(check, folder, difference_name, &difference);
      image_destroy(&difference);
    }
  }
  return status;
}

static enum status write_results(const struct check *check, const char *folder, const char *verdict)
{
  struct page page;
  char path[SCRATCH_PATH_SIZE];
  enum status status = write_pictures(check, folder);
  if (status != STATUS_OK)
    return status;
  snprintf(path, sizeof path, "%s/check.json", folder);
  status = report_write_json(check->command, check_json(check), path);
  if (status != STATUS_OK)
    return status;
  check_page(check, verdict, &page);
  status = page_finish(&page);
  if (status == STATUS_OK)
    status = write_bytes(check, folder, "check.html", page.text, page.length);
  else
    command_error(check->command, "cannot make the page: %s", status == STATUS_LIMIT ? "out of memory" : page.message);
  page_free(&page);
  return status;
}

/* ---- the work ---- */

static void tell(const struct check *check, const char *what)
{
  if (!check->request->quiet)
    fprintf(stderr, "%s\n", what);
}

/* The scene's own text. */
static enum status measure_as_written(struct check *check)
{
  static const char NAME[] = "scene.pov";
  const char *reason;
  const enum status status = plain_copy(check->request->scene.path, check->povray.folder.path, NAME, &reason);
  if (status == STATUS_OK) {
    tell(check, "POV-Ray: as written");
    const enum status measured = check_measure_row(check, NAME, 0);
    if (measured == STATUS_OK && check->warnings != NULL)
      tell(check, check->warnings);
    return measured;
  }
  if (status == STATUS_FILE)
    command_error(check->command, "cannot copy the scene for POV-Ray: %s", reason);
  else
    command_error(check->command, "out of memory, or too many files");
  return status;
}

static enum status measure_series(struct check *check)
{
  enum status status = STATUS_OK;
  for (size_t steps = 1; steps <= check->request->steps && status == STATUS_OK; steps++) {
    char text[64];
    snprintf(text, sizeof text, "POV-Ray: u_steps %zu", steps);
    tell(check, text);
    for (size_t k = 0; k < check->scene->patch_count; k++) {
      struct scene_patch *patch = &check->scene->patches[k];
      patch->u_steps = patch->v_steps = (int)steps;
      patch->flatness = 0;
    }
    status = check_measure_row(check, NULL, steps);
  }
  return status;
}

static enum status measure(struct check *check)
{
  enum status status = povray_open(&check->povray);
  if (status == STATUS_OK) {
    tell(check, "pscn");
    status = check_measure_ours(check);
  }
  if (status == STATUS_OK)
    status = measure_as_written(check);
  if (status == STATUS_OK)
    status = measure_series(check);
  if (status == STATUS_OK)
    status = check_find_worst(check);
  return status;
}

static enum status judge(const struct check *check, const char *folder)
{
  char beyond[256], verdict[512];
  const bool within = check_within_limits(check, beyond, sizeof beyond);
  const struct check_row *last = &check->row[check->row_count - 1];
  if (within)
    snprintf(verdict, sizeof verdict,
             "Within the limits: %.4g %% of the pixels differ by more than %.4g of 255, PSNR %.4g dB.",
             100 * (double)last->over_limit / (double)last->result.pixels, 255 * check->request->fail.each,
             last->result.psnr);
  else
    snprintf(verdict, sizeof verdict, "Beyond the limits: %s.", beyond);
  enum status status = write_results(check, folder, verdict);
  if (status != STATUS_OK)
    return status;
  if (!check->request->quiet) {
    check_print(check);
    printf("\n%s\n%s/check.html shows it\n", verdict, folder);
  }
  status = command_finish_output(check->command);
  if (status == STATUS_OK && !within) {
    command_error(check->command, "%s", beyond);
    return STATUS_DIFFERENT;
  }
  return status;
}

static enum status check_scene(const struct command *command, struct line *line)
{
  struct check_request *request = &line->request;
  if (line->output == NULL)
    line->output = line->default_output = output_folder_name(request->scene.path, "-check");
  if (line->output == NULL) {
    command_error(command, "out of memory");
    return STATUS_LIMIT;
  }
  char message[IMAGE_MESSAGE_SIZE];
  if (image_file_ready(message) != STATUS_OK) {
    command_error(command, "cannot write pictures: %s", message);
    return STATUS_FILE;
  }
  bool made;
  if (output_folder_make(command, line->output, &made) != STATUS_OK)
    return STATUS_FILE;
  interrupt_defer();
  request->scene.width = line->width;
  request->scene.height = line->height;
  struct check check = { .request = request, .command = command, .width = line->width, .height = line->height,
                         .povray = { .command = command, .program = request->program, .options = request->options,
                                     .option_count = request->option_count, .width = line->width,
                                     .height = line->height, .scene_path = request->scene.path } };
  enum status status = measure(&check);
  if (status == STATUS_OK)
    status = judge(&check, line->output);
  if (status != STATUS_OK && made)
    (void)rmdir(line->output); /* fails where something is in it */
  povray_close(&check.povray);
  for (size_t k = 0; k < check.row_count; k++)
    check_row_free(&check.row[k]);
  check_ours_free(&check.ours);
  scene_destroy(check.scene);
  free(check.warnings);
  return status;
}

static int run(const struct command *command, int argc, const char **argv)
{
  struct line line = { .request = { .scene.tolerance = NAN,
                                    .program = "povray",
                                    .steps = 6,
                                    .grid = 8,
                                    .fail = { .each = 4.0 / 255, .percent = 0.3, .any = INFINITY },
                                    .fail_psnr = 40,
                                    .fail_mask = 0.3 },
                       .width = DEFAULT_WIDTH,
                       .height = DEFAULT_HEIGHT };
  struct command_line arguments;
  enum status status = command_line_read(command, argc, argv, 1, take_option, &line, &arguments);
  if (status == STATUS_OK && !arguments.help) {
    line.request.scene.path = arguments.positional[0];
    status = check_scene(command, &line);
  }
  free(line.options);
  free(line.default_output);
  command_line_free(&arguments);
  return status == STATUS_INTERRUPTED || atomic_load(&interrupt_signal) != 0 ? interrupt_exit_code() : (int)status;
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
    "POV-Ray runs without the user's settings, on one thread, without antialiasing.\n",
  .options = OPTIONS,
  .run = run,
};
