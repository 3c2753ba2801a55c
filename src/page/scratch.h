/* A temporary folder for one command, and the files in it. A folder is known by its path, SCRATCH_PATH_SIZE bytes. */
#ifndef PSCN_PAGE_SCRATCH_H
#define PSCN_PAGE_SCRATCH_H

#include <stddef.h>
#include <stdio.h>

#include "base/status.h"
#include "base/text_buffer.h"

enum { SCRATCH_PATH_SIZE = 4096 };

/* Makes a folder in $TMPDIR or /tmp that only we may enter. Returns STATUS_FILE (errno says why) if that fails; then
 * the path is "". */
enum status scratch_create(char out_path[SCRATCH_PATH_SIZE]) STATUS_MUST_CHECK;

/* Removes the folder, if the path is not "", and everything in it, subfolders included. Links are removed, not
 * followed. */
void scratch_remove(const char *folder);

/* The path of a file in the folder. A path that is too long is cut, and then names no existing file. */
void scratch_path(const char *folder, const char *name, char out[SCRATCH_PATH_SIZE]);

/* Opens a file in the folder for writing; NULL (errno says why) if that fails. scratch_close returns STATUS_FILE if
 * something was not written. */
FILE *scratch_open(const char *folder, const char *name);
enum status scratch_close(FILE *file) STATUS_MUST_CHECK;

/* A file in the folder; nothing if it cannot be read. */
struct text_buffer scratch_read(const char *folder, const char *name);

#endif
