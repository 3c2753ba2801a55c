/* Where results go. See output.h. */
#include "command/output.h"

#include <assert.h>
#include <errno.h>
#include <stdio.h>
#include <stdio_ext.h> /* __fpurge */
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/input.h"
#include "command/interrupt.h"

/* Writes to standard output. If files are to follow, a signal or a reader that has gone ends only the writing, because
 * the caller must still save what the files were made of. */
static enum status write_standard(const struct command *command, const struct atomic_file *output, bool files_follow)
{
  if (!files_follow) interrupt_resume(); /* nothing would have to be saved */
  if (atomic_load(&interrupt_signal) != 0) return STATUS_INTERRUPTED;
  (void)fwrite(output->bytes, 1, output->size, stdout);
  if (fflush(stdout) == 0 || atomic_load(&interrupt_signal) == 0) return command_finish_output(command);
  __fpurge(stdout); /* otherwise the program's end would wait for the reader again */
  return STATUS_INTERRUPTED;
}

/* The part after the last slash. */
static const char *base_of(const char *path)
{
  const char *slash = strrchr(path, '/');
  return slash == NULL ? path : slash + 1;
}

bool output_is_standard(const char *path) { return strcmp(path, "-") == 0; }

const char *output_reason(const char *path, int reason)
{
  char byte;
  return reason == ENOENT && readlink(path, &byte, 1) >= 0 ? "it is a link to a missing file" : strerror(reason);
}

/* Prints why a file was not probed or written. */
static enum status told(const struct command *command, const char *path, enum status status, int reason)
{
  if (status == STATUS_FILE || status == STATUS_LIMIT)
    command_error(command, "cannot write '%s': %s", path, output_reason(path, reason));
  return status;
}

enum status output_probe(const struct command *command, const char *path)
{
  if (path == NULL || output_is_standard(path)) return STATUS_OK;
  int reason;
  const enum status status = atomic_file_probe(path, &reason);
  return told(command, path, status, reason);
}

enum status output_write(const struct command *command, const struct atomic_file outputs[], size_t count)
{
  struct atomic_file files[OUTPUT_MOST];
  size_t named = 0, which;
  enum status status = STATUS_OK;
  int reason;
  assert(count <= OUTPUT_MOST);
  for (size_t k = 0; k < count; k++)
    if (outputs[k].path != NULL && !output_is_standard(outputs[k].path)) files[named++] = outputs[k];
  for (size_t k = 0; k < count && status == STATUS_OK; k++)
    if (outputs[k].path != NULL && output_is_standard(outputs[k].path))
      status = write_standard(command, &outputs[k], named > 0);
  if (status != STATUS_OK || named == 0) return status;
  interrupt_defer();
  status = atomic_files_write(files, named, &interrupt_signal, &which, &reason);
  return told(command, files[which].path, status, reason);
}

enum status output_picture(const struct command *command, const struct image *image,
                           const struct image_encoding *encoding, const char *path)
{
  unsigned char *bytes = NULL;
  size_t size;
  char message[IMAGE_MESSAGE_SIZE];
  enum status status = image_encode(image, encoding, &bytes, &size, message);
  if (status != STATUS_OK) command_error(command, "cannot create '%s': %s", path, message);
  else status = output_write(command, &(struct atomic_file){path, bytes, size}, 1);
  free(bytes);
  return status;
}

enum status output_format(const struct command *command, const char *path, enum image_format *out)
{
  if (image_format_of(path, out)) return STATUS_OK;
  const char *base = base_of(path);
  char named[16];
  if (snprintf(named, sizeof named, "a%s", base) < (int)sizeof named && image_format_of(named, out))
    return command_usage(command, "'%s' is a suffix without a name before it", path);
  return command_usage(command, "'%s' ends neither in .png nor in .exr", path);
}

