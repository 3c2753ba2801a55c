/* A temporary folder. See scratch.h. */
#define _XOPEN_SOURCE 700 /* nftw */
#include "page/scratch.h"

#include <errno.h>
#include <ftw.h>
#include <stdlib.h>

#include "base/source.h"

enum { OPEN_FOLDERS = 16 };

static int remove_one(const char *path, const struct stat *state, int kind, struct FTW *place)
{
  (void)state, (void)kind, (void)place;
  (void)remove(path);
  return 0;
}

void scratch_remove(const char *folder)
{
  if (folder[0] != '\0') (void)nftw(folder, remove_one, OPEN_FOLDERS, FTW_DEPTH | FTW_PHYS);
}

enum status scratch_create(char out_path[SCRATCH_PATH_SIZE])
{
  const char *place = getenv("TMPDIR");
  const int length = snprintf(out_path, SCRATCH_PATH_SIZE, "%s/pscn-XXXXXX",
                              place == NULL || place[0] != '/' ? "/tmp" : place);
  const bool fits = length < SCRATCH_PATH_SIZE / 2; /* room for the files in it */
  if (fits && mkdtemp(out_path) != NULL) return STATUS_OK;
  if (!fits) errno = ENAMETOOLONG;
  out_path[0] = '\0';
  return STATUS_FILE;
}

void scratch_path(const char *folder, const char *name, char out[SCRATCH_PATH_SIZE])
{
  (void)!snprintf(out, SCRATCH_PATH_SIZE, "%s/%s", folder, name);
}

FILE *scratch_open(const char *folder, const char *name)
{
  char path[SCRATCH_PATH_SIZE];
  scratch_path(folder, name, path);
  return fopen(path, "w");
}

enum status scratch_close(FILE *file)
{
  const bool failed = ferror(file) != 0;
  return fclose(file) == 0 && !failed ? STATUS_OK : STATUS_FILE;
}

struct text_buffer scratch_read(const char *folder, const char *name)
{
  char path[SCRATCH_PATH_SIZE];
  const char *reason;
  struct source *source = NULL;
  scratch_path(folder, name, path);
  struct text_buffer text = {.failed = source_read(path, INPUT_FILE, &source, &reason) == STATUS_LIMIT};
  if (source != NULL) text_buffer_add(&text, source->text, source->length);
  source_destroy(source);
  return text;
}
