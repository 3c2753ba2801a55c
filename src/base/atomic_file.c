/* Files that appear whole or not at all: a file without a name in the same folder, fsync, link, rename. Where the file
 * system has only files with names, the file has one from the beginning that nobody can guess. */
#define _GNU_SOURCE /* O_TMPFILE, realpath */
#include "base/atomic_file.h"

#include <errno.h>
#include <fcntl.h>
#include <inttypes.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/random.h>
#include <sys/stat.h>
#include <sys/types.h>
#include <unistd.h>

enum {
  CHUNK = 1 << 20,    /* bytes written between two checks of `stop` */
  NAME_ATTEMPTS = 10, /* temporary names tried, of 2^64: one is enough, except where somebody guesses */
  NAME_SPACE = 64     /* room for the temporary file's own name, "/.pscn-" + 16 digits + ".tmp" */
};

/* The state of the final name before writing. */
struct target {
  char *path; /* with symbolic links resolved, unless the name itself is meant; owned */
  bool exists;
  bool replaceable; /* absent, or a regular file */
  mode_t mode;
};

/* The directory part of path, "." if there is none, with NAME_SPACE bytes to spare. NULL where memory is short. */
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

/* Fills the target. Unless links are followed, one is a name like that of a file. Returns 0, or an errno value, and
 * then nothing is owned. */
static int target_find(const char *path, bool follow, struct target *out)
{
  struct stat info;
  *out = (struct target){.replaceable = true};
  if ((follow ? stat : lstat)(path, &info) != 0) {
    if (errno != ENOENT || path[0] == '\0') return errno;
    if (lstat(path, &info) == 0) return ENOENT; /* a link to nothing: creating its target is not our business */
    out->path = strdup(path);
    return out->path == NULL ? ENOMEM : 0;
  }
  if (S_ISDIR(info.st_mode)) return EISDIR;
  const bool link = S_ISLNK(info.st_mode);
  if (!link && access(path, W_OK) != 0) return errno;
  out->exists = true;
  out->replaceable = link || S_ISREG(info.st_mode);
  out->mode = link ? 0600 : info.st_mode & 07777;
  out->path = follow ? realpath(path, NULL) : strdup(path);
  return out->path == NULL ? errno : 0;
}

/* A file that replaces another can be read by nobody else until it gets the old one's permissions, before its name. */
static mode_t first_mode(const struct target *target) { return target->exists ? 0600 : 0666; }

/* A file without a name in the target's folder: its descriptor, or -1 with errno set, to EOPNOTSUPP if the file system
 * has no such files. Naming it goes through /proc. */
static int unnamed_open(const struct target *target)
{
  char *directory = directory_of(target->path);
  int descriptor = -1;
  errno = ENOMEM;
  if (directory != NULL && access("/proc/self/fd", X_OK) != 0) errno = EOPNOTSUPP;
  else if (directory != NULL) descriptor = open(directory, O_TMPFILE | O_WRONLY | O_CLOEXEC, first_mode(target));
  const int reason = errno == EISDIR || errno == EINVAL ? EOPNOTSUPP : errno;
  free(directory);
  errno = reason;
  return descriptor;
}

/* Makes a new name next to the target: of the file `same`, by linkat's flags, or, if that is NULL, of a new file, with
 * its descriptor in *out_descriptor. Returns the name, owned by the caller, or NULL with errno set. */
static char *temporary_name(const struct target *target, const char *same, int flags, int *out_descriptor)
{
  char *name = directory_of(target->path);
  int reason = ENOMEM;
  for (int attempt = 0; name != NULL && attempt < NAME_ATTEMPTS; attempt++) {
    uint64_t number;
    if (getrandom(&number, sizeof number, 0) != (ssize_t)sizeof number) {
      reason = errno;
      break;
    }
    char *end = name + (attempt == 0 ? strlen(name) : (size_t)(strrchr(name, '/') - name));
    snprintf(end, NAME_SPACE, "/.pscn-%016" PRIx64 ".tmp", number);
    const int made = same != NULL
                       ? linkat(AT_FDCWD, same, AT_FDCWD, name, flags)
                       : (*out_descriptor = open(name, O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, first_mode(target)));
    if (made >= 0) return name;
    reason = errno;
    if (reason != EEXIST) break;
  }
  free(name);
  errno = reason;
  return NULL;
}

