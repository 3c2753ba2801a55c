/* From a scene to the picture's file. The part that is done is kept on the way, and work continues from what an earlier
 * run has kept. At the end the picture and its statistics are written.
 *
 * Errors are printed to stderr. One rendering at a time, from the main thread; a signal ends it (interrupt.h).
 */
#ifndef PSCN_COMMAND_RENDERING_H
#define PSCN_COMMAND_RENDERING_H

#include "base/status.h"
#include "command/command.h"
#include "command/scene_file.h"
#include "image/image_file.h"
#include "render/render.h"

/* All pointers are borrowed. */
struct rendering_request {
  const struct scene_request *scene;
  struct render_options options; /* without the tiles */
  enum image_format format;
  size_t bits;          /* of a value */
  const char *output;   /* the picture's file */
  const char *part;     /* where finished tiles are kept until all are done; NULL: nowhere */
  const char *stats;    /* file of the statistics; NULL: none */
  const char *channels; /* the channels of `options`, as on the command line */
  const char *how;      /* the command line's other options on reading the scene */
  size_t piece, pieces; /* render only piece `piece` of `pieces`, from 1; 0, 0: the whole picture */
  bool resume;          /* continue from `part` */
  double checkpoint;    /* seconds after which what is done is kept again; 0: never */
};

/* Returns STATUS_USAGE, after printing the error, if one of the files would overwrite another one, or a file of the
 * scene. With `scene` NULL, checks what is known before it is read. */
enum status rendering_check_outputs(const struct command *command, const struct rendering_request *request,
                                    const struct scene *scene) STATUS_MUST_CHECK;

/* Reads the scene, renders and writes. STATUS_INTERRUPTED after a signal: then `part` has what is done. */
enum status rendering_make(const struct command *command, const struct rendering_request *request) STATUS_MUST_CHECK;

#endif
