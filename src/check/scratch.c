/* A temporary folder. */
#define _XOPEN_SOURCE 700 /* for nftw */
#include "check/scratch.h"

#include <errno.h>
#include <ftw.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/source.h"

enum { OPEN_FOLDERS = 16 };

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
  if (mkdtemp(out->path) != NULL) return STATUS_OK;
  out->path[0] = '\0';
  return STATUS_FILE;
}

static int remove_one(const char *path, const struct stat *state, int kind, struct FTW *place)
{
  (void)state, (void)kind, (void)place;
  (void)remove(path);
  return 0;
}

void scratch_remove(struct scratch *scratch)
{
  if (scratch->path[0] != '\0') (void)nftw(scratch->path, remove_one, OPEN_FOLDERS, FTW_DEPTH | FTW_PHYS);
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

enum status scratch_read(const struct scratch *scratch, const char *name, char **out_text, size_t *out_length)
{
  char path[SCRATCH_PATH_SIZE];
  const char *reason;
  struct source *source = NULL;
  scratch_path(scratch, name, path);
  *out_text = NULL;
  *out_length = 0;
  const enum status status = source_read(path, INPUT_FILE, &source, &reason);
  if (status != STATUS_OK) return status;
  *out_text = source->text;
  *out_length = source->length;
  source->text = NULL;
  source_destroy(source);
  return STATUS_OK;
}
