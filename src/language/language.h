/* From scene text to a scene.
 *
 * Reads the language of docs/language.md: a subset of POV-Ray 3.7's with the same meaning, and `solver` statements.
 * Safe on any thread (each call has its own state); independent of the locale.
 */
#ifndef PSCN_LANGUAGE_LANGUAGE_H
#define PSCN_LANGUAGE_LANGUAGE_H

#include <stdbool.h>
#include <stddef.h>

#include "base/diagnostics.h"
#include "base/status.h"
#include "scene/scene.h"

/* A name that is declared before a scene is read. */
struct language_number {
  const char *name; /* name_length letters that language_is_name */
  size_t name_length;
  double value;
};

/* The size of a picture unless another is given. */
enum { DEFAULT_WIDTH = 800, DEFAULT_HEIGHT = 600 };

/* An object of the text that is in no other: the patches from `first_patch` on, up to the next one's. Those without
 * patches are not listed. The list is in the scene's arena. */
struct language_part {
  const char *name; /* of the declared object that it is; NULL if it is none */
  size_t first_patch;
};
struct language_parts {
  struct language_part *at;
  size_t count;
};

struct language_settings {
  int image_width, image_height;      /* pixels, >= 1: the values of image_width and image_height in the scene */
  const char *solver_text;            /* --solver TEXT: overrides every solver statement of the scene; or NULL */
  bool lenient;                       /* --lenient: what pscn does not support is left out, with warnings */
  double clock;                       /* --clock X; in frames what stands for one of them */
  int frame, first_frame, last_frame; /* of an animation; 0, 0, 0: of none */
  double tolerance;                   /* --tolerance E: overrides that item everywhere, after solver_text; or NAN */
  const char *const *folders; /* where to look for includes besides the includer's folder, ended by NULL; or NULL */
  const struct language_number *numbers; /* number_count names declared beforehand */
  size_t number_count;
  size_t max_work;                  /* tokens that loops and macros may read; or 0: a second's work */
  bool untrusted;                   /* --untrusted: see below */
  struct language_parts *out_parts; /* where they are listed; or NULL */
  size_t max_memory; /* --max-memory SIZE: bytes that the text and the patches may take; or 0: no limit */
};

/* The scene of a stranger includes only files in its folder, in those given, and below them, wherever links lead; a text
 * that is no file has no folder unless its name has one. It may not say `solver`, and has at most this many lights. */
enum { UNTRUSTED_LIGHTS = 64 };

/* Whether a scene can declare that name: a word reserved neither by the language nor by POV-Ray. */
bool language_is_name(const char *name, size_t length);

/* Reads the scene file at `path`. The caller destroys *out_scene; on failure it is NULL, and diagnostics say why:
 *   STATUS_FILE   the file itself cannot be read
 *   STATUS_INPUT  the text is wrong, an included file cannot be read
 *   STATUS_USAGE  settings->solver_text or settings->tolerance is wrong
 *   STATUS_LIMIT  memory, nesting, size or number of patches */
STATUS_MUST_CHECK enum status language_load(const char *path, const struct language_settings *settings,
                                            struct diagnostics *diagnostics, struct scene **out_scene);

/* The same for `length` bytes at `text`. `name` is their name in diagnostics; includes are looked for relative to its
 * folder part. */
STATUS_MUST_CHECK enum status language_load_text(const char *name, const char *text, size_t length,
                                                 const struct language_settings *settings,
                                                 struct diagnostics *diagnostics, struct scene **out_scene);

/* Reads what may follow `solver` in a scene, such as "aberth { polish off }". Errors point into "<--solver>".
 * STATUS_USAGE or STATUS_LIMIT on failure; *out_method is then unchanged. */
STATUS_MUST_CHECK enum status language_parse_solver(const char *text, struct diagnostics *diagnostics,
                                                    struct method *out_method);

/* Sets the tolerance of `count` methods, within the limits that a scene's text has; NAN leaves them as they are.
 * STATUS_USAGE where it is beyond these. */
STATUS_MUST_CHECK enum status language_set_tolerance(double tolerance, size_t count, struct method methods[],
                                                     struct diagnostics *diagnostics);

#endif
