/* Default names and folders of results. */
#include "command/output.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

/* What follows the last slash. */
static const char *base_of(const char *path)
{
  const char *slash = strrchr(path, '/');
  return slash == NULL ? path : slash + 1;
}

char *output_name(const char *scene, const char *suffix)
{
  const char *base = base_of(scene), *dot = strrchr(base, '.');
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
