/* The polynomials r(u) of the rays of a picture against the first patch of a scene. */
#ifndef PSCN_EXAMPLES_PATCH_RAYS_H
#define PSCN_EXAMPLES_PATCH_RAYS_H

#include <stddef.h>

#include "algebra/polynomial.h"

enum { PATCH_DEGREE = 18 };

/* For every pixel's ray, in the order of the picture's lines, Sylvester's determinant in the basis: PATCH_DEGREE + 1
 * coefficients. The caller frees them. NULL, with a message on stderr, if the scene cannot be loaded. */
double *patch_polynomials(const char *scene, size_t width, size_t height, enum basis basis);

#endif
