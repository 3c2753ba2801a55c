/* Runs POV-Ray 3.7. See povray.h. */
#define _XOPEN_SOURCE 700 /* realpath */
#include "page/povray.h"

#include <errno.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "base/number.h"
#include "page/process.h"
#include "image/image_file.h"
#include "intersect/intersect.h"
#include "page/plain_copy.h"
#include "scene/scene.h"

/* The bytes that a run may write: for each pixel the picture, the state in which POV-Ray keeps it meanwhile, and an answer
 * of trace(), and something for the rest. */
#define WRITTEN_BYTES ((size_t)64 << 20)
#define WRITTEN_PIXEL_BYTES ((size_t)64)

/* In our folder. POV-Ray runs in its subfolder RUN, which is new for each run. */
static const char LOG[] = "povray.log", HOME[] = "home";
#define RUN "run"

/* In RUN. */
#define TEXT "scene.pov"
#define PICTURE "picture.png"
#define ANSWERS "answers.txt"

/* It may read only its own folder and the files installed with it, and run no program, as far as it obeys that. */
static const char RESTRICTIONS[] = "[File I/O Security]\nrestricted\n[Shellout Security]\nforbidden\n"
                                   "[Permitted Paths]\nread* = %INSTALLDIR%/include\nread+write = .\n";

static enum status cannot_write(const struct povray *povray, const char *name)
{
  return listener_fail(povray->listener, STATUS_FILE, "cannot write '%s/%s': %s", povray->folder, name,
                       strerror(errno));
}

/* ---- what it says ---- */

/* All its output, made printable; `failed` if memory is short. */
static struct text_buffer read_log(const struct povray *povray)
{
  struct text_buffer raw = scratch_read(povray->folder, LOG), log = {.failed = raw.failed};
  for (size_t k = 0; k < raw.length; k++) raw.text[k] = raw.text[k] == '\r' ? '\n' : raw.text[k];
  if (raw.text != NULL) text_buffer_add_printable(&log, raw.text, raw.length);
  text_buffer_free(&raw);
  return log;
}

static void note_version(struct povray *povray, const struct text_buffer *log)
{
  static const char BEFORE[] = "POV-Ray ";
  const char *at = log->text == NULL ? NULL : strstr(log->text, BEFORE);
  if (at == NULL || povray->version[0] != '\0') return;
  at += sizeof BEFORE - 1;
  snprintf(povray->version, sizeof povray->version, "%.*s", (int)strcspn(at, " \n"), at);
}

/* Shows the end of its output, from where it begins to parse the scene, if it does. */
static void show_log(const struct povray *povray, const struct text_buffer *log)
{
  enum { SHOWN = 4000 };
  if (log->text == NULL) return;
  const char *parsing = strstr(log->text, "==== [Parsing"), *line = parsing == NULL ? log->text : parsing;
  if (strlen(line) > SHOWN) line += strlen(line) - SHOWN;
  for (; *line != '\0'; line += strcspn(line, "\n"), line += strspn(line, "\n"))
    if (*line != '\n') listener_tell(povray->listener, TOLD_DETAIL, "  povray: %.*s", (int)strcspn(line, "\n"), line);
}

/* ---- running it ---- */

/* Removes the folder of the last run and makes a new one. */
static enum status begin_run(const struct povray *povray)
{
  char path[SCRATCH_PATH_SIZE];
  scratch_path(povray->folder, RUN, path);
  scratch_remove(path);
  return mkdir(path, 0700) == 0 ? STATUS_OK : cannot_write(povray, RUN);
}

