/* The arithmetic of transforms.
 *
 * transform_kernel.c is compiled once per instruction set, because with fused multiply-add the error of a product takes
 * one instruction; all sets round alike.
 */
#ifndef PSCN_GEOMETRY_TRANSFORM_KERNEL_H
#define PSCN_GEOMETRY_TRANSFORM_KERNEL_H

#include "geometry/transform.h"

struct transform_kernel {
  /* First, then second; neither is the identity. `out` is neither of them. */
  void (*compose)(const struct transform *first, const struct transform *second, struct transform *out);
  void (*apply)(const struct transform *transform, const transform_row p, transform_row out);
  void (*rotation)(const double degrees[3], struct transform_angles *angles, struct transform *out);
};

extern const struct transform_kernel transform_kernel_baseline, transform_kernel_avx2;

#endif
