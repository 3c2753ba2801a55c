/* A picture on its way into its file: what is done of it is kept meanwhile, and gone on with where an earlier run was
 * ended; in the end it is written, and its statistics.
 *
 * Errors are told on stderr. One at a time, from the main thread: a signal ends it (interrupt.h).
 */
#ifndef PSCN_COMMAND_RENDERING_H
#define PSCN_COMMAND_RENDERING_H

#include "base/status.h"
#include "command/command.h"
#include "command/scene_file.h"
#include "image/image_file.h"
#include "render/render.h"

/* All of it borrowed. */
struct rendering_request {
  const struct scene_request *scene;
  struct render_options options; /* but for the tiles */
  enum image_format format;
  size_t bits;          /* of a value */
  const char *output;   /* the picture's file */
  const char *part;     /* where what is done is kept while it is not all; NULL: nowhere */
  const char *stats;    /* where statistics go; NULL: nowhere */
  const char *channels; /* those of `options`, as on the command line, ... */
  const char *how;      /* ... and what else says there how the scene is read */
  size_t piece, pieces; /* only piece `piece` of so many, from 1; 0, 0: the whole picture */
  bool resume;          /* go on with what `part` has */
  double checkpoint;    /* seconds after which what is done is kept; 0: never */
};

/* STATUS_USAGE, told, where one of the files would overwrite another one, or what the scene is read from; `scene` NULL: as
 * far as that is known before it is read. */
enum status rendering_check_outputs(const struct command *command, const struct rendering_request *request,
                                    const struct scene *scene) STATUS_MUST_CHECK;

/* Reads the scene, renders and writes. STATUS_INTERRUPTED where a signal came: then `part` has what is done. */
enum status rendering_make(const struct command *command, const struct rendering_request *request) STATUS_MUST_CHECK;

#endif
