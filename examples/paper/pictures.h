/* Pictures of what a solver does, for the programs that draw maps. */
#ifndef PSCN_EXAMPLES_PICTURES_H
#define PSCN_EXAMPLES_PICTURES_H

#include <stdbool.h>
#include <stddef.h>

#include "image/image.h"
#include "render/measure.h"

struct picture_pixel {
  double rgb[3];                /* linear, shaded with shadows */
  double depth;                 /* of its hit along the ray; infinite for a miss */
  struct solver_numbers solver; /* its work */
};

/* Every pixel of the picture by the solver, or by the scene's own one if it is NULL: one ray each, one after the other
 * along the lines from the top. So with `start previous` each begins at the roots of the pixel to its left, or of the
 * line before. (The tiles of render_scene start cold.) Shadow rays do not interfere. Returns [height][width] pixels,
 * which the caller frees; NULL, with a message on stderr, if anything fails. */
struct picture_pixel *picture_lines(const char *scene, size_t width, size_t height, const char *solver);

/* Makes an image of three channels; false if memory is short. */
bool picture_begin(size_t width, size_t height, struct image *out);

/* Writes it as PNG, named NAME and SUFFIX, and destroys it; false, with a message on stderr, if that fails. `encoded`:
 * its values are display codes, not linear. */
bool picture_end(struct image *image, bool encoded, const char *name, const char *suffix);

#endif