static enum status write_all(int descriptor, const unsigned char *bytes, size_t size, const atomic_int *stop,
                             int *out_errno)
{
  for (size_t done = 0; done < size;) {
    if (stop != NULL && atomic_load(stop) != 0) return STATUS_INTERRUPTED;
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

/* Makes the new name in the folder durable. The file itself is safe already, so a folder that cannot be synced is no
 * error. */
static void sync_directory(const char *path)
{
  char *directory = directory_of(path);
  if (directory == NULL) return;
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
  int descriptor;
  do { /* waits here while nobody reads a pipe */
    if (stop != NULL && atomic_load(stop) != 0) return STATUS_INTERRUPTED;
    descriptor = open(target->path, O_WRONLY | O_CLOEXEC);
  } while (descriptor < 0 && errno == EINTR);
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

/* A file on its way to its name. */
struct staged {
  struct target target;
  int descriptor; /* of the new file, complete and on the disk; -1 if there is none */
  char *fresh;    /* its name so far, or NULL; owned, as is `old` */
  char *old;      /* another name of the old file, in case a later file fails; or NULL */
  bool placed;    /* the final name has its final state */
};

/* Writes the new file, next to the final name. */
static enum status stage_bytes(const struct atomic_file *file, const atomic_int *stop, struct staged *out,
                               int *out_errno)
{
  const struct target *target = &out->target;
  out->descriptor = unnamed_open(target);
  if (out->descriptor < 0 && errno == EOPNOTSUPP) out->fresh = temporary_name(target, NULL, 0, &out->descriptor);
  if (out->descriptor < 0) {
    *out_errno = errno;
    return STATUS_FILE;
  }
  const enum status status = write_all(out->descriptor, file->bytes, file->size, stop, out_errno);
  if (status != STATUS_OK || ((!target->exists || fchmod(out->descriptor, target->mode) == 0) &&
                              (fsync(out->descriptor) == 0 || errno == EINVAL))) /* EINVAL: a file system without it */
    return status;
  *out_errno = errno;
  return STATUS_FILE;
}

static enum status stage(const struct atomic_file *file, bool follow, const atomic_int *stop, struct staged *out,
                         int *out_errno)
{
  *out_errno = target_find(file->path, follow && file->bytes != NULL, &out->target);
  if (*out_errno != 0) return STATUS_FILE;
  return file->bytes != NULL && out->target.replaceable ? stage_bytes(file, stop, out, out_errno) : STATUS_OK;
}

/* Gives the new file its name: directly if that is free, otherwise through another name. */
static bool replace(struct staged *staged)
{
  const struct target *target = &staged->target;
  if (staged->fresh == NULL) {
    char self[NAME_SPACE];
    snprintf(self, sizeof self, "/proc/self/fd/%d", staged->descriptor);
    if (!target->exists && linkat(AT_FDCWD, self, AT_FDCWD, target->path, AT_SYMLINK_FOLLOW) == 0) return true;
    staged->fresh = temporary_name(target, self, AT_SYMLINK_FOLLOW, NULL);
  }
  return staged->fresh != NULL && rename(staged->fresh, target->path) == 0;
}

/* Brings the name to its final state. `alone`: no other file can fail after it, so the old one need not be kept. */
static enum status place(const struct atomic_file *file, bool alone, const atomic_int *stop, struct staged *staged,
                         int *out_errno)
{
  const struct target *target = &staged->target;
  if (!target->replaceable)
    return file->bytes == NULL ? STATUS_OK : write_through(target, file->bytes, file->size, stop, out_errno);
  if (target->exists && !alone)
    staged->old = temporary_name(target, target->path, 0, NULL); /* a file system without links keeps none */
  if (file->bytes != NULL) staged->placed = replace(staged);
  else staged->placed = !target->exists || unlink(target->path) == 0 || errno == ENOENT; /* it is gone already */
  if (staged->placed) return STATUS_OK;
  *out_errno = errno;
  return STATUS_FILE;
}

/* Leaves nothing but the final name: with the new state if all went well, otherwise with the old one. */
static void settle(struct staged *staged, bool well)
{
  const bool undo = !well && staged->placed;
  if (staged->old != NULL) (void)(undo ? rename(staged->old, staged->target.path) : unlink(staged->old));
  else if (undo && !staged->target.exists) (void)unlink(staged->target.path);
  if (!staged->placed && staged->fresh != NULL) (void)unlink(staged->fresh);
}

static void staged_free(struct staged *staged)
{
  if (staged->descriptor >= 0) (void)close(staged->descriptor);
  free(staged->target.path);
  free(staged->fresh);
  free(staged->old);
}

static enum status failure(int reason) { return reason == ENOMEM ? STATUS_LIMIT : STATUS_FILE; }

/* Why a file cannot be replaced in its folder, though both may be written: 0, or an errno value. It may be a mount
 * point, as single files in containers are, append-only, or another user's in a sticky folder. */
static int hindrance(const char *path)
{
  int reason = 0;
#if defined(STATX_ATTR_MOUNT_ROOT)
  struct statx file, folder;
  char *directory = directory_of(path);
  if (statx(AT_FDCWD, path, 0, STATX_UID, &file) == 0) {
    const uid_t user = geteuid();
    const bool sticky = directory != NULL && statx(AT_FDCWD, directory, 0, STATX_MODE | STATX_UID, &folder) == 0 &&
                        (folder.stx_mode & S_ISVTX) != 0 && folder.stx_uid != user;
    if ((file.stx_attributes & STATX_ATTR_MOUNT_ROOT) != 0) reason = EBUSY;
    else if ((file.stx_attributes & STATX_ATTR_APPEND) != 0 || (sticky && user != 0 && file.stx_uid != user))
      reason = EPERM;
  }
  free(directory);
#else
  (void)path;
#endif
  return reason;
}

enum status atomic_file_probe(const char *path, int *out_errno)
{
  struct target target;
  *out_errno = target_find(path, true, &target);
  if (*out_errno == 0 && target.exists && target.replaceable) *out_errno = hindrance(target.path);
  if (*out_errno != 0) {
    free(target.path);
    return failure(*out_errno);
  }
  if (target.replaceable) {
    const int descriptor = unnamed_open(&target);
    char *directory = descriptor < 0 && errno == EOPNOTSUPP ? directory_of(target.path) : NULL;
    if (descriptor < 0 && (directory == NULL || access(directory, W_OK | X_OK) != 0)) *out_errno = errno;
    if (descriptor >= 0) (void)close(descriptor);
    free(directory);
  }
  free(target.path);
  return *out_errno == 0 ? STATUS_OK : failure(*out_errno);
}

static enum status write_files(const struct atomic_file *files, size_t count, bool follow, const atomic_int *stop,
                               size_t *out_failed, int *out_errno)
{
  struct staged *staged = calloc(count + 1, sizeof *staged);
  enum status status = staged == NULL ? STATUS_LIMIT : STATUS_OK;
  *out_failed = 0;
  *out_errno = staged == NULL ? ENOMEM : 0;
  for (size_t k = 0; staged != NULL && k < count; k++) staged[k].descriptor = -1;
  for (size_t k = 0; k < count && status == STATUS_OK; k++) {
    *out_failed = k;
    status = stage(&files[k], follow, stop, &staged[k], out_errno);
  }
  if (status == STATUS_OK && stop != NULL && atomic_load(stop) != 0) status = STATUS_INTERRUPTED;
  for (size_t k = 0; k < count && status == STATUS_OK; k++) {
    *out_failed = k;
    status = place(&files[k], count == 1, stop, &staged[k], out_errno);
  }
  /* Other names are removed before waiting for the disk, so a process killed during that leaves none. */
  for (size_t k = 0; staged != NULL && k < count; k++) settle(&staged[k], status == STATUS_OK);
  for (size_t k = 0; staged != NULL && k < count; k++) {
    if (status == STATUS_OK && staged[k].placed) sync_directory(staged[k].target.path);
    staged_free(&staged[k]);
  }
  free(staged);
  return status == STATUS_FILE ? failure(*out_errno) : status;
}

enum status atomic_files_write(const struct atomic_file *files, size_t count, const atomic_int *stop,
                               size_t *out_failed, int *out_errno)
{
  return write_files(files, count, true, stop, out_failed, out_errno);
}

enum status atomic_file_put(const struct atomic_file *file, int *out_errno)
{
  size_t failed;
  return write_files(file, 1, false, NULL, &failed, out_errno);
}
