/* Progress of a rendering on stderr: a bar where it is a terminal, else a line now and then. */
#ifndef PSCN_COMMAND_PROGRESS_H
#define PSCN_COMMAND_PROGRESS_H

#include <stdbool.h>

#include "render/render.h"

struct progress {
  bool terminal;
  double began; /* of writing, by the clock */
  double told;  /* when it was last told, seconds since the rendering or the writing began */
};

struct progress progress_start(void);

/* Tells how far the rendering is, where it is time to. */
void progress_tell(struct progress *state, const struct render_progress *progress);

/* The same for the file that is written: which part of it there is, 0 to 1. */
void progress_write(struct progress *state, double part);

/* Removes the bar. */
void progress_end(const struct progress *progress);

#endif
