/* Files that appear whole or not at all: temporary file in the same folder, fsync, rename. */
#define _XOPEN_SOURCE 700 /* for realpath, which glibc keeps behind it */
#include "base/atomic_file.h"

#include <errno.h>
#include <fcntl.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/types.h>
#include <unistd.h>

enum {
  CHUNK = 1 << 20,      /* bytes written between two looks at `stop` */
  NAME_ATTEMPTS = 1000, /* temporary names tried: others may stem from a killed process with our number */
  NAME_SPACE = 64       /* room for the temporary file's own name, at most "/.pscn-" + two numbers + ".tmp" */
};

/* What the final name is before we write. */
struct target {
  char *path;     /* with symbolic links resolved; owned */
  bool exists;
  bool replaceable; /* absent, or a regular file */
  mode_t mode;
};

/* The directory part of path, "." where there is none, with NAME_SPACE bytes to spare. NULL where memory is short. */
static char *directory_of(const char *path)
{
  const char *slash = strrchr(path, '/');
  const char *start = slash == NULL ? "." : slash == path ? "/" : path;
  const size_t length = slash == NULL || slash == path ? 1 : (size_t)(slash - path);
  char *directory = malloc(length + NAME_SPACE);
  if (directory != NULL) {
    memcpy(directory, start, length);
    directory[length] = '\0';
  }
  return directory;
}

/* Fills the target; 0 or an errno value, and then nothing is owned. */
static int target_find(const char *path, struct target *out)
{
  struct stat info;
  *out = (struct target){ .replaceable = true };
  if (stat(path, &info) != 0) {
    if (errno != ENOENT || path[0] == '\0')
      return errno;
    if (lstat(path, &info) == 0)
      return ENOENT; /* a link to nothing: its target is not ours to invent */
    out->path = strdup(path);
    return out->path == NULL ? ENOMEM : 0;
  }
  if (S_ISDIR(info.st_mode))
    return EISDIR;
  if (access(path, W_OK) != 0)
    return errno;
  out->exists = true;
  out->replaceable = S_ISREG(info.st_mode);
  out->mode = info.st_mode & 07777;
  out->path = realpath(path, NULL);
  return out->path == NULL ? errno : 0;
}

/* Creates a new file next to `path`. Answers its descriptor, or -1 with errno set; *out_name is owned by the caller. */
static int temporary_open(const char *path, char **out_name)
{
  *out_name = NULL;
  char *name = directory_of(path);
  if (name == NULL) {
    errno = ENOMEM;
    return -1;
  }
  char *end = name + strlen(name);
  for (int attempt = 0; attempt < NAME_ATTEMPTS; attempt++) {
    snprintf(end, NAME_SPACE, "/.pscn-%ld-%d.tmp", (long)getpid(), attempt);
    const int descriptor = open(name, O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    if (descriptor >= 0) {
      *out_name = name;
      return descriptor;
    }
    if (errno != EEXIST)
      break;
  }
  const int reason = errno;
  free(name);
  errno = reason;
  return -1;
}

static enum status write_all(int descriptor, const unsigned char *bytes, size_t size, const atomic_int *stop,
                             int *out_errno)
{
  for (size_t done = 0; done < size;) {
    if (stop != NULL && atomic_load(stop) != 0)
      return STATUS_INTERRUPTED;
    const size_t left = size - done;
    const ssize_t written = write(descriptor, bytes + done, left < CHUNK ? left : CHUNK);
    if (written > 0) {
      done += (size_t)written;
    } else if (written == 0 || errno != EINTR) {
      *out_errno = written == 0 ? EIO : errno;
      return STATUS_FILE;
    }
  }
  return STATUS_OK;
}

/* Makes the new name in the folder durable. The file itself is safe already, so a folder that can not be synced is no
 * error. */
static void sync_directory(const char *path)
{
  char *directory = directory_of(path);
  if (directory == NULL)
    return;
  const int descriptor = open(directory, O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (descriptor >= 0) {
    (void)fsync(descriptor);
    (void)close(descriptor);
  }
  free(directory);
}

static enum status write_through(const struct target *target, const unsigned char *bytes, size_t size,
                                 const atomic_int *stop, int *out_errno)
{
  const int descriptor = open(target->path, O_WRONLY | O_CLOEXEC);
  if (descriptor < 0) {
    *out_errno = errno;
    return STATUS_FILE;
  }
  enum status status = write_all(descriptor, bytes, size, stop, out_errno);
  if (close(descriptor) != 0 && status == STATUS_OK) {
    *out_errno = errno;
    status = STATUS_FILE;
  }
  return status;
}

static enum status write_replacing(const struct target *target, const unsigned char *bytes, size_t size,
                                   const atomic_int *stop, int *out_errno)
{
  char *name = NULL;
  int descriptor = temporary_open(target->path, &name);
  if (descriptor < 0) {
    *out_errno = errno;
    return STATUS_FILE;
  }
  enum status status = write_all(descriptor, bytes, size, stop, out_errno);
  if (status != STATUS_OK)
    goto done;
  status = STATUS_FILE;
  if (target->exists && fchmod(descriptor, target->mode) != 0)
    goto failed;
  if (fsync(descriptor) != 0 && errno != EINVAL) /* EINVAL: a file system without it */
    goto failed;
  const int closed = close(descriptor);
  descriptor = -1;
  if (closed != 0)
    goto failed;
  if (stop != NULL && atomic_load(stop) != 0) {
    status = STATUS_INTERRUPTED;
    goto done;
  }
  if (rename(name, target->path) != 0)
    goto failed;
  sync_directory(target->path);
  free(name);
  return STATUS_OK;

failed:
  *out_errno = errno;
done:
  if (descriptor >= 0)
    (void)close(descriptor);
  (void)unlink(name);
  free(name);
  return status;
}

static enum status failure(int reason) { return reason == ENOMEM ? STATUS_LIMIT : STATUS_FILE; }

enum status atomic_file_probe(const char *path, int *out_errno)
{
  struct target target;
  *out_errno = target_find(path, &target);
  if (*out_errno != 0)
    return failure(*out_errno);
  if (target.replaceable) {
    char *name = NULL;
    const int descriptor = temporary_open(target.path, &name);
    if (descriptor >= 0) {
      (void)close(descriptor);
      (void)unlink(name);
      free(name);
    } else {
      *out_errno = errno;
    }
    /* A name too long for the file system shows only when it is made, so ask for it itself. */
    if (*out_errno == 0 && !target.exists && access(target.path, F_OK) != 0 && errno != ENOENT)
      *out_errno = errno;
  }
  free(target.path);
  return *out_errno == 0 ? STATUS_OK : failure(*out_errno);
}

enum status atomic_file_write(const char *path, const void *bytes, size_t size, const atomic_int *stop,
                              int *out_errno)
{
  struct target target;
  *out_errno = target_find(path, &target);
  if (*out_errno != 0)
    return failure(*out_errno);
  const enum status status = (target.replaceable ? write_replacing : write_through)(&target, bytes, size, stop,
                                                                                     out_errno);
  free(target.path);
  return status == STATUS_FILE ? failure(*out_errno) : status;
}
