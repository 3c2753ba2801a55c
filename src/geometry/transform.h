/* Affine transforms of points, which are row vectors.
 *
 * They are composed in double-double, and a point is rounded once at the end. The result is the double nearest to the
 * exact one, the same on every machine, unless it is at most 2^-50 of the products on the way (five shears by 1e8, and
 * back). Pure; safe on any thread.
 */
#ifndef PSCN_GEOMETRY_TRANSFORM_H
#define PSCN_GEOMETRY_TRANSFORM_H

#include <stdbool.h>

#include "base/double_double.h"

/* p' = (p, 1) A. `identity`: nothing has been applied, and points keep their bits. `moves`: the first three rows are
 * the identity and the last one is of doubles. */
struct transform {
  bool identity, moves;
  struct double_double A[4][3];
};

struct transform transform_identity(void);
/* first, then second. */
struct transform transform_then(const struct transform *first, const struct transform *second);
bool transform_finite(const struct transform *transform);

/* Four points, a row of a control net. */
typedef double transform_row[4][3];

/* out may be p. Directions are not translated. */
void transform_points(const struct transform *transform, const transform_row p, transform_row out);
void transform_point(const struct transform *transform, const double p[3], double out[3]);
void transform_direction(const struct transform *transform, const double p[3], double out[3]);

/* A cache of rotations and of the sines and cosines of angles: most scenes have few. Empty when zeroed. */
enum { TRANSFORM_ANGLE_BITS = 8, TRANSFORM_TURN_BITS = 4 };
struct transform_angles {
  struct transform_turn {
    bool known;
    double degrees[3];
    struct transform turned;
  } turns[1 << TRANSFORM_TURN_BITS];
  struct transform_angle {
    double degrees; /* 0: none */
    struct double_double sine, cosine;
  } known[1 << TRANSFORM_ANGLE_BITS];
};

/* About x, then y, then z; exact at multiples of 90 degrees. */
void transform_rotation(const double degrees[3], struct transform_angles *angles, struct transform *out);

/* The arithmetic of all this. transform_kernel.c is compiled once per instruction set, because with fused multiply-add
 * the error of a product takes one instruction; all sets round alike. */
struct transform_kernel {
  /* First, then second; neither is the identity. `out` is neither of them. */
  void (*compose)(const struct transform *first, const struct transform *second, struct transform *out);
  void (*apply)(const struct transform *transform, const transform_row p, transform_row out);
  void (*rotation)(const double degrees[3], struct transform_angles *angles, struct transform *out);
};

extern const struct transform_kernel transform_kernel_baseline, transform_kernel_avx2;

#endif
