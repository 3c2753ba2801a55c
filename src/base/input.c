/* Opens files for reading. */
#define _XOPEN_SOURCE 700 /* realpath */
#include "base/input.h"

#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

const char *input_reason(int error)
{
  switch (error) {
  case ENOENT: return "there is no such file";
  case ENOTDIR: return "a part of the path is no directory";
  case EACCES: return "permission denied";
  case EISDIR: return "it is a directory";
  case ELOOP: return "too many symbolic links";
  case ENAMETOOLONG: return "the name is too long";
  case EMFILE:
  case ENFILE: return "too many open files";
  case ENOMEM: return "memory is short";
  default: return "it cannot be read";
  }
}

int input_open(const char *path, enum input_kind kind, const char **out_reason)
{
  struct stat info;
  int file = -1;
  *out_reason = NULL;
  if (stat(path, &info) != 0) /* before opening, which may wait, or have effects on a device */
    *out_reason = input_reason(errno);
  else if (S_ISDIR(info.st_mode)) *out_reason = input_reason(EISDIR);
  else if (S_ISFIFO(info.st_mode) && kind == INPUT_FILE) *out_reason = "it is a pipe";
  else if (!S_ISREG(info.st_mode) && !S_ISFIFO(info.st_mode)) *out_reason = "it is a device";
  else if ((file = open(path, O_RDONLY | O_CLOEXEC | O_NOCTTY | (S_ISREG(info.st_mode) ? O_NONBLOCK : 0))) < 0)
    *out_reason = input_reason(errno); /* so as not to wait at a file that is none, such as /proc/kmsg */
  return file;
}

bool input_is_below(int file, const char *folder, size_t folder_length)
{
  char name[64], target[PATH_MAX];
  snprintf(name, sizeof name, "/proc/self/fd/%d", file);
  const ssize_t length = readlink(name, target, sizeof target - 1);
  char *copy = length > 0 ? strndup(folder, folder_length) : NULL;
  char *path = copy == NULL ? NULL : realpath(folder_length == 0 ? "." : copy, NULL);
  bool below = false;
  if (path != NULL) {
    const size_t prefix = strcmp(path, "/") == 0 ? 0 : strlen(path);
    target[length] = '\0';
    below = strncmp(target, path, prefix) == 0 && target[prefix] == '/';
  }
  free(path);
  free(copy);
  return below;
}

/* The folder that a name is in, and where the name in it begins. */
static bool folder_of(const char *path, struct stat *out_info, const char **out_name)
{
  const char *slash = strrchr(path, '/');
  *out_name = slash == NULL ? path : slash + 1;
  if (slash == NULL) return stat(".", out_info) == 0;
  char *folder = strndup(path, (size_t)(*out_name - path));
  const bool found = folder != NULL && stat(folder, out_info) == 0;
  free(folder);
  return found;
}

bool input_same(const char *first, const char *second)
{
  struct stat a, b;
  const char *names[2];
  const bool there = stat(first, &a) == 0;
  if (there != (stat(second, &b) == 0)) return false;
  if (there && !(S_ISREG(a.st_mode) && S_ISREG(b.st_mode))) return false;
  if (!there &&
      !(folder_of(first, &a, &names[0]) && folder_of(second, &b, &names[1]) && strcmp(names[0], names[1]) == 0))
    return false;
  return a.st_dev == b.st_dev && a.st_ino == b.st_ino;
}
