/* Progress of a rendering on stderr: a bar on a terminal, otherwise a line now and then. */
#ifndef PSCN_COMMAND_PROGRESS_H
#define PSCN_COMMAND_PROGRESS_H

#include <stdbool.h>

#include "render/render.h"

struct progress {
  bool terminal;
  double began; /* clock at the start of writing */
  double told;  /* last report, in seconds since rendering or writing began */
};

struct progress progress_start(void);

/* Reports the progress of the rendering if enough time has passed. */
void progress_tell(struct progress *state, const struct render_progress *progress);

/* The same for writing the file: `part` of it is done, 0 to 1. */
void progress_write(struct progress *state, double part);

/* Removes the bar. */
void progress_end(const struct progress *progress);

#endif
