/* Files that appear whole or not at all, and several together.
 *
 * The bytes are written to a file without a name in the folder of the final one, flushed to the disk, and named then:
 * a process that is killed leaves nothing, but for an instant where it replaces an old file.
 * Whatever goes wrong, the final name keeps what it had and nothing else stays. A symbolic link is
 * followed. A name that is a device or a pipe is written to directly, since it can not be replaced.
 *
 * All functions answer STATUS_FILE, or STATUS_LIMIT where memory is short, with the reason, an errno value, in
 * *out_errno (0 otherwise). Safe on any thread.
 */
#ifndef PSCN_BASE_ATOMIC_FILE_H
#define PSCN_BASE_ATOMIC_FILE_H

#include <stdatomic.h>
#include <stddef.h>

#include "base/status.h"

/* Whether a file of this name could be written now; leaves nothing behind. To be asked before long work starts. */
enum status atomic_file_probe(const char *path, int *out_errno) STATUS_MUST_CHECK;

/* One of several files. Without bytes (NULL) there is to be none of that name afterwards, and no symbolic link. */
struct atomic_file {
  const char *path;
  const void *bytes;
  size_t size;
};

/* Writes all files of a result: none gets its name before each is complete on the disk, and where one cannot get it,
 * those before it become again what they were (where the file system has hard links). *out_failed: which it was. Where
 * `stop` is not NULL and turns nonzero meanwhile (a signal handler may set it), all is given up: STATUS_INTERRUPTED. A
 * new file gets the permissions the process's mask gives, an old one keeps its own. */
enum status atomic_files_write(const struct atomic_file *files, size_t count, const atomic_int *stop,
                               size_t *out_failed, int *out_errno) STATUS_MUST_CHECK;

#endif
