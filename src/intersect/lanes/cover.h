/* Whether the known roots are all that a leaf has, by pieces that cover it (piece.h), for one ray after the other: few
 * need it. A piece is done with if it has no root, or no other one than a proven one in it. Other pieces are halved.
 *
 * Internal to src/intersect/lanes.
 */
#ifndef PSCN_INTERSECT_LANES_COVER_H
#define PSCN_INTERSECT_LANES_COVER_H

#include "intersect/lanes/candidate.h"

/* The most halvings of a leaf: before its resultant is formed, and when the lanes have found all they can. Choices of
 * speed. */
enum { COVER_EARLY = 11, COVER_HALVINGS = 16 };

/* A proven root of every lane, in the order in which they were found. */
struct known_root {
  const struct newton_root *at;
  lane_mask proven;
};

/* The lanes of `open` on which all of the leaf's roots between the ends of the ray are among `roots`. On the others
 * `left`, if not NULL, gets the middle, in s and t, of a piece that is not done with, where one more root may be. */
lane_mask cover_proves(struct packet *p, const struct candidate *it, int count, const struct known_root roots[],
                       int halvings, lane_mask open, lanes left[2]);

#endif
