/* Where results go. */
#include "command/output.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "base/atomic_file.h"
#include "base/input.h"
#include "command/interrupt.h"

/* What follows the last slash. */
static const char *base_of(const char *path)
{
  const char *slash = strrchr(path, '/');
  return slash == NULL ? path : slash + 1;
}

bool output_is_standard(const char *path) { return strcmp(path, "-") == 0; }

enum status output_probe(const struct command *command, const char *path)
{
  if (path == NULL || output_is_standard(path))
    return STATUS_OK;
  int reason;
  const enum status status = atomic_file_probe(path, &reason);
  return command_written(command, path, status, reason);
}

enum status output_write(const struct command *command, const char *path, const void *bytes, size_t size)
{
  if (path == NULL)
    return STATUS_OK;
  if (output_is_standard(path)) {
    (void)fwrite(bytes, 1, size, stdout);
    return command_finish_output(command);
  }
  interrupt_defer();
  int reason;
  const enum status status = atomic_file_write(path, bytes, size, &interrupt_signal, &reason);
  return command_written(command, path, status, reason);
}

enum status output_format(const struct command *command, const char *path, enum image_format *out)
{
  if (image_format_of(path, out))
    return STATUS_OK;
  const char *base = base_of(path);
  char named[16];
  if (snprintf(named, sizeof named, "a%s", base) < (int)sizeof named && image_format_of(named, out))
    return (enum status)command_usage(command, "'%s' is a suffix without a name before it", path);
  return (enum status)command_usage(command, "'%s' ends neither in .png nor in .exr", path);
}

enum status output_spare(const struct command *command, const char *path, const char *other)
{
  if (path == NULL || other == NULL || !(strcmp(path, other) == 0 || input_same(path, other)))
    return STATUS_OK;
  return (enum status)command_usage(command, "'%s' and '%s' are one file and must be two", path, other);
}

char *output_name(const char *scene, const char *suffix)
{
  const char *base = base_of(scene), *dot = strrchr(base, '.');
  if (output_is_standard(scene))
    suffix = "";
  const size_t length = dot == NULL || dot == base ? strlen(scene) : (size_t)(dot - scene);
  const size_t suffix_size = strlen(suffix) + 1;
  char *name = malloc(length + suffix_size);
  if (name != NULL) {
    memcpy(name, scene, length);
    memcpy(name + length, suffix, suffix_size);
  }
  return name;
}

char *output_folder_name(const char *scene, const char *suffix) { return output_name(base_of(scene), suffix); }

enum status output_folder_make(const struct command *command, const char *folder, bool *out_made)
{
  struct stat state;
  *out_made = mkdir(folder, 0777) == 0;
  if (*out_made || (errno == EEXIST && stat(folder, &state) == 0 && S_ISDIR(state.st_mode)))
    return STATUS_OK;
  command_error(command, "cannot make the folder '%s': %s", folder, strerror(errno));
  return STATUS_FILE;
}
