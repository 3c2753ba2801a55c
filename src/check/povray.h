/* POV-Ray as a peer: the installed program, run on scene texts in a folder of our own.
 *
 * It runs without the user's settings, on one thread, without antialiasing, dithering and display, so that the same
 * text gives the same picture everywhere. Nobody need trust the text: POV-Ray's own restrictions of what it reads and
 * runs are on, each run has a new folder and may write nowhere else (where the system can see to that), and its time,
 * memory and files are limited. What it says is shown where it fails, printable. Errors go to the listener.
 */
#ifndef PSCN_CHECK_POVRAY_H
#define PSCN_CHECK_POVRAY_H

#include <stddef.h>

#include "base/clock.h"
#include "base/listener.h"
#include "base/text_buffer.h"
#include "check/scratch.h"
#include "image/image.h"
#include "intersect/intersect.h"
#include "scene/scene.h"

/* Seconds that one run may take unless the command line says otherwise. */
#define POVRAY_TIMEOUT 300.0

/* All but the last four are set by the caller before povray_open and borrowed until povray_close. */
struct povray {
  const struct listener *listener;
  const char *program;        /* looked for along PATH where it has no slash */
  const char *const *options; /* passed on behind our own */
  size_t option_count;
  size_t width, height; /* of pictures, pixels */
  double timeout;       /* seconds that a run may take */
  size_t memory;        /* bytes that it may take; 0: any */
  bool optional;        /* that it is missing is not told */
  bool missing;         /* there is no such program */
  struct scratch folder;
  char program_path[SCRATCH_PATH_SIZE];
  char version[64]; /* as it calls itself, once it is open; or "" */
};

/* Sets up the folder and asks the program for its version. STATUS_FILE where there is no such program, or it is
 * another one. The caller ends with povray_close in any case. */
enum status povray_open(struct povray *povray) STATUS_MUST_CHECK;
void povray_close(struct povray *povray);

/* Renders a scene by its canonical text. The picture, R G B with the display codes of an 8-bit PNG as k/255, is owned
 * by the caller. STATUS_FILE where POV-Ray cannot be run, STATUS_INPUT where it refuses the text, STATUS_LIMIT where it
 * takes too long, STATUS_INTERRUPTED. */
struct povray_picture {
  struct image image;
  struct seconds time; /* of the whole program */
};
enum status povray_render(struct povray *povray, const struct scene *scene,
                          struct povray_picture *out) STATUS_MUST_CHECK;

/* The same by the text of a scene file itself, without its solver statements. `folders` are those of language_settings. */
enum status povray_render_file(struct povray *povray, const char *path, const char *const *folders,
                               struct povray_picture *out) STATUS_MUST_CHECK;

/* Asks POV-Ray's trace() for the distance along each ray, in scene units: INFINITY on a miss. Where out_mask is not
 * NULL, also which pixels hit something: out_mask[height][width] is 1 or 0. */
enum status povray_ask(struct povray *povray, const struct scene *scene, size_t count, const struct ray rays[],
                       double out_distance[], unsigned char *out_mask) STATUS_MUST_CHECK;

/* The processor's seconds that it traces the picture of the scene in white without lights, parsing apart; NAN where it
 * does not tell. */
enum status povray_time(struct povray *povray, const struct scene *scene, double *out) STATUS_MUST_CHECK;

/* Adds the warnings of the last run, one a line. */
void povray_warnings(const struct povray *povray, struct text_buffer *out);

#endif
