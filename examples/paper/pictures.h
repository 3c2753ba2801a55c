/* Pictures of what a solver does, for the programs that draw maps. */
#ifndef PSCN_EXAMPLES_PICTURES_H
#define PSCN_EXAMPLES_PICTURES_H

#include <stdbool.h>
#include <stddef.h>

#include "image/image.h"
#include "intersect/explain.h"

struct picture_pixel {
  double rgb[3];                   /* linear, shaded with shadows */
  double depth;                    /* of its hit along the ray; infinite where there is none */
  struct explained_numbers solver; /* what it took */
};

/* Every pixel of the picture by the solver, the scene's own where it is NULL: one ray each, one after the other along the lines
 * from the top, so that with `start previous` each begins at the roots of the pixel to its left, or of the line before. (The
 * tiles of render_scene begin cold.) Shadow rays do not come between them. [height][width]; to be freed. NULL, told on
 * stderr, where anything fails. */
struct picture_pixel *picture_lines(const char *scene, size_t width, size_t height, const char *solver);

/* An image of three channels to be written; false where memory is short. */
bool picture_begin(size_t width, size_t height, struct image *out);

/* Writes it as PNG, NAME and then SUFFIX, and destroys it; false, told on stderr, where that fails. `encoded`: its values are
 * display codes, not linear. */
bool picture_end(struct image *image, bool encoded, const char *name, const char *suffix);

/* The colour of x in [0,1], dark blue over green to yellow; what is beyond has the colour of the end. */
void picture_scale(double x, float out_rgb[3]);

#endif
