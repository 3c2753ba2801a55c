/* A temporary folder. See scratch.h. */
#define _GNU_SOURCE /* nftw, MAP_ANONYMOUS */
#include "page/scratch.h"

#include <errno.h>
#include <fcntl.h>
#include <ftw.h>
#include <signal.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#include "base/source.h"

enum {
  OPEN_FOLDERS = 16,
  REMOVALS = 100,              /* the keeper's tries, while the system ends the program that wrote in the folder, */
  PAUSE_NANOSECONDS = 10000000 /* and the time between them */
};

static int remove_one(const char *path, const struct stat *state, int kind, struct FTW *place)
{
  (void)state, (void)kind, (void)place;
  (void)remove(path);
  return 0;
}

static void remove_all(const char *path) { (void)nftw(path, remove_one, OPEN_FOLDERS, FTW_DEPTH | FTW_PHYS); }

/* Waits for the pipe to close, when no process is left that could remove the folder. `path` is as far as it is
 * known. */
static void keep(int alive, const char *path)
{
  const struct timespec pause = {.tv_nsec = PAUSE_NANOSECONDS};
  char none;
  (void)setpgid(0, 0); /* the terminal's signals are not for us */
  while (read(alive, &none, 1) < 0 && errno == EINTR) continue;
  for (int k = 0; k < REMOVALS && access(path, F_OK) == 0; k++, (void)nanosleep(&pause, NULL)) remove_all(path);
  _exit(0);
}

/* Without a keeper, for which memory may be short, the folder stays if we are killed. */
static void start_keeper(struct scratch *scratch, const char *path)
{
  int ends[2];
  if (pipe(ends) != 0) return;
  (void)fcntl(ends[0], F_SETFD, FD_CLOEXEC);
  (void)fcntl(ends[1], F_SETFD, FD_CLOEXEC);
  scratch->keeper = fork();
  if (scratch->keeper == 0) {
    (void)close(ends[1]);
    keep(ends[0], path);
  }
  (void)close(ends[0]);
  scratch->alive = ends[1];
  if (scratch->keeper < 0) {
    scratch->keeper = 0;
    (void)close(ends[1]);
  }
}

static void end_keeper(struct scratch *scratch)
{
  if (scratch->keeper == 0) return;
  (void)kill(scratch->keeper, SIGKILL);
  while (waitpid(scratch->keeper, NULL, 0) < 0 && errno == EINTR) continue;
  (void)close(scratch->alive);
  scratch->keeper = 0;
}

/* The keeper starts first. It reads the name from shared memory, into which mkdtemp writes it before making the folder,
 * so that the folder always has an owner. */
enum status scratch_create(struct scratch *out)
{
  const char *place = getenv("TMPDIR");
  out->keeper = 0;
  const int length = snprintf(out->path, sizeof out->path, "%s/pscn-XXXXXX",
                              place == NULL || place[0] != '/' ? "/tmp" : place);
  const bool fits = length >= 0 && (size_t)length < sizeof out->path / 2; /* room for the files in it */
  char *shared = mmap(NULL, sizeof out->path, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
  if (fits && shared != MAP_FAILED) {
    memcpy(shared, out->path, sizeof out->path);
    start_keeper(out, shared);
  }
  const bool made = fits && mkdtemp(out->keeper != 0 ? shared : out->path) != NULL;
  const int reason = fits ? errno : ENAMETOOLONG;
  if (out->keeper != 0) memcpy(out->path, shared, sizeof out->path);
  if (shared != MAP_FAILED) (void)munmap(shared, sizeof out->path);
  if (made) return STATUS_OK;
  end_keeper(out);
  out->path[0] = '\0';
  errno = reason;
  return STATUS_FILE;
}

void scratch_remove(struct scratch *scratch)
{
  if (scratch->path[0] == '\0') return;
  remove_all(scratch->path);
  scratch->path[0] = '\0';
  end_keeper(scratch);
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
