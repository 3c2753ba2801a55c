/* Files that appear whole or not at all, several of them together.
 *
 * The bytes go to a file without a name in the folder of the final one, are flushed to the disk, and only then named. A
 * process that is killed leaves nothing behind, except in the instant where it replaces an old file. Whatever fails,
 * the final name keeps what it had, and nothing else stays. A symbolic link is followed when a file is written, and
 * never when one is removed. A name that is a device or a pipe is written to directly, since it cannot be replaced.
 *
 * All functions answer STATUS_FILE, or STATUS_LIMIT where memory is short, with the reason, an errno value, in
 * *out_errno (0 otherwise). Safe on any thread.
 */
#ifndef PSCN_BASE_ATOMIC_FILE_H
#define PSCN_BASE_ATOMIC_FILE_H

#include <stdatomic.h>
#include <stddef.h>

#include "base/status.h"

/* Whether a file of this name could be written now. Leaves nothing behind. For use before long work starts. */
enum status atomic_file_probe(const char *path, int *out_errno) STATUS_MUST_CHECK;

/* One of several files. Without bytes (NULL), there is to be no file and no symbolic link of that name afterwards. */
struct atomic_file {
  const char *path;
  const void *bytes;
  size_t size;
};

/* Writes all files of a result. No file gets its name before all are complete on the disk. If one cannot get its name,
 * those before it become what they were (where the file system has hard links). *out_failed says which failed. If
 * `stop` is not NULL and turns nonzero meanwhile (a signal handler may set it), all is given up: STATUS_INTERRUPTED. A
 * new file gets the permissions that the process's mask gives; an old one keeps its own. */
enum status atomic_files_write(const struct atomic_file *files, size_t count, const atomic_int *stop,
                               size_t *out_failed, int *out_errno) STATUS_MUST_CHECK;

/* Writes one file, under this very name: a symbolic link there is replaced, and what it points to stays. */
enum status atomic_file_put(const struct atomic_file *file, int *out_errno) STATUS_MUST_CHECK;

#endif
