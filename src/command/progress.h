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

/* The progress function of struct render_watch; its context is a struct progress. */
void progress_tell(void *context, const struct render_progress *progress);

/* The same for the file that is written: which part of it there is. */
void progress_write(void *context, double part);

/* Removes the bar. */
void progress_end(const struct progress *progress);

#endif
