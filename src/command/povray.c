/* Running POV-Ray 3.7. */
#include "command/povray.h"

#include <errno.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/number.h"
#include "command/interrupt.h"
#include "command/process.h"
#include "image/image_file.h"
#include "scene/dump.h"

static const char LOG_NAME[] = "povray.log";
static const char PICTURE_NAME[] = "povray.png";
static const char SCENE_FOLDER_NAME[] = "scene"; /* a link, because POV-Ray takes no blanks in a path it searches */

static enum status out_of_memory(const struct povray *povray)
{
  command_error(povray->command, "out of memory");
  return STATUS_LIMIT;
}

static enum status cannot_write(const struct povray *povray, const char *name)
{
  command_error(povray->command, "cannot write '%s/%s': %s", povray->folder.path, name, strerror(errno));
  return STATUS_FILE;
}

/* ---- what it says ---- */

static void note_version(struct povray *povray, const char *log)
{
  static const char BEFORE[] = "POV-Ray ";
  const char *at = strstr(log, BEFORE);
  if (at == NULL)
    return;
  at += sizeof BEFORE - 1;
  snprintf(povray->version, sizeof povray->version, "%.*s", (int)strcspn(at, " \r\n"), at);
}

/* Shows the end of what it said, which begins where it reads the scene if it got so far. */
static void show_log(const struct povray *povray)
{
  enum { SHOWN = 4000 };
  size_t length;
  char *log = scratch_read(&povray->folder, LOG_NAME, &length);
  if (log == NULL)
    return;
  const char *parsing = strstr(log, "==== [Parsing"), *from = parsing == NULL ? log : parsing;
  if (strlen(from) > SHOWN)
    from += strlen(from) - SHOWN;
  for (const char *line = from; *line != '\0';) {
    const size_t part = strcspn(line, "\r\n");
    if (part > 0)
      fprintf(stderr, "  povray: %.*s\n", (int)part, line);
    line += part + strspn(line + part, "\r\n");
  }
  free(log);
}

static bool holds(const char *line, size_t length, const char *words)
{
  const char *found = strstr(line, words);
  return found != NULL && found < line + length;
}

/* It breaks its messages into lines, which begin with a blank but for the first. */
char *povray_warnings(const struct povray *povray)
{
  size_t length, used = 0;
  char *log = scratch_read(&povray->folder, LOG_NAME, &length);
  if (log == NULL)
    return NULL;
  bool within = false;
  for (const char *line = log; *line != '\0';) { /* the lines that are kept move to the front */
    const size_t part = strcspn(line, "\r\n");
    const bool begins = holds(line, part, "Warning: ") || holds(line, part, "Possible Parse Error: ");
    within = begins || (within && *line == ' ');
    if (within) {
      if (begins && used > 0)
        log[used++] = '\n'; /* takes the place of the end of the line before */
      memmove(log + used, line, part);
      used += part;
    }
    line += part + strspn(line + part, "\r\n");
  }
  log[used] = '\0';
  if (used > 0)
    return log;
  free(log);
  return NULL;
}

/* ---- running it ---- */

static enum status run_program(struct povray *povray, const char *const *arguments, const char *name,
                               struct process_result *out)
{
  const char *folder = povray->folder.path;
  char output[SCRATCH_PATH_SIZE];
  scratch_path(&povray->folder, LOG_NAME, output);
  const char *const environment[] = { "HOME", folder, "POVINI", NULL, NULL };
  const struct process_request request = { .arguments = arguments,
                                           .folder = folder,
                                           .environment = environment,
                                           .output = output };
  const enum status status = process_run(&request, &interrupt_signal, out);
  if (status == STATUS_FILE) {
    command_error(povray->command, "cannot run '%s': %s", povray->program, strerror(out->reason));
    if (out->missing)
      fputs("POV-Ray 3.7 is what scenes are checked against; on Debian 'apt-get install povray' installs it.\n",
            stderr);
  }
  if (status != STATUS_OK)
    return status;
  size_t length;
  char *log = scratch_read(&povray->folder, LOG_NAME, &length);
  if (log != NULL && povray->version[0] == '\0')
    note_version(povray, log);
  free(log);
  if (out->exit_code == 0)
    return STATUS_OK;
  command_error(povray->command, "POV-Ray ended with exit code %d on %s; it says:", out->exit_code, name);
  show_log(povray);
  return STATUS_INPUT;
}

/* Asks the program what it is: so that a missing one is told before the work starts. */
static enum status ask_version(struct povray *povray)
{
  const char *const arguments[] = { povray->program, "--version", NULL };
  struct process_result result;
  const enum status status = run_program(povray, arguments, "--version", &result);
  if (status == STATUS_OK && povray->version[0] == '\0') {
    command_error(povray->command, "'%s' does not call itself POV-Ray", povray->program);
    return STATUS_FILE;
  }
  return status;
}

