/* The hierarchy of a model, in one frame or in several.
 *
 * Internal to src/intersect/prepare.
 */
#ifndef PSCN_INTERSECT_PREPARE_TREE_H
#define PSCN_INTERSECT_PREPARE_TREE_H

#include "base/arena.h"
#include "intersect/model.h"

/* Builds over boxes[0..count), which are given in the frame that the tree has already, and used up. STATUS_LIMIT where
 * memory is short, or threads are; then there may be nodes to free. */
enum status tree_build(struct arena *arena, struct bvh_box boxes[], size_t count, const struct team *team,
                       struct model_tree *tree) STATUS_MUST_CHECK;

/* Frees the nodes of this tree and of those in it. */
void tree_free(struct model_tree *tree);

#endif