static enum status run_program(struct povray *povray, const char *const *arguments, const char *what,
                               struct process_result *out)
{
  char log_path[SCRATCH_PATH_SIZE], home[SCRATCH_PATH_SIZE], run[SCRATCH_PATH_SIZE];
  scratch_path(povray->folder, LOG, log_path);
  scratch_path(povray->folder, HOME, home);
  scratch_path(povray->folder, RUN, run);
  const char *const environment[] = {"HOME", home, "POVINI", NULL, NULL};
  const struct process_request request = {.arguments = arguments,
                                          .folder = run,
                                          .environment = environment,
                                          .output = log_path,
                                          .timeout = povray->timeout,
                                          .memory = povray->memory,
                                          .written = WRITTEN_BYTES +
                                                     WRITTEN_PIXEL_BYTES * povray->width * povray->height,
                                          .confined = true};
  const enum status status = process_run(&request, povray->listener->stop, out);
  if (status == STATUS_LIMIT && out->overfull)
    return listener_fail(povray->listener, status, "POV-Ray wrote more than %zu MB on %s", request.written >> 20, what);
  if (status == STATUS_LIMIT)
    return listener_fail(povray->listener, status, "POV-Ray took more than %g seconds on %s (--timeout)",
                         povray->timeout, what);
  povray->missing = status == STATUS_FILE && out->missing;
  if (povray->missing && povray->optional) return status;
  if (status == STATUS_FILE)
    (void)listener_fail(povray->listener, status, "cannot run '%s': %s", povray->program, strerror(out->reason));
  if (povray->missing)
    listener_tell(povray->listener, TOLD_DETAIL,
                  "pscn check needs POV-Ray 3.7; on Debian 'apt-get install povray' installs it.");
  if (status != STATUS_OK) return status;
  struct text_buffer log = read_log(povray);
  const bool failed = log.failed;
  note_version(povray, &log);
  povray->refused = out->exit_code != 0;
  if (out->exit_code != 0) {
    listener_tell(povray->listener, TOLD_ERROR, "POV-Ray ended with exit code %d on %s; it says:", out->exit_code,
                  what);
    show_log(povray, &log);
  }
  text_buffer_free(&log);
  if (failed) return listener_out_of_memory(povray->listener);
  return out->exit_code == 0 ? STATUS_OK : STATUS_INPUT;
}

/* Asks the program for its version, so that its absence is reported before the work starts. */
static enum status ask_version(struct povray *povray)
{
  const char *const arguments[] = {povray->program, "--version", NULL};
  struct process_result result;
  enum status status = begin_run(povray);
  if (status == STATUS_OK) status = run_program(povray, arguments, "--version", &result);
  if (status == STATUS_OK && povray->version[0] == '\0')
    return listener_fail(povray->listener, STATUS_FILE, "'%s' is not POV-Ray", povray->program);
  return status;
}

/* Makes the folder that is its HOME, with the restrictions where it looks for them. */
static enum status make_home(const struct povray *povray)
{
  static const char *const FOLDERS[] = {"home", "home/.povray", "home/.povray/3.7"};
  static const char FILE_NAME[] = "home/.povray/3.7/povray.conf";
  char path[SCRATCH_PATH_SIZE];
  for (size_t k = 0; k < sizeof FOLDERS / sizeof FOLDERS[0]; k++) {
    scratch_path(povray->folder, FOLDERS[k], path);
    if (mkdir(path, 0700) != 0) return cannot_write(povray, FOLDERS[k]);
  }
  FILE *file = scratch_open(povray->folder, FILE_NAME);
  if (file == NULL) return cannot_write(povray, FILE_NAME);
  (void)fputs(RESTRICTIONS, file);
  return scratch_close(file) == STATUS_OK ? STATUS_OK : cannot_write(povray, FILE_NAME);
}

enum status povray_open(struct povray *povray)
{
  if (scratch_create(povray->folder) != STATUS_OK)
    return listener_fail(povray->listener, STATUS_FILE, "cannot make a folder in $TMPDIR or /tmp: %s", strerror(errno));
  /* it will run in another folder */
  if (povray->program[0] != '/' && strchr(povray->program, '/') != NULL &&
      realpath(povray->program, povray->program_path) != NULL)
    povray->program = povray->program_path;
  const enum status status = make_home(povray);
  return status == STATUS_OK ? ask_version(povray) : status;
}

void povray_close(struct povray *povray) { scratch_remove(povray->folder); }