/* It runs in another folder than ours: a relative path is told from here. False (errno says why) where that is too
 * long. */
static bool find_from_here(const char *path, size_t length, char out[SCRATCH_PATH_SIZE])
{
  char here[SCRATCH_PATH_SIZE] = "";
  if ((length == 0 || path[0] != '/') && getcwd(here, sizeof here) == NULL)
    return false;
  const int size = snprintf(out, SCRATCH_PATH_SIZE, "%s%s%.*s", here, here[0] == '\0' ? "" : "/", (int)length, path);
  errno = ENAMETOOLONG;
  return size >= 0 && size < SCRATCH_PATH_SIZE;
}

/* Links the scene's folder into ours. */
static bool link_scene_folder(const struct povray *povray)
{
  char target[SCRATCH_PATH_SIZE], link[SCRATCH_PATH_SIZE];
  const char *slash = strrchr(povray->scene_path, '/');
  const size_t length = slash == NULL ? 0 : (size_t)(slash - povray->scene_path) + 1;
  scratch_path(&povray->folder, SCENE_FOLDER_NAME, link);
  return find_from_here(povray->scene_path, length, target) && symlink(target, link) == 0;
}

enum status povray_open(struct povray *povray)
{
  if (scratch_create(&povray->folder) != STATUS_OK) {
    command_error(povray->command, "cannot make a temporary folder: %s", strerror(errno));
    return STATUS_FILE;
  }
  if (strchr(povray->program, '/') != NULL) {
    if (!find_from_here(povray->program, strlen(povray->program), povray->program_path)) {
      command_error(povray->command, "cannot run '%s': %s", povray->program, strerror(errno));
      return STATUS_FILE;
    }
    povray->program = povray->program_path;
  }
  if (!link_scene_folder(povray))
    return cannot_write(povray, SCENE_FOLDER_NAME);
  return ask_version(povray);
}

void povray_close(struct povray *povray)
{
  scratch_remove(&povray->folder);
}

/* Runs it on a file of the folder; the picture stands in PICTURE_NAME then. */
static enum status run_on(struct povray *povray, const char *name, size_t width, size_t height,
                          struct process_result *out)
{
  enum { OURS = 16 };
  char input[64], size[2][32], output[64], include[64];
  const char **arguments = calloc(OURS + povray->option_count, sizeof *arguments);
  if (arguments == NULL)
    return out_of_memory(povray);
  snprintf(input, sizeof input, "+I%s", name);
  snprintf(output, sizeof output, "+O%s", PICTURE_NAME);
  snprintf(size[0], sizeof size[0], "+W%zu", width);
  snprintf(size[1], sizeof size[1], "+H%zu", height);
  snprintf(include, sizeof include, "+L%s", SCENE_FOLDER_NAME);
  const char *const ours[] = { povray->program, input, output, size[0], size[1], include, "+FN8", "-A", "-D", "-P",
                               "-UA", "Dither=Off", "Work_Threads=1" };
  const size_t count = sizeof ours / sizeof ours[0];
  _Static_assert(sizeof ours / sizeof ours[0] < OURS, "and the NULL");
  memcpy(arguments, ours, sizeof ours);
  for (size_t k = 0; k < povray->option_count; k++)
    arguments[count + k] = povray->options[k];
  const enum status status = run_program(povray, arguments, name, out);
  free(arguments);
  return status;
}

enum status povray_render(struct povray *povray, const char *name, struct povray_picture *out)
{
  *out = (struct povray_picture){ 0 };
  struct process_result result;
  enum status status = run_on(povray, name, povray->width, povray->height, &result);
  if (status != STATUS_OK)
    return status;
  out->wall = result.wall;
  out->cpu = result.cpu;
  char path[SCRATCH_PATH_SIZE], message[IMAGE_MESSAGE_SIZE];
  scratch_path(&povray->folder, PICTURE_NAME, path);
  status = image_read(path, &out->image, message);
  if (status != STATUS_OK) {
    command_error(povray->command, "cannot read POV-Ray's picture: %s", message);
    return status;
  }
  if (out->image.width == povray->width && out->image.height == povray->height && out->image.channel_count >= 3) {
    for (size_t k = 0; k < povray->width * povray->height * out->image.channel_count; k++)
      out->image.value[k] = roundf(255 * out->image.value[k]) / 255; /* the reader multiplies by a rounded 1/255 */
    return STATUS_OK;
  }
  command_error(povray->command, "POV-Ray's picture has %zux%zu pixels and %zu channels, not %zux%zu and 3",
                out->image.width, out->image.height, out->image.channel_count, povray->width, povray->height);
  image_destroy(&out->image);
  return STATUS_INPUT;
}

