/* A temporary folder for one command, and the files in it. */
#ifndef PSCN_PAGE_SCRATCH_H
#define PSCN_PAGE_SCRATCH_H

#include <stddef.h>
#include <stdio.h>
#include <sys/types.h>

#include "base/status.h"

enum { SCRATCH_PATH_SIZE = 4096 };

/* The folder is in $TMPDIR or /tmp, and only we may enter it; path is "" if there is none. A process of ours waits to
 * remove it if we are killed. */
struct scratch {
  char path[SCRATCH_PATH_SIZE];
  pid_t keeper; /* that process; 0: none */
  int alive;    /* a pipe to it, which closes when we end */
};

/* Returns STATUS_FILE (errno says why) if the folder cannot be made. */
enum status scratch_create(struct scratch *out) STATUS_MUST_CHECK;

/* Removes the folder and everything in it, subfolders included. Links are removed, not followed. */
void scratch_remove(struct scratch *scratch);

/* The path of a file in the folder; `out` holds SCRATCH_PATH_SIZE bytes. A path that is too long is cut, and then names
 * no existing file. */
void scratch_path(const struct scratch *scratch, const char *name, char *out);

/* Opens a file in the folder for writing; NULL (errno says why) if that fails. scratch_close returns STATUS_FILE if
 * something was not written. */
FILE *scratch_open(const struct scratch *scratch, const char *name);
enum status scratch_close(FILE *file) STATUS_MUST_CHECK;

/* Reads a file in the folder: its bytes, followed by a NUL, which the caller frees. Returns STATUS_FILE if it cannot be
 * read, STATUS_LIMIT if memory is short; then *out_text is NULL and *out_length 0. */
enum status scratch_read(const struct scratch *scratch, const char *name, char **out_text,
                         size_t *out_length) STATUS_MUST_CHECK;

#endif