/* Runs it on TEXT, which is in RUN; the picture is then in PICTURE. */
static enum status run_on_text(struct povray *povray, const char *what, bool pictured, struct process_result *out)
{
  enum { OURS = 16 };
  char size[2][32];
  const char **arguments = calloc(OURS + povray->option_count, sizeof *arguments);
  if (arguments == NULL) return listener_out_of_memory(povray->listener);
  snprintf(size[0], sizeof size[0], "+W%zu", pictured ? povray->width : 1);
  snprintf(size[1], sizeof size[1], "+H%zu", pictured ? povray->height : 1);
  const char *const ours[] = {
    povray->program, "+I" TEXT, "+O" PICTURE, size[0],         size[1], "+FN8", "-A", "-D", "-P",
    "-UA",           "+SU",     "Dither=Off", "Work_Threads=1"};
  const size_t count = sizeof ours / sizeof ours[0];
  _Static_assert(sizeof ours / sizeof ours[0] < OURS, "and the NULL");
  memcpy(arguments, ours, sizeof ours);
  for (size_t k = 0; k < povray->option_count; k++) arguments[count + k] = povray->options[k];
  const enum status status = run_program(povray, arguments, what, out);
  free(arguments);
  return status;
}

/* ---- what it reads ---- */

static void put_vector(FILE *file, const double v[3])
{
  for (int k = 0; k < 3; k++) {
    char number[NUMBER_TEXT_SIZE];
    number_write_17(v[k], number);
    fprintf(file, "%c%s", k == 0 ? '<' : ',', number);
  }
  fputc('>', file);
}

