/* Progress of a rendering on stderr: a bar on a terminal, otherwise a line now and then. */
#ifndef PSCN_COMMAND_PROGRESS_H
#define PSCN_COMMAND_PROGRESS_H

#include <stdbool.h>
#include <stdint.h>

struct progress {
  bool terminal;
  double told; /* last report, in seconds since rendering or writing began */
};

struct progress progress_start(void);

/* Report how much is done, 0 to 1, of the rendering or of writing the file, so many seconds after that began, if enough
 * time has passed since the last report. */
void progress_tell(struct progress *state, double seconds, double done, uint64_t rays);
void progress_write(struct progress *state, double seconds, double done);

/* Removes the bar. */
void progress_end(const struct progress *progress);

#endif
