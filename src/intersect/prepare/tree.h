/* The hierarchy of a model, in one frame or in several.
 *
 * Internal to src/intersect/prepare.
 */
#ifndef PSCN_INTERSECT_PREPARE_TREE_H
#define PSCN_INTERSECT_PREPARE_TREE_H

#include <math.h>

#include "intersect/model.h"

/* No frame is smaller than this, so that its reciprocal times a direction is finite. */
#define LEAST_FRAME 0x1p-1000

/* The coordinate k of the scene about which boxes are given. It is the scene's zero, where doubles are finest: about
 * the middle of the scene, what is tiny next to the whole would be rounded away. In a scene far from its zero it is the
 * middle, near which all differences are exact. */
static inline double tree_about(const struct model_tree *whole, int k)
{
  return fabs(whole->origin[k]) > 4 * whole->frame ? whole->origin[k] : 0;
}

/* Takes the box to a frame of that size about `middle`, widened by what that may round. */
void tree_box(const double middle[3], double frame, struct bvh_box *box);

/* Builds model->tree and model->inner over the boxes of the model's leaves, and then of its copies, given less
 * tree_about, in the frame that the tree has already. Uses the boxes up. STATUS_LIMIT if memory or threads are short;
 * then there may be nodes to free. */
enum status tree_build(struct model *model, struct bvh_box boxes[], const struct team *team) STATUS_MUST_CHECK;

static inline double box_center(const struct bvh_box *box, int axis) { return box->lo[axis] / 2 + box->hi[axis] / 2; }

/* Frees the nodes of all trees of the model. */
void tree_free(struct model *model);

#endif
