/* Runs a fuzz target on files and on all files of folders, named by whole paths, without libFuzzer. What it says goes
 * nowhere; each input has SECONDS_EACH, so that one that has become slow is seen. Without an input at all it fails. */
#include <dirent.h>
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

#include "target.h"

enum { SECONDS_EACH = 60 };

static size_t inputs;
static FILE *say;

static void run_file(const char *path)
{
  FILE *file = fopen(path, "rb");
  uint8_t *data = NULL;
  size_t size = 0, got;
  assert(file);
  do {
    data = realloc(data, size + 65536);
    assert(data);
    got = fread(data + size, 1, 65536, file);
    size += got;
  } while (got > 0);
  (void)fclose(file);
  (void)fprintf(say, "%s\n", path); /* the last name is that of the input that crashed */
  alarm(SECONDS_EACH);
  (void)LLVMFuzzerTestOneInput(data, size);
  alarm(0);
  free(data);
  inputs++;
}

static void run_folder(const char *folder)
{
  struct dirent **entries;
  const int count = scandir(folder, &entries, NULL, alphasort);
  for (int k = 0; k < count; k++) {
    char path[4096];
    (void)snprintf(path, sizeof path, "%s/%s", folder, entries[k]->d_name);
    if (entries[k]->d_name[0] != '.') run_file(path);
    free(entries[k]);
  }
  if (count >= 0) free(entries);
  else run_file(folder);
}

int main(int argc, char **argv)
{
  const int terminal = dup(STDERR_FILENO), nowhere = open("/dev/null", O_WRONLY);
  say = fdopen(terminal, "w");
  assert(say && nowhere >= 0);
  (void)setvbuf(say, NULL, _IONBF, 0);
  dup2(nowhere, STDOUT_FILENO);
  if (getenv("PSCN_FUZZ_LOUD") == NULL) dup2(nowhere, STDERR_FILENO);
  for (int k = 1; k < argc; k++) run_folder(argv[k]);
  (void)fprintf(say, "%zu inputs\n", inputs);
  return inputs > 0 ? 0 : 1;
}
