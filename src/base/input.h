/* What is read, wherever it is read from: one place opens it.
 *
 * An input is a regular file or a pipe. Devices, sockets and folders are refused, because they have no end, or no
 * bytes, and what waits for them waits for ever. Safe on any thread.
 */
#ifndef PSCN_BASE_INPUT_H
#define PSCN_BASE_INPUT_H

#include <stdbool.h>

/* What may be opened: files only, or also pipes, whose writer and end are waited for. */
enum input_kind { INPUT_FILE, INPUT_FILE_OR_PIPE };

/* A descriptor for reading what is at `path`, which the caller closes; -1 where it cannot be read, and *out_reason then
 * says why in English words. */
int input_open(const char *path, enum input_kind kind, const char **out_reason);

/* Words of our own for an errno value of opening or reading, which change neither with the locale nor the system. */
const char *input_reason(int error);

/* Whether both names mean one regular file, by whatever path, link or descriptor; also where neither is there yet and
 * both would become the same one. */
bool input_same(const char *first, const char *second);

#endif
