/* Compares pscn with POV-Ray on one scene: both render it, and the differences are measured.
 *
 * Our picture is rendered once. Each row is one picture by POV-Ray to compare with it: first the scene as written, then
 * with every patch cut into 2^n x 2^n pieces, n = 1, 2, ... (u_steps n v_steps n flatness 0). For the first one POV-Ray
 * reads the scene's file, for the others the canonical text of the scene (scene/scene.h), which is what we understood.
 * That text is also in the place of the file if this cannot be read again or could read or write files itself.
 */
#ifndef PSCN_CHECK_CHECK_H
#define PSCN_CHECK_CHECK_H

#include <stdbool.h>
#include <stddef.h>

#include "base/clock.h"
#include "base/listener.h"
#include "base/text_buffer.h"
#include "image/compare.h"
#include "page/povray.h"
#include "scene/scene.h"

enum { CHECK_MAX_STEPS = 8 }; /* 65536 pieces per patch: more does not fit into memory for common scenes */

struct check_request {
  const char *path;         /* of the scene */
  const char *folder;       /* receives the results; must exist */
  const char *command_line; /* shown on the page */
  size_t width, height;
  struct povray povray;       /* without the listener and the size */
  const char *dumped;         /* why the first row is of the dump, too; NULL: it is of the file, read again */
  const char *const *folders; /* searched for the files that it includes; those of language_settings */
  size_t steps;               /* the last n; 0: only as written */
  size_t grid;                /* distances are compared at every grid-th pixel of every grid-th row; 0: none */
  struct compare_limit fail;
  double fail_psnr, fail_mask; /* dB, percent of the pixels */
  struct seconds parse;        /* time of reading the scene */
};

/* The names of the files that check_scene writes, or removes if there is nothing to write. */
enum { CHECK_FILES = 2 * (CHECK_MAX_STEPS + 1) + 3 };
extern const char *const check_files[CHECK_FILES];

/* Renders, measures, and writes check.html, check.json and the pictures: all of them, or none if something fails or the
 * listener stops it. `scene` was read with the picture's size; the steps of its patches are changed. *out_text receives
 * the numbers as a table; the caller frees it in all cases. Returns STATUS_DIFFERENT, after telling the listener, if
 * the last row exceeds the limits. */
enum status check_scene(const struct check_request *request, struct scene *scene, const struct listener *listener,
                        struct text_buffer *out_text) STATUS_MUST_CHECK;

#endif
