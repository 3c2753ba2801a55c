/* Cutting a leaf out of its patch, and all that is known of it beforehand.
 *
 * Internal to src/intersect. Pure but for the arena; safe on any thread.
 */
#ifndef PSCN_INTERSECT_LEAF_H
#define PSCN_INTERSECT_LEAF_H

#include "intersect/model.h"

/* The local net of the part of the patch that has `span` columns of leaves from `column` on, along u and v. */
void leaf_net(struct model_patch *patch, const uint16_t column[2], const uint16_t span[2], double out[3][16]);

/* Bounds on |Su|, |Sv| of a net over its own domain. */
void leaf_first_bounds(double x[3][16], double out[2]);

/* The leaf at the columns of the patch, all of it but `patch` and the form. Its parts, where it has them, are written
 * to *room, which stays the caller's; no parts where that is NULL. */
void leaf_cut(struct model_patch *patch, int column_u, int column_v, struct leaf *leaf, struct leaf_parts *room);

/* What resultants are formed of; STATUS_LIMIT where memory is short. */
enum status leaf_set_form(struct arena *arena, const struct model_patch *patch, struct leaf *leaf) STATUS_MUST_CHECK;

/* Its box in the frame of the model's hierarchy. */
void leaf_box(const struct model *model, const struct leaf *leaf, struct bvh_box *box);

#endif
