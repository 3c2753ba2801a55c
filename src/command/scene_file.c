/* Reads a scene from a file. See scene_file.h. */
#define _XOPEN_SOURCE 700 /* realpath */
#include "command/scene_file.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <unistd.h>

#include "base/memory.h"
#include "base/number.h"
#include "base/text_buffer.h"
#include "command/output.h"
#include "command/values.h"

/* Errors without a place in a file have the form of command_error. */
static void tell(void *context, const char *text, size_t length)
{
  const char *const *name = context;
  if (strncmp(text, "error: ", 7) == 0) fprintf(stderr, "pscn %s: ", *name);
  (void)fwrite(text, 1, length, stderr);
}

struct diagnostics stderr_diagnostics(const struct command *command)
{
  return (struct diagnostics){.tell = tell, .context = (void *)&command->name};
}

/* "NAME=VALUE" */
static enum status take_number(const struct command *command, struct scene_request *request, const char *argument)
{
  const size_t length = strcspn(argument, "=");
  const char *value = argument + length + 1;
  struct language_number number = {.name = argument, .name_length = length};
  size_t used = 0;
  if (argument[length] == '\0' || number_read(value, strlen(value), &number.value, &used) != NUMBER_FINITE ||
      value[used] != '\0')
    return command_usage(command, "'%s' is not NAME=NUMBER", argument);
  if (!number_in_range(&number.value)) return command_usage(command, "'%s': the number is larger than 1e100", argument);
  if (length == 5 && strncmp(argument, "clock", length) == 0) return command_usage(command, "--clock X sets the clock");
  if (!language_is_name(argument, length))
    return command_usage(command, "'%.*s' is not a name that can be declared", (int)length, argument);
  if (request->number_count == SCENE_MOST_NUMBERS)
    return command_usage(command, "more than %d numbers are declared", SCENE_MOST_NUMBERS);
  request->numbers[request->number_count++] = number;
  return STATUS_OK;
}

enum status scene_request_take(const struct command *command, void *scene_request, int val, const char *argument)
{
  struct scene_request *request = scene_request;
  switch (val) {
  case OPTION_SIZE:
    if (!value_size(argument, MAX_SIDE, &request->width, &request->height))
      return command_usage(command, "'%s' is not a size WxH of 1 to %d pixels each", argument, MAX_SIDE);
    break;
  case OPTION_DECLARE: return take_number(command, request, argument);
  case OPTION_INCLUDE:
    if (request->folder_count == SCENE_MOST_FOLDERS)
      return command_usage(command, "more than %d folders are named", SCENE_MOST_FOLDERS);
    request->folders[request->folder_count++] = argument;
    break;
  default:
    if (!value_bytes(argument, &request->max_memory))
      return command_usage(command, "'%s' is not a size of memory, such as 500M or 2G", argument);
    break;
  }
  return STATUS_OK;
}

/* A few lines of text can ask for any number of patches, so more than a share of the memory needs an option. */
size_t scene_request_memory(const struct scene_request *request)
{
  const size_t most = (size_t)8 << 30, share = 4, of_stranger = (size_t)256 << 20;
  const long pages = sysconf(_SC_PHYS_PAGES), page = sysconf(_SC_PAGESIZE);
  if (request->max_memory != 0) return request->max_memory;
  if (request->untrusted) return of_stranger;
  if (pages <= 0 || page <= 0 || (size_t)pages > most * share / (size_t)page) return most;
  return (size_t)pages * (size_t)page / share;
}

const char **scene_request_folders(const struct scene_request *request)
{
  static const char *const povray[] = {"/usr/share/povray-3.7/include", "/usr/local/share/povray-3.7/include", NULL};
  const char *variable = getenv("PSCN_INCLUDE");
  if (variable == NULL) variable = "";
  size_t count = request->folder_count, colons = 0;
  for (const char *at = variable; (at = strchr(at, ':')) != NULL; at++) colons++;
  const size_t rows = (count + colons + 1) * sizeof(char *) + sizeof povray;
  const char **folders = malloc(rows + strlen(variable) + 1);
  if (folders == NULL) return NULL;
  memcpy(folders, request->folders, count * sizeof *folders);
  char *names = strcpy((char *)folders + rows, variable);
  for (char *folder = strtok(names, ":"); folder != NULL; folder = strtok(NULL, ":")) folders[count++] = folder;
  memcpy(folders + count, povray, sizeof povray);
  return folders;
}

