/* Cuts leaves out of a patch, and computes all that is known of them beforehand.
 *
 * Internal to src/intersect. Pure; safe on any thread. Results have the same bits on every processor.
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

/* How much the derivatives of a leaf turn from its middle to its ends, by its bounds on second
 * derivatives. */
static inline double turn_of(const double second[3]) { return (second[0] + 2 * second[1] + second[2]) / 2; }

/* Whether the leaf's border (geometry/edges.h) is a point. */
static inline bool leaf_border_is_point(const struct model_patch *patch, const struct leaf *leaf, int border)
{
  const int column = border < 2 ? leaf->column_u : leaf->column_v, last = patch->cut.split[border / 2] - 1;
  return patch->pole[border] && column == (border & 1 ? last : 0);
}

/* Makes leaf `number` of patch number `index`: the one at columns number / split[1] and number % split[1]. */
void leaf_make(const struct model_patch *patch, uint32_t index, uint32_t number, struct leaf *out);

/* The polynomials that a leaf's resultants are made of: its net at its true degree, the kept parameter first. */
struct leaf_form {
  uint8_t kept_degree, eliminated_degree;
  bool v_kept;      /* keeps v and eliminates u */
  uint8_t zeros[2]; /* r(kept) has this many exact roots at 0 and at 1: collapsed edges */
  bool own;         /* it is the leaf's own net: (3,3), u kept. Then the rest is not set, except for excess */
  double excess;    /* bound on the distance of any coordinate from the leaf's: degrees are true only up to rounding */
  double size;      /* bound on |x| and 1: a net of lower degree may reach beyond the leaf's */
  double x[3][16];  /* x[coordinate][4 * i + j], i = 0..degree kept, j = 0..degree eliminated; zero beyond */
};

/* leaf_form.c */
void leaf_form_make(const struct model_patch *patch, const struct leaf *leaf, struct leaf_form *out);

/* Sets a leaf's box along it in the frame of the tree, wider by the model's `error`; all but its patch. */
void leaf_orient(const struct model_tree *tree, double error, const struct model_patch *patch,
                 const struct leaf_slab slab[3], struct oriented_box *box);

/* The box of a leaf's net, as tree_build expects it. */
void leaf_box(const struct model *model, const struct model_patch *patch, const double x[3][16], struct bvh_box *box);

#endif
