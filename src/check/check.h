/* A scene beside POV-Ray: the same text, two pictures, and what differs.
 *
 * Our picture is rendered once; each row is one picture by POV-Ray beside it: first the scene as it is written, then
 * with every patch cut into 2^n x 2^n pieces, n = 1, 2, ... (u_steps n v_steps n flatness 0). POV-Ray reads the
 * canonical text of the scene (scene/dump.h), which is what we understood; its own text only where that is asked for.
 */
#ifndef PSCN_CHECK_CHECK_H
#define PSCN_CHECK_CHECK_H

#include <stdbool.h>
#include <stddef.h>

#include "base/clock.h"
#include "base/listener.h"
#include "base/text_buffer.h"
#include "image/compare.h"
#include "scene/scene.h"

enum { CHECK_MAX_STEPS = 8 }; /* 65536 pieces a patch: more does not fit into memory for common scenes */

struct check_request {
  const char *path;         /* of the scene */
  const char *folder;       /* receives the results; is there */
  const char *command_line; /* told on the page */
  size_t width, height;
  const char *program;        /* of POV-Ray */
  const char *const *options; /* passed on to it */
  size_t option_count;
  double timeout;             /* seconds that a run of it may take */
  size_t memory;              /* bytes that it may take */
  bool own_text;              /* the first row is of the scene's own text, read once more from `path` */
  const char *const *folders; /* where files are looked for that it includes; those of language_settings */
  size_t steps;               /* the last n; 0: only as written */
  size_t grid;                /* every grid-th pixel of every grid-th row is asked for its distance; 0: none */
  struct compare_limit fail;
  double fail_psnr, fail_mask; /* dB, percent of the pixels */
  struct seconds parse;        /* what reading the scene took */
};

/* What file `number` is called of those that check_scene writes, or takes away where it has none. */
enum { CHECK_FILES = 2 * (CHECK_MAX_STEPS + 1) + 3, CHECK_NAME_SIZE = 48 };
void check_file_name(size_t number, char out[CHECK_NAME_SIZE]);

/* Renders, measures, and writes check.html, check.json and the pictures: all of them, or none where something fails or
 * the listener stops it. `scene` was read with the picture's size; the steps of its patches are changed. *out_text, to
 * be freed in any case, receives the numbers as a table. STATUS_DIFFERENT, told, where the last row is beyond the
 * limits. */
enum status check_scene(const struct check_request *request, struct scene *scene, const struct listener *listener,
                        struct text_buffer *out_text) STATUS_MUST_CHECK;

#endif
