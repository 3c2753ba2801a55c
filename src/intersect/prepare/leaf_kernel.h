/* The numbers of leaves, several at once: one leaf to a lane.
 *
 * Internal to src/intersect/prepare; leaf.h is the interface. leaf_kernel.c is compiled once per instruction set; all
 * of them make the same bits, whatever leaves are made together.
 */
#ifndef PSCN_INTERSECT_PREPARE_LEAF_KERNEL_H
#define PSCN_INTERSECT_PREPARE_LEAF_KERNEL_H

#include "intersect/prepare/leaf.h"

struct leaf_kernel {
  /* All doubles of a leaf except its quadric, and `final`, for leaves of one patch whose columns are set. */
  void (*leaves)(const struct model_patch *patch, size_t count, struct leaf leaves[]);
  /* leaf_quadrics, leaf.h. */
  void (*quadrics)(size_t count, struct leaf leaves[]);
};

extern const struct leaf_kernel leaf_kernel_baseline, leaf_kernel_avx2, leaf_kernel_avx512;

#endif
