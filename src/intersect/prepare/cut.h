/* How far patches with `split` auto are cut.
 *
 * Internal to src/intersect/prepare.
 */
#ifndef PSCN_INTERSECT_PREPARE_CUT_H
#define PSCN_INTERSECT_PREPARE_CUT_H

#include "intersect/model.h"

/* The area of the patches in cubes as large as their frames: which surfaces are close together. */
struct cells {
  struct cell *cell; /* NULL: unknown, as if every patch were alone; owned */
  size_t mask;
};

/* Adds up the areas of patches that are kept and get leaves. STATUS_LIMIT if memory is short. */
enum status cells_fill(const struct model *model, struct cells *out) STATUS_MUST_CHECK;
void cells_free(struct cells *cells);

/* Finds the cut with which a picture takes the least time. Safe on any thread. */
void patch_cut(const struct model_patch *patch, const struct cells *cells, const struct cut_limit *limit,
               uint16_t split[2]);

#endif
