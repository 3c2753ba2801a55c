/* Cutting parts and leaves out of a patch, and all that is known of them beforehand.
 *
 * Internal to src/intersect. Pure; safe on any thread. What comes out are the same bits on every processor, and however many
 * are asked for at once.
 */
#ifndef PSCN_INTERSECT_PREPARE_LEAF_H
#define PSCN_INTERSECT_PREPARE_LEAF_H

#include "intersect/model.h"

/* Where parameters have k bits behind the point between them, for 2^k leaves, and coordinates h, three halfway values in
 * either direction are multiples of 2^-(3k + h), and their Taylor coefficients of 2^-(3k + h + 6): nothing is rounded up
 * to these. */
enum { EXACT_LEAVES = 1024 };

/* Whether a patch is cut into so many leaves exactly, but for the last rounding of each coordinate. */
static inline bool split_is_exact(int leaves) { return leaves <= EXACT_LEAVES && (leaves & (leaves - 1)) == 0; }

/* What cutting a patch otherwise rounds of its coordinates: six mixtures, of two roundings and one of a difference each, of
 * numbers of size 1. */
#define CUT_ERROR (30 * UNIT_ROUNDOFF)

/* How parts of a patch lie: each is span[0] x span[1] of split[0] x split[1] columns, and the bounds are for one that is
 * wider by so much of itself on all sides. */
struct part_grid {
  uint16_t split[2], span[2];
  double margin;
};

/* A part: its net in the frame of the patch, as of struct leaf, and bounds on derivatives by its own parameters. */
struct patch_part {
  double x[3][16];
  double first[2], second[3]; /* |Su|, |Sv|; |Suu|, |Suv|, |Svv| */
};

/* How much the derivatives of a part or a leaf turn from its middle to its ends, by its bounds on second ones. */
static inline double turn_of(const double second[3]) { return (second[0] + 2 * second[1] + second[2]) / 2; }

/* The parts from these columns on. Of the patch only net and rest are asked for. */
void patch_parts(const struct model_patch *patch, const struct part_grid *grid, size_t count,
                 const uint16_t column[][2], struct patch_part out[]);

/* Whether a border (geometry/edges.h) of the part of the patch that has `span` columns of leaves from `column` on lies on a
 * pole. */
bool leaf_border_is_point(const struct model_patch *patch, const uint16_t column[2], const uint16_t span[2],
                          int border);

/* Leaves of patch number `index`, from its leaf `first` on; all but their quadrics and forms. Leaf column_u split[1] + column_v is
 * the one at these columns. */
void leaves_make(const struct model_patch *patch, uint32_t index, uint32_t first, size_t count, struct leaf leaves[]);

/* The quadrics of leaves, of one patch or of several. */
void leaf_quadrics(size_t count, struct leaf leaves[]);

/* The boxes along leaves of a patch, as of struct leaf, from their columns on. */
void leaf_slabs(const struct model_patch *patch, size_t count, const uint16_t column[][2], struct leaf_slab out[][3]);

/* What resultants of the leaf are formed of; its form, where it has one, is written to *form, which stays the caller's. */
void leaf_set_form(const struct model_patch *patch, struct leaf *leaf, struct leaf_form *form);

/* A leaf's box along it in the frame of the tree, wider by the model's `error`; all but whose it is. */
void leaf_orient(const struct model_tree *tree, double error, const struct model_patch *patch,
                 const struct leaf_slab slab[3], struct oriented_box *box);

/* The box of a leaf's net, as tree_build takes it. */
void leaf_box(const struct model *model, const struct model_patch *patch, const double x[3][16], struct bvh_box *box);

#endif
