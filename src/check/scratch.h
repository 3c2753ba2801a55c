/* A folder of our own for the time of a command, and the files in it. */
#ifndef PSCN_CHECK_SCRATCH_H
#define PSCN_CHECK_SCRATCH_H

#include <stddef.h>
#include <stdio.h>
#include <sys/types.h>

#include "base/status.h"

enum { SCRATCH_PATH_SIZE = 4096 };

/* The folder's path, "" where there is none. It stands in $TMPDIR, or in /tmp, and only we may enter it. A process of
 * ours waits to remove it in case that we are killed. */
struct scratch {
  char path[SCRATCH_PATH_SIZE];
  pid_t keeper; /* that process; 0 where there is none */
  int alive;    /* a pipe to it, which ends when we do */
};

/* STATUS_FILE (errno says why) where it cannot be made. */
enum status scratch_create(struct scratch *out) STATUS_MUST_CHECK;

/* Removes the folder with all that is in it, folders as well. Links are removed, not followed. */
void scratch_remove(struct scratch *scratch);

/* The path of a file in it; `out` holds SCRATCH_PATH_SIZE bytes. A path that is too long is cut off, and then names no
 * file that exists. */
void scratch_path(const struct scratch *scratch, const char *name, char *out);

/* Opens a file of the folder for writing: NULL (errno says why) where that fails. scratch_close answers STATUS_FILE
 * where something was not written. */
FILE *scratch_open(const struct scratch *scratch, const char *name);
enum status scratch_close(FILE *file) STATUS_MUST_CHECK;

/* The bytes of a file in it, with a NUL behind them, owned by the caller (free). STATUS_FILE where it cannot be read,
 * STATUS_LIMIT where memory is short; then *out_text is NULL and *out_length 0. */
enum status scratch_read(const struct scratch *scratch, const char *name, char **out_text,
                         size_t *out_length) STATUS_MUST_CHECK;

#endif