enum status povray_render_scene(struct povray *povray, const struct scene *scene, struct povray_picture *out)
{
  static const char NAME[] = "canonical.pov";
  *out = (struct povray_picture){ 0 };
  FILE *file = scratch_open(&povray->folder, NAME);
  if (file == NULL)
    return cannot_write(povray, NAME);
  const enum status status = scene_dump(scene, file);
  if (scratch_close(file) != STATUS_OK || status == STATUS_FILE)
    return cannot_write(povray, NAME);
  return status == STATUS_OK ? povray_render(povray, NAME, out) : out_of_memory(povray);
}

/* ---- what it hits ---- */

/* The scene in white that no light changes, on black. */
enum status povray_mask(struct povray *povray, const struct scene *scene, unsigned char *out)
{
  const struct scene_texture white = { .pigment = { 1, 1, 1 },
                                       .finish = { .ambient = { 1, 1, 1 }, .brilliance = 1, .phong_size = 40,
                                                   .roughness = 0.05 } };
  struct scene flat = *scene;
  flat.textures = calloc(scene->texture_count + 1, sizeof *flat.textures);
  if (flat.textures == NULL)
    return out_of_memory(povray);
  for (size_t k = 0; k < scene->texture_count; k++)
    flat.textures[k] = white;
  flat.light_count = 0;
  for (int k = 0; k < 3; k++) {
    flat.background[k] = 0;
    flat.ambient_light[k] = 1;
  }
  struct povray_picture picture;
  const enum status status = povray_render_scene(povray, &flat, &picture);
  for (size_t k = 0; status == STATUS_OK && k < povray->width * povray->height; k++)
    out[k] = picture.image.value[k * picture.image.channel_count] > 0.5f;
  image_destroy(&picture.image);
  free(flat.textures);
  return status;
}

static void put_vector(FILE *file, const double v[3])
{
  for (int k = 0; k < 3; k++) {
    char number[NUMBER_TEXT_SIZE];
    number_write_17(v[k], number);
    fprintf(file, "%c%s", k == 0 ? '<' : ',', number);
  }
  fputc('>', file);
}

/* A text whose reading writes a line for each ray. */
static enum status write_questions(const struct scene *scene, size_t count, const struct ray rays[], FILE *file)
{
  fputs("#version 3.7;\nglobal_settings { assumed_gamma 1 }\n", file);
  const enum status status = scene_dump_union(scene, "Scene", file);
  fputs("#fopen Answers \"answers.txt\" write\n"
        "#macro Ask(From, Along)\n"
        "  #local Normal = <0, 0, 0>;\n"
        "  #local Point = trace(Scene, From, Along, Normal);\n"
        "  #if (vlength(Normal) = 0)\n"
        "    #write (Answers, \"-1\\n\")\n"
        "  #else\n"
        "    #write (Answers, str(vlength(Point - From), 0, 17), \"\\n\")\n"
        "  #end\n"
        "#end\n",
        file);
  for (size_t k = 0; k < count; k++) {
    fputs("Ask(", file);
    put_vector(file, rays[k].origin);
    fputs(", ", file);
    put_vector(file, rays[k].direction);
    fputs(")\n", file);
  }
  fputs("#fclose Answers\n", file);
  return status;
}

static bool read_answers(const struct povray *povray, size_t count, double out_distance[])
{
  size_t length, at = 0, read = 0;
  char *text = scratch_read(&povray->folder, "answers.txt", &length);
  while (text != NULL && read < count && at < length) {
    double value;
    size_t used;
    if (number_read(text + at, length - at, &value, &used) == NUMBER_FINITE) {
      out_distance[read++] = value < 0 ? INFINITY : value;
      at += used;
    } else {
      at++;
    }
  }
  free(text);
  return read == count;
}

enum status povray_trace(struct povray *povray, const struct scene *scene, size_t count, const struct ray rays[],
                         double out_distance[])
{
  static const char NAME[] = "trace.pov";
  for (size_t k = 0; k < count; k++)
    out_distance[k] = INFINITY;
  if (scene->patch_count == 0 || count == 0)
    return STATUS_OK;
  FILE *file = scratch_open(&povray->folder, NAME);
  if (file == NULL)
    return cannot_write(povray, NAME);
  enum status status = write_questions(scene, count, rays, file);
  if (scratch_close(file) != STATUS_OK || status == STATUS_FILE)
    return cannot_write(povray, NAME);
  if (status != STATUS_OK)
    return out_of_memory(povray);
  struct process_result result;
  status = run_on(povray, NAME, 1, 1, &result);
  if (status == STATUS_OK && !read_answers(povray, count, out_distance)) {
    command_error(povray->command, "POV-Ray's trace() left answers out");
    status = STATUS_INPUT;
  }
  return status;
}
