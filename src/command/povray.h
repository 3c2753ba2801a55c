/* POV-Ray as a peer: the installed program, run on scene texts in a folder of our own.
 *
 * It runs with that folder as its home and without the user's settings, on one thread, without antialiasing,
 * dithering and display, so that the same text gives the same picture everywhere. What it says is kept and shown where
 * it fails. Errors are told on stderr.
 */
#ifndef PSCN_COMMAND_POVRAY_H
#define PSCN_COMMAND_POVRAY_H

#include <stddef.h>

#include "command/command.h"
#include "command/scratch.h"
#include "image/image.h"
#include "intersect/intersect.h"
#include "scene/scene.h"

/* All but the last three are set by the caller before povray_open and borrowed until povray_close. */
struct povray {
  const struct command *command;
  const char *program;        /* looked for along PATH where it has no slash */
  const char *const *options; /* passed on behind our own */
  size_t option_count;
  size_t width, height;       /* of pictures, pixels */
  const char *scene_path;     /* its folder is searched for what only POV-Ray includes */
  struct scratch folder;
  char program_path[SCRATCH_PATH_SIZE];
  char version[64];           /* as it calls itself, once it is open; or "" */
};

/* Sets up the folder and asks the program for its version. STATUS_FILE where there is no such program, or it is
 * another one. The caller ends with povray_close in any case. */
enum status povray_open(struct povray *povray) STATUS_MUST_CHECK;
void povray_close(struct povray *povray);

/* Renders a file of the folder. The picture, R G B with the display codes of an 8-bit PNG as k/255, is owned by the
 * caller. STATUS_FILE where POV-Ray cannot be run, STATUS_INPUT where it refuses the text, STATUS_INTERRUPTED. */
struct povray_picture {
  struct image image;
  double wall, cpu; /* seconds of the whole program */
};
enum status povray_render(struct povray *povray, const char *name, struct povray_picture *out) STATUS_MUST_CHECK;

/* The same for the canonical text of a scene. */
enum status povray_render_scene(struct povray *povray, const struct scene *scene,
                                struct povray_picture *out) STATUS_MUST_CHECK;

/* Which pixels hit something: out[height][width] is 1 or 0. */
enum status povray_mask(struct povray *povray, const struct scene *scene, unsigned char *out) STATUS_MUST_CHECK;

/* Asks POV-Ray's trace() for the distance along each ray, in scene units: INFINITY on a miss. */
enum status povray_trace(struct povray *povray, const struct scene *scene, size_t count, const struct ray rays[],
                         double out_distance[]) STATUS_MUST_CHECK;

/* The warnings of the last run, one a line, owned by the caller (free); NULL where there are none. */
char *povray_warnings(const struct povray *povray);

#endif
