/* Where leaves are thicker than they are apart: the pages of a book, a roll of paper.
 *
 * Internal to src/intersect/prepare. Pure; safe on any thread.
 */
#ifndef PSCN_INTERSECT_PREPARE_CROWD_H
#define PSCN_INTERSECT_PREPARE_CROWD_H

#include "intersect/model.h"

/* What stands about a patch, and how it bends. Its u u, u v and v v derivatives are, in parameters of leaves of a x b, 1/a^2,
 * 1/(a b) and 1/b^2 of what they are in its own. */
struct crowd {
  float others; /* boxes along leaves that hold the middle of one of the patch's, but for its own; on average */
  float second[3],
    across[3]; /* bounds on second derivatives, and on what of them is across the patch, where it was looked at */
};

/* Of patch number `patch`, whose leaves, kept ones, begin at `first`. The model's hierarchy is there. */
void crowd_find(const struct model *model, size_t patch, size_t first, struct crowd *out);

/* Cuts a patch that more than `stay` stand about finer, so that about so many do: along the parameter that bends the more each
 * time, and no longer along one that does not. */
void crowd_split(const struct crowd *crowd, double stay, uint16_t split[2]);

#endif
