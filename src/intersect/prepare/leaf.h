/* Cuts parts and leaves out of a patch, and computes all that is known of them beforehand.
 *
 * Internal to src/intersect. Pure; safe on any thread. Results have the same bits on every processor, and for any
 * number of parts or leaves at once.
 */
#ifndef PSCN_INTERSECT_PREPARE_LEAF_H
#define PSCN_INTERSECT_PREPARE_LEAF_H

#include "intersect/model.h"

/* For 2^k leaves the parameters have k fractional bits together. With h in coordinates, three mixtures in either
 * direction are multiples of 2^-(3k + h), and their Taylor coefficients of 2^-(3k + h + 6): up to this number of leaves
 * nothing is rounded. */
enum { EXACT_LEAVES = 1024 };

/* Whether cutting a patch into this many leaves is exact, except for the last rounding of each coordinate. */
static inline bool split_is_exact(int leaves) { return leaves <= EXACT_LEAVES && (leaves & (leaves - 1)) == 0; }

/* How parts of a patch lie: each is span[0] x span[1] of split[0] x split[1] columns. Bounds are for a part widened on
 * all sides by `margin` of itself. */
struct part_grid {
  uint16_t split[2], span[2];
  double margin;
};

/* A part: its net in the frame of the patch, as in struct leaf, and bounds on derivatives by its own parameters. */
struct patch_part {
  double x[3][16];
  double first[2], second[3]; /* |Su|, |Sv|; |Suu|, |Suv|, |Svv| */
};

/* How much the derivatives of a part or a leaf turn from its middle to its ends, by its bounds on second
 * derivatives. */
static inline double turn_of(const double second[3]) { return (second[0] + 2 * second[1] + second[2]) / 2; }

/* The parts that begin at these columns. Of the patch only net and rest are used. */
void patch_parts(const struct model_patch *patch, const struct part_grid *grid, size_t count,
                 const uint16_t column[][2], struct patch_part out[]);

/* Whether a border (geometry/edges.h) of a part of the patch lies on a pole. The part has `span` columns of leaves from
 * `column` on. */
bool leaf_border_is_point(const struct model_patch *patch, const uint16_t column[2], const uint16_t span[2],
                          int border);

/* Makes leaves of patch number `index`, from its leaf `first` on, without their quadrics and forms. Leaf column_u
 * split[1] + column_v is the one at these columns. */
void leaves_make(const struct model_patch *patch, uint32_t index, uint32_t first, size_t count, struct leaf leaves[]);

/* Makes the quadrics of leaves, of one patch or of several. */
void leaf_quadrics(size_t count, struct leaf leaves[]);

/* The boxes along the leaves of a patch at these columns, as in struct leaf. */
void leaf_slabs(const struct model_patch *patch, size_t count, const uint16_t column[][2], struct leaf_slab out[][3]);

/* Sets what the leaf's resultants are made of. Its form, if it has one, is written to *form, which stays the
 * caller's. */
void leaf_set_form(const struct model_patch *patch, struct leaf *leaf, struct leaf_form *form);

/* Sets a leaf's box along it in the frame of the tree, wider by the model's `error`; all but its patch. */
void leaf_orient(const struct model_tree *tree, double error, const struct model_patch *patch,
                 const struct leaf_slab slab[3], struct oriented_box *box);

/* The box of a leaf's net, as tree_build expects it. */
void leaf_box(const struct model *model, const struct model_patch *patch, const double x[3][16], struct bvh_box *box);

#endif
