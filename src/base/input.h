/* The one place that opens files for reading.
 *
 * An input is a regular file or a pipe. Devices, sockets and folders are refused: they have no end, or no bytes, and a
 * reader could wait for ever. Safe on any thread.
 */
#ifndef PSCN_BASE_INPUT_H
#define PSCN_BASE_INPUT_H

#include <stdbool.h>
#include <stddef.h>

/* What may be opened: only files, or also pipes, for whose writer and end the reader waits. */
enum input_kind { INPUT_FILE, INPUT_FILE_OR_PIPE };

/* A descriptor for reading the file at `path`, which the caller closes. -1 if it cannot be read; *out_reason then says
 * why in English words. */
int input_open(const char *path, enum input_kind kind, const char **out_reason);

/* Whether an open file is in this folder, whose name has folder_length bytes (0: the current one), or below it, by
 * whatever links its name has led there. */
bool input_is_below(int file, const char *folder, size_t folder_length);

/* Words of our own for an errno value of opening or reading. They depend on neither the locale nor the system. */
const char *input_reason(int error);

/* Whether both names mean one regular file, by whatever path, link or descriptor. Also true if neither exists yet and
 * both would become the same one. */
bool input_same(const char *first, const char *second);

#endif
