/* Pictures of what a solver does, for the programs that draw maps. */
#ifndef PSCN_EXAMPLES_PICTURES_H
#define PSCN_EXAMPLES_PICTURES_H

#include <stddef.h>

#include "image/image.h"

/* The channels of that list (render/channels.h) of every pixel, by the solver, the default one where it is NULL;
 * [height][width][values of the list]. To be freed; NULL, told on stderr, where anything fails. */
float *picture_channels(const char *scene, size_t width, size_t height, const char *solver, const char *channels);

/* An image of three channels to be written; false where memory is short. */
bool picture_begin(size_t width, size_t height, struct image *out);

/* Writes it as PNG and destroys it; false, told on stderr, where that fails. */
bool picture_end(struct image *image, const char *path);

/* The colour of x in [0,1], dark blue over green to yellow; what is beyond has the colour of the end. */
void picture_scale(double x, float out_rgb[3]);

#endif
