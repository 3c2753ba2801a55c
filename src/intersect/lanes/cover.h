/* Whether known roots are all that a leaf has, by boxes that cover it, for one ray after the other: few need it.
 *
 * Internal to src/intersect/lanes. A box of parameters is cleared where a plane polynomial or one of the combinations
 * that aim along u and v keeps one sign on its net (as planes.c does with the leaf's), or where a proven root is in it and
 * is alone by the differences of those nets; or where no root would be between the ends of the ray. Other boxes are halved.
 * What exact/search.c does in the last resort; this ends most cases before.
 */
#ifndef PSCN_INTERSECT_LANES_COVER_H
#define PSCN_INTERSECT_LANES_COVER_H

#include "intersect/lanes/candidate.h"

/* How often a leaf is halved at most: before its resultant is formed, and when all is known that the lanes find. Choices of
 * speed. */
enum { COVER_EARLY = 8, COVER_HALVINGS = 16 };

/* A proven root of every lane, in the order they were found. */
struct known_root {
  const struct newton_root *at;
  lane_mask proven;
};

/* The lanes of `open` on which all of the leaf's roots that are between the ends of the ray are among `roots`. Of the others:
 * the middle of a box that was not cleared, s and t, where one more root may be; NULL for not. */
lane_mask cover_proves(struct packet *p, const struct candidate *it, int count, const struct known_root roots[],
                       int halvings, lane_mask open, lanes left[2]);

/* The lanes of `open` on which these two are all, those of them that are proven and not one and the same: they are offered.
 * Where neither is proven the ray nearly touches the leaf, and boxes would do one time in ten. */
lane_mask cover_two(struct packet *p, const struct candidate *it, const struct leaf_root *first,
                    const struct leaf_root *second, lane_mask open);

#endif
