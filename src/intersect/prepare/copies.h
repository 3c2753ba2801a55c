/* Which copies of declared objects share leaves, and the maps from the scene to the objects' coordinates.
 *
 * Internal to src/intersect. A ray is taken to the object's coordinates by x -> (x - b) W. W and b are doubles, and the
 * map is exact; any values do, as long as they carry the copy's patches to the object's. Because W, b and all nets are
 * rounded, how well they do is measured, and counts as an error of the object's control points; so do the roundings of
 * the ray on its way. What this leaves undecided in the object goes to the last resort, as the copy's own patch.
 */
#ifndef PSCN_INTERSECT_PREPARE_COPIES_H
#define PSCN_INTERSECT_PREPARE_COPIES_H

#include "intersect/model.h"

/* Sets model->objects, except for their models, and model->copies, marks the patches of these, and lowers *own, the
 * number of patches that need leaves, accordingly. Copies that are deep in one another do not share if *own can be at
 * most `most` without. */
enum status copies_choose(struct model *model, size_t most, size_t *own) STATUS_MUST_CHECK;

/* Makes the objects' models. */
enum status copies_prepare(struct model *model, const struct team *team,
                           const struct cut_limit *limit) STATUS_MUST_CHECK;

/* The copy's box, as tree_build takes it. */
void copy_box(const struct model *model, const struct model_copy *copy, struct bvh_box *out);

#endif