enum status output_spare(const struct command *command, const char *path, const char *other)
{
  if (path == NULL || other == NULL) return STATUS_OK;
  const char *file = output_is_standard(path) && !output_is_standard(other) ? "/dev/stdout" : path;
  if (strcmp(file, other) != 0 && !input_same(file, other)) return STATUS_OK;
  return command_usage(command, "'%s' and '%s' are the same file", file, other);
}

enum status output_spare_input(const struct command *command, const char *path, const char *input)
{
  const enum status status = output_spare(command, path, input);
  return status == STATUS_OK && !output_is_standard(input) ? output_spare(command, "-", input) : status;
}

char *output_name(const char *scene, const char *suffix)
{
  const char *base = base_of(scene), *dot = strrchr(base, '.');
  if (output_is_standard(scene)) suffix = "";
  const size_t length = dot == NULL || dot == base ? strlen(scene) : (size_t)(dot - scene);
  const size_t suffix_size = strlen(suffix) + 1;
  char *name = malloc(length + suffix_size);
  if (name != NULL) {
    memcpy(name, scene, length);
    memcpy(name + length, suffix, suffix_size);
  }
  return name;
}

/* Whether one of the files may be written; prints the error if not. */
static enum status check_file(const struct command *command, const struct scene_request *request,
                              const struct scene *scene, const char *folder, const char *name)
{
  struct text_buffer path = {0};
  text_buffer_format(&path, "%s/%s", folder, name);
  enum status status = path.failed ? command_out_of_memory(command)
                                   : scene_file_spare(command, request, scene, path.text);
  if (status == STATUS_OK) status = output_probe(command, path.text);
  text_buffer_free(&path);
  return status;
}

static enum status make_folder(const struct command *command, const char *path, bool *out_made)
{
  struct stat state;
  *out_made = mkdir(path, 0777) == 0;
  if (*out_made || (errno == EEXIST && stat(path, &state) == 0 && S_ISDIR(state.st_mode))) return STATUS_OK;
  command_error(command, "cannot create the folder '%s': %s", path, strerror(errno));
  return STATUS_FILE;
}

enum status output_folder_fill(const struct command *command, const struct output_folder *folder,
                               const struct scene_request *request,
                               enum status work(void *context, const struct output_job *job), void *context)
{
  struct command_ear ear = {command, request->quiet};
  const struct listener listener = command_listener(&ear);
  struct text_buffer text = {0};
  const char *scene = output_is_standard(request->path) ? "stdin" : base_of(request->path);
  char *owned = folder->path == NULL ? output_name(scene, folder->suffix) : NULL;
  struct output_job job = {
    .folder = folder->path == NULL ? owned : folder->path, .listener = &listener, .out_text = &text};
  bool made = false;
  enum status status = job.folder == NULL ? command_out_of_memory(command) : make_folder(command, job.folder, &made);
  if (status == STATUS_OK) {
    const struct seconds start = seconds_now();
    interrupt_defer();
    status = scene_file_load(command, request, &job.scene);
    job.parse = seconds_since(start);
    for (size_t k = 0; k < folder->file_count && status == STATUS_OK; k++)
      status = check_file(command, request, job.scene, job.folder, folder->files[k]);
    if (status == STATUS_OK) status = work(context, &job);
    scene_destroy(job.scene);
    if (atomic_load(&interrupt_signal) != 0) status = STATUS_INTERRUPTED;
    const bool done = status == STATUS_OK || status == STATUS_DIFFERENT;
    if (!done && made) (void)rmdir(job.folder); /* fails, as it should, if the folder is not empty */
    interrupt_resume();
    if (done && !request->quiet) {
      text_buffer_add_text(&text, "\n");
      text_buffer_add_printable(&text, job.folder, strlen(job.folder));
      printf("%s/%s shows it\n", text.text, folder->files[folder->file_count - 1]);
      const enum status written = command_finish_output(command);
      status = written == STATUS_OK ? status : written;
    }
  }
  text_buffer_free(&text);
  free(owned);
  return status;
}
