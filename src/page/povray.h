/* Runs the installed POV-Ray on scene texts, in a folder of our own, to compare with it.
 *
 * It runs without the user's settings, on one thread, without antialiasing, dithering and display, so that the same
 * text gives the same picture everywhere. The text need not be trusted. One that could read or write files is not
 * rendered; POV-Ray's own restrictions on files and programs are on; each run has a new folder and may write nowhere
 * else (if the system can enforce that); and its time, its memory and the bytes that it writes are limited. If it fails, its output is shown, made printable. Errors go to the listener.
 */
#ifndef PSCN_PAGE_POVRAY_H
#define PSCN_PAGE_POVRAY_H

#include <stddef.h>

#include "base/clock.h"
#include "base/listener.h"
#include "base/text_buffer.h"
#include "page/plain_copy.h"
#include "page/scratch.h"
#include "image/image.h"

struct ray;
struct scene;

/* Seconds that one run may take, by default. */
#define POVRAY_TIMEOUT 300.0

/* The caller sets all before `missing` before povray_open, and keeps them until povray_close. */
struct povray {
  const struct listener *listener;
  const char *program;        /* searched for in PATH if it has no slash */
  const char *const *options; /* passed on after our own */
  size_t option_count;
  size_t width, height;           /* of pictures, pixels */
  double timeout;                 /* seconds that each run may take */
  size_t memory;                  /* bytes that it may take; 0: no limit */
  bool optional;                  /* its absence is no error */
  bool missing;                   /* there is no such program */
  bool refused;                   /* the last run ended with an error of its own */
  char folder[SCRATCH_PATH_SIZE]; /* our own, with one for each run */
  char program_path[SCRATCH_PATH_SIZE];
  char version[64]; /* as it calls itself; "" before povray_open */
};

/* Sets up the folder and asks the program for its version. Returns STATUS_FILE if the program is missing or is not
 * POV-Ray. The caller must call povray_close in all cases. */
enum status povray_open(struct povray *povray) STATUS_MUST_CHECK;
void povray_close(struct povray *povray);

/* Renders a scene from its canonical text. The caller owns the picture, whose R G B are the display codes of an 8-bit
 * PNG as k/255. Returns STATUS_FILE if POV-Ray cannot be run, STATUS_INPUT if it refuses the text, STATUS_LIMIT if it
 * takes too long, or STATUS_INTERRUPTED. */
struct povray_picture {
  struct image image;
  struct seconds time; /* of the whole program */
};
enum status povray_render(struct povray *povray, const struct scene *scene,
                          struct povray_picture *out) STATUS_MUST_CHECK;

/* The same from the text of a scene file itself, without its solver statements. `folders` are those of
 * language_settings. If the text could read or write other files, nothing is rendered, and out_word is the word that
 * could (page/plain_copy.h); otherwise "". */
enum { POVRAY_WORD_SIZE = PLAIN_COPY_WORD_SIZE };
enum status povray_render_file(struct povray *povray, const char *path, const char *const *folders,
                               char out_word[POVRAY_WORD_SIZE], struct povray_picture *out) STATUS_MUST_CHECK;

/* Asks POV-Ray's trace() for the distance along each ray, in scene units: INFINITY on a miss. If out_mask is not NULL,
 * also asks which pixels hit something: out_mask[height][width] is 1 or 0. */
enum status povray_ask(struct povray *povray, const struct scene *scene, size_t count, const struct ray *rays,
                       double out_distance[], unsigned char *out_mask) STATUS_MUST_CHECK;

/* The CPU seconds of tracing the scene's picture, in white and without lights, not counting parsing; NAN if unknown. */
enum status povray_time(struct povray *povray, const struct scene *scene, double *out) STATUS_MUST_CHECK;

#endif
