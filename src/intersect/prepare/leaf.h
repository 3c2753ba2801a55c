/* Cutting a leaf out of its patch, and all that is known of it beforehand.
 *
 * Internal to src/intersect. Pure; safe on any thread.
 */
#ifndef PSCN_INTERSECT_PREPARE_LEAF_H
#define PSCN_INTERSECT_PREPARE_LEAF_H

#include "intersect/model.h"

/* The local net of the part of the patch that has `span` columns of leaves from `column` on, along u and v. */
void leaf_net(struct model_patch *patch, const uint16_t column[2], const uint16_t span[2], double out[3][16]);

/* Whether a border (geometry/edges.h) of that part lies on a pole of the patch. */
bool leaf_border_is_point(const struct model_patch *patch, const uint16_t column[2], const uint16_t span[2],
                          int border);

/* Bounds on |Su|, |Sv| of a net over its own domain. */
void leaf_first_bounds(double x[3][16], double out[2]);

/* Bounds on |Su|, |Sv| and |Suu|, |Suv|, |Svv| over a leaf with that net widened by LEAF_MARGIN, in its parameters. */
void leaf_bounds(double x[3][16], double first[2], double second[3]);

/* The leaf at that place of the patch. Its form, where it has one, is written to *form, which stays the caller's. */
void leaf_make(struct model_patch *patch, const struct leaf_place *place, struct leaf *leaf, struct leaf_form *form);

/* The box of a leaf's net in the frame of the model's hierarchy. */
void leaf_box(const struct model *model, const struct model_patch *patch, double x[3][16], struct bvh_box *box);

#endif