static enum status load(const struct command *command, const struct scene_request *request, const char *const *folders,
                        struct scene **out)
{
  const struct language_settings settings = {.image_width = (int)request->width,
                                             .image_height = (int)request->height,
                                             .lenient = request->lenient,
                                             .clock = request->clock,
                                             .frame = request->frame,
                                             .first_frame = request->first_frame,
                                             .last_frame = request->last_frame,
                                             .solver_text = request->solver_text,
                                             .tolerance = request->tolerance,
                                             .folders = folders,
                                             .numbers = request->numbers,
                                             .number_count = request->number_count,
                                             .untrusted = request->untrusted,
                                             .max_memory = scene_request_memory(request)};
  static struct memory_limit limit;
  struct diagnostics diagnostics = stderr_diagnostics(command);
  diagnostics.quiet = request->quiet;
  limit.most = settings.max_memory;
  (void)memory_limit_use(&limit);
  if (!output_is_standard(request->path)) return language_load(request->path, &settings, &diagnostics, out);
  struct source *text;
  const char *reason;
  enum status status = source_read_open("stdin", dup(STDIN_FILENO), &text, &reason);
  if (status != STATUS_OK) {
    diagnostics_error(&diagnostics, (struct place){NULL, 0, 0}, "stdin: %s", reason);
    return status;
  }
  status = language_load_text(text->name, text->text, text->length, &settings, &diagnostics, out);
  source_destroy(text);
  return status;
}

/* Of the whole process, in CPU seconds, if the user sets no other limit; then comes SIGXCPU (interrupt.h). */
enum { TIME_OF_STRANGER = 300 };

static void limit_time(void)
{
  struct rlimit limit;
  if (getrlimit(RLIMIT_CPU, &limit) != 0 || limit.rlim_cur != RLIM_INFINITY) return;
  limit.rlim_cur = TIME_OF_STRANGER;
  (void)setrlimit(RLIMIT_CPU, &limit);
}

enum status scene_file_load(const struct command *command, const struct scene_request *request, struct scene **out)
{
  const char **folders = scene_request_folders(request);
  *out = NULL;
  if (request->untrusted) limit_time();
  enum status status = folders == NULL ? command_out_of_memory(command) : load(command, request, folders, out);
  free(folders);
  if (status == STATUS_OK) status = scene_file_spare(command, request, *out, "-");
  if (status != STATUS_OK) scene_destroy(*out), *out = NULL;
  return status;
}

char *scene_request_text(const struct scene_request *request)
{
  struct text_buffer text = {0};
  char number[NUMBER_TEXT_SIZE];
  if (request->solver_text != NULL) text_buffer_format(&text, " --solver '%s'", request->solver_text);
  number_write(request->tolerance, number);
  if (!isnan(request->tolerance)) text_buffer_format(&text, " --tolerance %s", number);
  if (request->lenient) text_buffer_add_text(&text, " --lenient");
  number_write(request->clock, number);
  if (request->clock != 0) text_buffer_format(&text, " --clock %s", number);
  for (size_t k = 0; k < request->number_count; k++) {
    const struct language_number *given = &request->numbers[k];
    number_write(given->value, number);
    text_buffer_format(&text, " --declare %.*s=%s", (int)given->name_length, given->name, number);
  }
  return text_buffer_take(&text);
}

void scene_file_warn_of_cuts(const struct command *command, const struct intersector *intersector)
{
  if (intersector_cut_less(intersector))
    command_warning(
      command, "memory is short, so patches are cut into fewer leaves than 'split' requests; --max-memory allows more");
}

bool scene_file_warn(const struct command *command, const struct scene *scene)
{
  const bool missing[] = {scene->patch_count == 0, scene->light_count == 0, !scene->has_camera};
  static const char *const what[] = {"no patches", "no light_source", "no camera"};
  for (size_t k = 0; k < sizeof missing / sizeof *missing; k++)
    if (missing[k]) command_warning(command, "the scene has %s", what[k]);
  if (scene->gamma_assumed)
    command_warning(
      command,
      "the scene has no #version, so its colours are read as sRGB, as in POV-Ray; begin with '#version 3.7;' for "
      "linear colours");
  return missing[0] || missing[1] || missing[2];
}

/* The folder of a name, all links followed; NULL if there is none. The caller frees it. */
static char *folder_of(const char *path)
{
  const char *slash = strrchr(path, '/');
  char *folder = slash == NULL ? strdup(".") : strndup(path, (size_t)(slash - path) + 1);
  char *real = folder == NULL ? NULL : realpath(folder, NULL);
  free(folder);
  return real;
}

/* Whether a file would be in the scene's folder, or below it. */
static bool is_beside(const char *file, const char *scene)
{
  if (output_is_standard(file) || output_is_standard(scene)) return false;
  char *folder = folder_of(file), *own = folder_of(scene);
  const size_t length = own == NULL ? 0 : strlen(own);
  const bool beside = folder != NULL && own != NULL && strncmp(folder, own, length) == 0 &&
                      (folder[length] == '\0' || folder[length] == '/' || length == 1);
  free(folder);
  free(own);
  return beside;
}

enum status scene_file_spare(const struct command *command, const struct scene_request *request,
                             const struct scene *scene, const char *output)
{
  enum status status = output_spare(command, output, output_is_standard(request->path) ? "/dev/stdin" : request->path);
  if (status == STATUS_OK && request->untrusted && output != NULL && is_beside(output, request->path))
    return command_usage(command, "'%s' is in the scene's folder or below it, which --untrusted forbids", output);
  for (size_t k = 0; scene != NULL && k < scene->file_count && status == STATUS_OK; k++)
    status = output_spare(command, output, scene->files[k]);
  return status;
}