/* Writes a scene of one object, and questions that write a line for each ray when they are parsed. */
static enum status write_questions(const struct scene *scene, size_t count, const struct ray *rays, FILE *file)
{
  struct scene empty = *scene;
  empty.patch_count = 0;
  enum status status = scene_dump(&empty, file);
  if (status == STATUS_OK) status = scene_dump_union(scene, "Scene", file);
  fputs("object { Scene }\n#fopen Answers \"" ANSWERS "\" write\n"
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

/* Writes TEXT: a scene, or if `rays` is not NULL, questions about it. */
static enum status write_text(const struct povray *povray, const struct scene *scene, size_t count,
                              const struct ray *rays)
{
  enum status status = begin_run(povray);
  if (status != STATUS_OK) return status;
  FILE *file = scratch_open(povray->folder, RUN "/" TEXT);
  if (file == NULL) return cannot_write(povray, TEXT);
  status = rays == NULL ? scene_dump(scene, file) : write_questions(scene, count, rays, file);
  if (scratch_close(file) != STATUS_OK || status == STATUS_FILE) return cannot_write(povray, TEXT);
  return status == STATUS_OK ? status : listener_out_of_memory(povray->listener);
}

/* ---- pictures ---- */

static enum status read_picture(const struct povray *povray, struct image *out)
{
  char path[SCRATCH_PATH_SIZE], message[IMAGE_MESSAGE_SIZE];
  scratch_path(povray->folder, RUN "/" PICTURE, path);
  const enum status status = image_read(path, out, message);
  if (status != STATUS_OK) return listener_fail(povray->listener, status, "cannot read POV-Ray's picture: %s", message);
  if (out->width == povray->width && out->height == povray->height && out->channel_count >= 3) {
    for (size_t k = 0; k < povray->width * povray->height * out->channel_count; k++)
      out->value[k] = roundf(255 * out->value[k]) / 255; /* the reader multiplies by a rounded 1/255 */
    return STATUS_OK;
  }
  const enum status wrong = listener_fail(povray->listener, STATUS_INPUT,
                                          "POV-Ray's picture has %zux%zu pixels and %zu channels, not %zux%zu and 3",
                                          out->width, out->height, out->channel_count, povray->width, povray->height);
  image_destroy(out);
  return wrong;
}

static enum status render_text(struct povray *povray, const char *what, struct povray_picture *out)
{
  struct process_result result;
  const enum status status = run_on_text(povray, what, true, &result);
  out->time = result.time;
  return status == STATUS_OK ? read_picture(povray, &out->image) : status;
}

enum status povray_render(struct povray *povray, const struct scene *scene, struct povray_picture *out)
{
  *out = (struct povray_picture){0};
  const enum status status = write_text(povray, scene, 0, NULL);
  return status == STATUS_OK ? render_text(povray, "the scene", out) : status;
}

enum status povray_render_file(struct povray *povray, const char *path, const char *const *folders,
                               char out_word[POVRAY_WORD_SIZE], struct povray_picture *out)
{
  char folder[SCRATCH_PATH_SIZE];
  const char *reason;
  *out = (struct povray_picture){0};
  scratch_path(povray->folder, RUN, folder);
  enum status status = begin_run(povray);
  if (status != STATUS_OK) return status;
  status = plain_copy(path, folders, folder, TEXT, &reason, out_word);
  if (status == STATUS_FILE)
    return listener_fail(povray->listener, status, "cannot copy the scene for POV-Ray: %s", reason);
  if (status != STATUS_OK) return listener_fail(povray->listener, status, "out of memory, or too many files");
  return out_word[0] == '\0' ? render_text(povray, "the scene as written", out) : STATUS_OK;
}

/* ---- what it hits ---- */

/* The scene in white, unaffected by light, on black. The caller frees its textures; NULL if memory is short. */
static struct scene flatten(const struct scene *scene)
{
  const struct scene_texture white = {
    .pigment = {1, 1, 1}, .finish = {.ambient = {1, 1, 1}, .brilliance = 1, .phong_size = 40, .roughness = 0.05}};
  struct scene flat = *scene;
  flat.textures = calloc(scene->texture_count + 1, sizeof *flat.textures);
  for (size_t k = 0; flat.textures != NULL && k < scene->texture_count; k++) flat.textures[k] = white;
  flat.light_count = 0;
  for (int k = 0; k < 3; k++) {
    flat.background[k] = 0;
    flat.ambient_light[k] = 1;
  }
  return flat;
}

static enum status read_answers(const struct povray *povray, size_t count, double out_distance[])
{
  struct text_buffer answers = scratch_read(povray->folder, RUN "/" ANSWERS);
  size_t at = 0, read = 0;
  if (answers.failed) return listener_out_of_memory(povray->listener);
  while (read < count && at < answers.length) {
    double value;
    size_t used;
    if (number_read(answers.text + at, answers.length - at, &value, &used) == NUMBER_FINITE) {
      out_distance[read++] = value < 0 ? INFINITY : value;
      at += used;
    } else {
      at++;
    }
  }
  text_buffer_free(&answers);
  return read == count ? STATUS_OK
                       : listener_fail(povray->listener, STATUS_INPUT, "POV-Ray's trace() printed too few distances");
}

enum status povray_ask(struct povray *povray, const struct scene *scene, size_t count, const struct ray *rays,
                       double out_distance[], unsigned char *out_mask)
{
  const size_t pixels = povray->width * povray->height;
  for (size_t k = 0; k < count; k++) out_distance[k] = INFINITY;
  if (scene->patch_count == 0 || (count == 0 && out_mask == NULL)) return STATUS_OK;
  struct scene flat = flatten(scene);
  if (flat.textures == NULL) return listener_out_of_memory(povray->listener);
  struct process_result result;
  struct image picture = {0};
  enum status status = write_text(povray, &flat, count, rays);
  if (status == STATUS_OK) status = run_on_text(povray, "the questions to trace()", out_mask != NULL, &result);
  if (status == STATUS_OK) status = read_answers(povray, count, out_distance);
  if (status == STATUS_OK && out_mask != NULL) status = read_picture(povray, &picture);
  for (size_t k = 0; status == STATUS_OK && out_mask != NULL && k < pixels; k++)
    out_mask[k] = picture.value[k * picture.channel_count] > 0.5f;
  image_destroy(&picture);
  free(flat.textures);
  return status;
}

/* Reads the log: "Trace Time: 0 hours 0 minutes 1 seconds (1.234 seconds)", then "using 1 thread(s) with 1.200
 * CPU-seconds total". */
enum status povray_time(struct povray *povray, const struct scene *scene, double *out)
{
  static const char BEFORE[] = ") with ";
  struct process_result result;
  struct scene flat = flatten(scene);
  if (flat.textures == NULL) return listener_out_of_memory(povray->listener);
  enum status status = write_text(povray, &flat, 0, NULL);
  if (status == STATUS_OK) status = run_on_text(povray, "the scene in white", true, &result);
  free(flat.textures);
  struct text_buffer log = read_log(povray);
  const char *at = log.text == NULL ? NULL : strstr(log.text, "Trace Time:");
  size_t used;
  at = at == NULL ? NULL : strstr(at, BEFORE);
  *out = NAN;
  if (at != NULL && number_read(at + sizeof BEFORE - 1, strlen(at + sizeof BEFORE - 1), out, &used) != NUMBER_FINITE)
    *out = NAN;
  text_buffer_free(&log);
  return status;
}
