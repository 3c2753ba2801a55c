/* A temporary folder. */
#include "check/scratch.h"

#include <dirent.h>
#include <errno.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/source.h"

enum status scratch_create(struct scratch *out)
{
  const char *place = getenv("TMPDIR");
  const int length = snprintf(out->path, sizeof out->path, "%s/pscn-XXXXXX",
                              place == NULL || place[0] != '/' ? "/tmp" : place);
  if (length < 0 || (size_t)length >= sizeof out->path / 2) { /* room for the files in it */
    out->path[0] = '\0';
    errno = ENAMETOOLONG;
    return STATUS_FILE;
  }
  if (mkdtemp(out->path) != NULL)
    return STATUS_OK;
  out->path[0] = '\0';
  return STATUS_FILE;
}

static void remove_all(const char *path, int depth)
{
  enum { MAX_DEPTH = 16 };
  struct stat state;
  DIR *folder = lstat(path, &state) == 0 && S_ISDIR(state.st_mode) ? opendir(path) : NULL;
  if (folder == NULL) {
    (void)unlink(path);
    return;
  }
  for (const struct dirent *entry; (entry = readdir(folder)) != NULL;) {
    char inner[SCRATCH_PATH_SIZE];
    if (strcmp(entry->d_name, ".") == 0 || strcmp(entry->d_name, "..") == 0)
      continue;
    const int length = snprintf(inner, sizeof inner, "%s/%s", path, entry->d_name);
    if (length > 0 && (size_t)length < sizeof inner && depth < MAX_DEPTH)
      remove_all(inner, depth + 1);
  }
  (void)closedir(folder);
  (void)rmdir(path);
}

void scratch_remove(struct scratch *scratch)
{
  if (scratch->path[0] != '\0')
    remove_all(scratch->path, 0);
  scratch->path[0] = '\0';
}

void scratch_path(const struct scratch *scratch, const char *name, char *out)
{
  const size_t length = strlen(scratch->path);
  memcpy(out, scratch->path, length);
  snprintf(out + length, SCRATCH_PATH_SIZE - length, "/%s", name);
}

FILE *scratch_open(const struct scratch *scratch, const char *name)
{
  char path[SCRATCH_PATH_SIZE];
  scratch_path(scratch, name, path);
  return fopen(path, "w");
}

enum status scratch_close(FILE *file)
{
  const bool failed = ferror(file) != 0;
  return fclose(file) == 0 && !failed ? STATUS_OK : STATUS_FILE;
}

char *scratch_read(const struct scratch *scratch, const char *name, size_t *out_length)
{
  char path[SCRATCH_PATH_SIZE];
  const char *reason;
  struct source *source = NULL;
  scratch_path(scratch, name, path);
  if (source_read(path, INPUT_FILE, &source, &reason) != STATUS_OK)
    return NULL;
  char *text = source->text;
  *out_length = source->length;
  source->text = NULL;
  source_destroy(source);
  return text;
}
